// Samples of columns along a motion, as dense as the columns ask for: what integrals and extremes are taken from.
//
// A stretch [a, b] is looked at at its ends and at the seven nodes of the Gauss-Kronrod rule between them. The quartic
// through five of these samples must foretell the other four to 1e-5 of the column's size; else the stretch is halved.
// The quartic's error falls with the fifth power of the length, that of the rule of seven nodes with the eleventh or
// twelfth: where the one is 1e-5 the other is about 1e-11 of the integral. Of a column with a kink it is not: what its
// samples have of polynomials of degree seven and eight is then a tenth of what the quartic misses, in place of a
// hundredth and less, and such a part is halved on. Halving ends where less than 1e-11 of the whole integral is at
// stake, and where it meets nothing but rounding, which does not become less between instants that are a millionth of
// the part apart. However smooth the samples of a driven motion seem, a part in which a body turns further than 0.2 rad
// between two of them, or, with rows inside, which are foretold as well, five times as far between these, is halved:
// rows may be many turns apart. Source: R. Piessens et al., QUADPACK (1983), for the rule.
//
// Columns come with what they switch by, as abs(v) does where v passes zero: parts end there (switching.hpp), for
// derivatives, which jump, and for values of driven motions; of a motion under forces steps end where these bend. Where
// a switch stays at zero, and its derivative does not, those of the column's two branches differ: it has none.
//
// Where a motion can be looked at anywhere, rows need not bound the stretches: pace() says how long the next one may be
// by what the last one showed. Columns at the rows in between are known, and the polynomial through all nine samples
// must foretell them as well, to 1e-9 of the column's size.
//
// Pieces end where a function of time has a breakpoint. There columns may jump: what belongs to a piece at its end is
// their limit from its inside, the parabola through three instants at 1, 2, 3 millionths of the piece,
//
//   c(t*) = 3 c(t* - d) - 3 c(t* - 2 d) + c(t* - 3 d) + O(d^3)         dc(t*(p), p)/dp = c_p + c' dt*/dp
//
// and the derivative of that limit runs along the instant, where a parameter moves it. c' comes from differences of
// order 4, halved until they settle.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <vector>

#include "catena/analysis/run/row_observer.hpp"
#include "catena/columns/column_set.hpp"

namespace catena {

/// Columns at one instant, and, where derivatives are wanted, those of column c by parameter p at c x parameters + p.
struct MotionSample {
  double t = 0;
  std::vector<double> value, derivative;
  std::vector<double> change;  ///< with derivatives: of each column, by which it jumps here; see DifferentiateColumns
  /// Of a limit at the end of a piece: it is made of the columns at t + k step, k = 1, 2, 3, in parts limit_weights;
  /// and how fast they change, where derivatives are wanted and not at hand. 0, empty: it is none.
  double step = 0;
  std::vector<double> rate;
  /// Where a column is at a switch, both branches being equal with different derivatives, the column's bit.
  std::uint64_t undecided = 0;
  double pace = 0;  ///< how fast bodies turn, rad/s, and move, in length scales, if that is followed
};
inline constexpr std::array<double, 3> limit_weights{3, -3, 1};
/// Columns beyond the last bit share it.
constexpr std::uint64_t bit_of_column(std::size_t column) {
  return std::uint64_t{1} << std::min<std::size_t>(column, 63);
}

/// A column, and one by whose sign it switches.
struct ColumnSwitch {
  std::size_t column, by;
};

/// How columns are differentiated.
struct DifferentiateColumns {
  /// Writes the derivatives of all columns at a snapshot, column after column, not a number where there is none; and
  /// into `change` of each column the value just before less that just after an instant that a parameter moves.
  std::function<void(const Snapshot&, std::span<double> derivative, std::span<double> change)> at;
  /// dt/dp of an instant at which functions of time jump; empty where no parameter moves one.
  std::function<std::vector<double>(double t)> moving;
};

/// A stretch without breakpoints inside.
struct MotionPiece {
  MotionStretch stretch;
  bool breaks_before = false, breaks_after = false;  ///< it begins, or ends, at a breakpoint

  double from() const { return stretch.from; }
  double to() const { return stretch.to; }
  bool is_break(double t) const { return (breaks_before && t == from()) || (breaks_after && t == to()); }
};

class MotionSamples {
 public:
  /// See above: what the quartic may miss, in parts of a column's size.
  static constexpr double allowed_part = 1e-5;
  /// Of Kronrod's extension of the rule of Gauss with three nodes.
  static constexpr int nodes = 7;
  /// One part of a stretch: the ends and the nodes between them in order, and the weights for its length.
  using Part = std::array<MotionSample, nodes + 2>;
  static const std::array<double, nodes>& weights();  ///< of a part of length 1, nodes 1 ... 7 of a Part

  /// `columns` must outlive this object. `run`: the first and the last instant.
  MotionSamples(const ColumnSet& columns, const TimeRange& run)
      : columns_(columns), run_(run), size_(columns.size(), 0.0) {}
  /// Derivatives by so many parameters are taken as well: at every node (`always`), or where look() is told so.
  void differentiate(int parameters, DifferentiateColumns derivatives, bool always) {
    parameters_ = static_cast<std::size_t>(parameters);
    derivatives_ = std::move(derivatives);
    always_ = always;
  }

