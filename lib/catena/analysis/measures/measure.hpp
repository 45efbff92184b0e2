// Measures: single numbers that say what a motion is worth, asked of any analysis.
//
//   max, min, range      extremes of a column                   first, final, at     its value at an instant
//   integral, mean, rms  over the motion in time, not its rows  path                 distance of given points from a
//   curve field                a number that the analysis reports besides its rows: an energy, a load, a frequency
//
//   mean = 1/T integral v dt      rms^2 = 1/T integral v^2 dt      path^2 = 1/n sum_k min_t |(x, y)(t) - P_k|^2
//
// T the length of the run; timed paths take the points in turn, at n instants equally spaced from the first to the
// last. Units: of the column; of an integral times s.
#pragma once

#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "catena/base/vec2.hpp"

namespace catena {

/// In the order of the words that scenes have for them.
enum class MeasureKind { maximum, minimum, range, first, final, mean, rms, integral, at, path, field };

struct MeasureRequest {
  std::string name;
  MeasureKind kind = MeasureKind::final;
  std::vector<std::string> columns;  ///< one; of a path x and y
  double at = 0;                     ///< s, of the kind `at`
  std::vector<Vec2<double>> points;  ///< of a path, in the columns' units
  bool timed = false;                ///< a path whose points belong to instants
  std::string field;                 ///< name of a reported number: "omega2"
  int number = 0;                    ///< which one of a list, from 1; 0: it is no list
  std::string part;                  ///< of one object in a list: "value"
};

struct MeasureResult {
  std::string name;
  std::string unit;                ///< of the column; empty: not known
  bool times_second = false;       ///< the value is an integral over time of a column in `unit`
  std::optional<double> value, t;  ///< and the instant, s, of what has one
  /// By parameter, where they were asked for; not a number where there is none.
  std::vector<double> gradient;
  /// By the last instant of the run, should that move; not a number where this is not known.
  double by_last_instant = std::numeric_limits<double>::quiet_NaN();
  bool of_rows_alone = false;  ///< the motion between rows was not looked at
  std::string trouble;         ///< why there is no value, or a derivative is missing; a sentence without full stop
};

/// Whether what is measured takes place in time.
constexpr bool needs_time(MeasureKind kind) {
  return kind == MeasureKind::integral || kind == MeasureKind::at || kind == MeasureKind::path;
}

}  // namespace catena
