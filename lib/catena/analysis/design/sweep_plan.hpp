// Which designs a sweep tries: values of several parameters, by number of the design.
//
//   grid            every combination; the last parameter changes first
//   together        the k-th value of every parameter; a single value holds for all
//   sobol, latin, random     points of the unit cube, brought to each parameter's range or distribution
//
// Design k depends on the plan alone, not on the order of calls. In a sampled design every value of a list is drawn as
// often as any other, and `from ... to` in `count` equal steps counts as a range. A normal distribution is cut nowhere.
// Source: base/sampling.hpp. Units: those of the parameters.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/base/sampling.hpp"

namespace catena {

/// What a sweep says of one parameter.
struct SweepRange {
  enum class Kind : unsigned char { list, steps, normal, uniform };
  int parameter = -1;
  Kind kind = Kind::list;
  std::vector<double> values;    ///< of a list
  double first = 0, second = 0;  ///< of steps the first and the last value; mean and deviation; least and greatest
  double count = 0;              ///< of steps: how many values, a whole number of any size

  bool is_distribution() const { return kind == Kind::normal || kind == Kind::uniform; }
};

enum class SweepKind : unsigned char { grid, together, sobol, latin, random };

struct SweepRequest {
  std::vector<SweepRange> over;
  SweepKind kind = SweepKind::grid;
  std::int64_t samples = 1000;
  std::uint64_t seed = 1;
};

class SweepPlan {
 public:
  /// As many designs as this, or more, are taken for a mistake.
  static constexpr std::int64_t most_designs = 1'000'000'000;
  /// A latin square keeps so many numbers at most, samples times parameters: of 8 bytes each, 0.8 GB.
  static constexpr std::int64_t most_latin_numbers = 100'000'000;

  /// Why the request is no plan, in words; nothing if it is one.
  static std::optional<std::string> trouble(const SweepRequest& request);
  /// Throws std::invalid_argument with trouble().
  explicit SweepPlan(SweepRequest request);

  std::int64_t designs() const { return designs_; }
  /// The parameters' values of design k = 0 ... designs - 1, in the order of `over`.
  void values(std::int64_t k, std::span<double> out) const;

 private:
  SweepRequest request_;
  std::int64_t designs_ = 0;
  std::optional<SamplePoints> points_;
};

}  // namespace catena