  /// Which columns switch: parts end there.
  void switch_columns(std::vector<ColumnSwitch> switches) { switches_ = std::move(switches); }
  bool switches() const { return !switches_.empty(); }
  /// No part is longer than bodies take over a length scale, either.
  void follow_places() { follows_places_ = true; }

  /// Derivatives are found later, of what limits are made of.
  void differentiate_later() { later_ = true; }

  /// Columns at an instant of the run, without a snapshot, and the pace there; nothing where they cannot be computed
  /// so. Where derivatives are wanted, columns come from snapshots.
  using Values = std::function<std::optional<double>(double t, std::span<double> out)>;
  void use_values(Values values) { values_ = std::move(values); }
  /// The columns at an instant by use_values().
  std::optional<MotionSample> take_values(double t) const;

  /// A row of the motion; it is kept if it lies beyond what is covered.
  void note_row(MotionSample row);
  /// Length of the next stretch for which one part is expected to do, s; 0 before the first one.
  double pace() const { return pace_; }
  /// Calls use(part, piece) for parts that cover the piece; false where the motion could not be looked at.
  bool cover(const MotionPiece& piece, const std::function<void(const Part&, const MotionPiece&)>& use);
  /// The columns at a snapshot, or at an instant of a piece; at a breakpoint that ends it the limit from its inside,
  /// whose derivative is along the instant where that moves. Not where the run begins, in another way if it began
  /// elsewhere: no derivative; nor where the run ends: at that instant as it is.
  MotionSample take(const Snapshot& snapshot, bool with_derivative) const;
  std::optional<MotionSample> look(const MotionPiece& piece, double t, bool with_derivative) const;
  /// The limit at an end of a piece from its inside, with derivatives at a fixed instant.
  std::optional<MotionSample> limit(const MotionPiece& piece, double t, bool with_derivative) const;
  /// dc/dt of every column at an instant of a piece, from its inside; nothing where it cannot be looked at.
  std::optional<std::vector<double>> rates(const MotionPiece& piece, double t) const;
  /// dt/dp of a breakpoint; empty where it stands still or nothing jumps.
  std::vector<double> moving(double t) const {
    return parameters_ > 0 && derivatives_.moving ? derivatives_.moving(t) : std::vector<double>{};
  }

 private:
  /// Takes the samples between a and b; false where the motion could not be looked at.
  bool fill(const MotionPiece& piece, const MotionSample& a, const MotionSample& b, Part& part);
  /// `shortened`: by what factor switches have.
  bool cover_part(const MotionPiece& piece, const Part& part, double shortened,
                  const std::function<void(const Part&, const MotionPiece&)>& use);
  bool cover_cut(const MotionPiece& piece, const Part& part, const std::array<MotionSample, 2>& cut, double shortened,
                 const std::function<void(const Part&, const MotionPiece&)>& use);
  void use_part(const MotionPiece& piece, const Part& part,
                const std::function<void(const Part&, const MotionPiece&)>& use) const;
  /// The samples just before and behind the place where a column switches within a part; nothing: none does.
  std::optional<std::array<MotionSample, 2>> find_cut(const MotionPiece& piece, const Part& part) const;
  bool is_tie(const MotionSample& sample, const ColumnSwitch& one) const;
  /// Takes out derivatives of columns whose branches are equal and have different ones.
  void judge_ties(MotionSample& sample) const;
  /// By how much the polynomials miss what they must foretell, in parts of what is allowed; what to expect in a part of
  /// twice the length; and the largest in parts of a column's size.
  struct Misfit {
    double here, if_twice, of_size;
    double kink;  ///< what may be one, in parts of a column's size
  };
  Misfit misfit(const Part& part) const;
  /// Of a column's size, what its samples have of polynomials of degrees seven and eight, unless that falls as of what
  /// is smooth.
  double kink_of(const Part& part, std::size_t column) const;
  /// Whether all columns that miss, or have kinks above this, do so by rounding; nothing where the motion could not be
  /// looked at.
  std::optional<bool> is_noise(const MotionPiece& piece, const Part& part, double least_kink) const;
  /// By how much the polynomial through all samples misses the rows inside, in parts of the columns' sizes.
  double misfit_of_rows(const Part& part) const;
  double miss(double foretold, double there, std::size_t column) const;
  /// By how much the quartic misses what it must foretell of a column, in parts of its size.
  double misfit_of(const Part& part, std::size_t column) const;
  bool is_smooth(const Part& part, std::size_t column) const { return misfit_of(part, column) <= allowed_part; }
  void measure_sizes(const MotionSample& sample);
  std::optional<MotionSample> see(const MotionPiece& piece, double t, bool with_derivative) const;
  /// The same as take(), ties not judged.
  MotionSample take_one(const Snapshot& snapshot, bool with_derivative) const;

  const ColumnSet& columns_;
  TimeRange run_;
  std::vector<double> size_;
  std::vector<MotionSample> rows_;  // beyond the last stretch
  double pace_ = 0;
  double worst_if_twice_ = 0, least_ = 0;  // misfit and length of the parts of this stretch
  double covered_to_ = -std::numeric_limits<double>::infinity();
  std::size_t parameters_ = 0;
  DifferentiateColumns derivatives_;
  Values values_;
  std::vector<ColumnSwitch> switches_;
  bool always_ = false, later_ = false, follows_places_ = false;
};

}  // namespace catena
