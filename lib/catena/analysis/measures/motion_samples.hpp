// Samples of columns along a motion, as dense as the columns ask for: what integrals and extremes are taken from.
//
// A stretch [a, b] is looked at at its ends and at the seven nodes of the Gauss-Kronrod rule between them. The quartic
// through five of these samples must foretell the other four to 1e-5 of the column's size; else the stretch is halved.
// The quartic's error falls with the fifth power of the length, that of the rule of seven nodes with the eleventh or
// twelfth: where the one is 1e-5 the other is about 1e-11 of the integral. Halving ends at 1/4096 of the distance of
// rows, at kinks, and earlier where it meets nothing but rounding. Source: R. Piessens et al., QUADPACK (1983), for the
// rule.
//
// Where a motion can be looked at anywhere, rows need not bound the stretches: pace() says how long the next one may be
// by what the last one showed. Columns at the rows in between are known, and the polynomial through all nine samples
// must foretell them as well, to 1e-9 of the column's size.
#pragma once

#include <array>
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
};

/// Writes the derivatives of all columns at a snapshot, column after column; not a number where there is none.
using DifferentiateColumns = std::function<void(const Snapshot&, std::span<double>)>;

class MotionSamples {
 public:
  static constexpr int nodes = 7;
  /// One part of a stretch: the ends and the nodes between them in order, and the weights for its length.
  using Part = std::array<MotionSample, nodes + 2>;
  static const std::array<double, nodes>& weights();  ///< of a part of length 1, nodes 1 ... 7 of a Part

  /// `columns` must outlive this object.
  explicit MotionSamples(const ColumnSet& columns) : columns_(columns), size_(columns.size(), 0.0) {}
  /// Derivatives by so many parameters are taken as well: at every node (`always`), or where ask() says so.
  void differentiate(int parameters, DifferentiateColumns derivatives, bool always) {
    parameters_ = parameters;
    derivatives_ = std::move(derivatives);
    always_ = always;
  }

  /// A row of the motion; it is kept if it lies beyond what is covered.
  void note_row(MotionSample row);
  /// Length of the next stretch for which one part is expected to do, s; 0 before the first one.
  double pace() const { return pace_; }
  /// Calls use(part, stretch) for parts that cover the stretch; false where the motion could not be looked at.
  bool cover(const MotionStretch& stretch, const std::function<void(const Part&, const MotionStretch&)>& use);
  /// The columns at a snapshot, or at an instant of a stretch.
  MotionSample take(const Snapshot& snapshot, bool with_derivative) const;
  std::optional<MotionSample> look(const MotionStretch& stretch, double t, bool with_derivative) const;

 private:
  /// Takes the samples between a and b; false where the motion could not be looked at.
  bool fill(const MotionStretch& stretch, const MotionSample& a, const MotionSample& b, Part& part);
  bool cover_part(const MotionStretch& stretch, const Part& part, double row_distance,
                  const std::function<void(const Part&, const MotionStretch&)>& use);
  /// By how much the polynomials miss what they must foretell, in parts of what is allowed; and what to expect in a
  /// part of twice the length.
  struct Misfit {
    double here, if_twice;
  };
  Misfit misfit(const Part& part) const;
  /// By how much the polynomial through all samples misses the rows inside, in parts of the columns' sizes.
  double misfit_of_rows(const Part& part) const;
  double miss(double foretold, double there, std::size_t column) const;
  void measure_sizes(const MotionSample& sample);

  const ColumnSet& columns_;
  std::vector<double> size_;
  std::vector<MotionSample> rows_;  // beyond the last stretch
  double pace_ = 0;
  double worst_if_twice_ = 0, least_ = 0;  // misfit and length of the parts of this stretch
  double covered_to_ = -std::numeric_limits<double>::infinity();
  int parameters_ = 0;
  DifferentiateColumns derivatives_;
  bool always_ = false;
};

}  // namespace catena
