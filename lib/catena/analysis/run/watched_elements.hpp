// Watches elements whose equations or forces are undefined at some configurations: contacts off their curve, gears
// whose centres coincide, springs stretched beyond their table, laws of state that leave theirs, ropes that leave their
// pulleys.
//
// The place on a curve is found to 1e-9 of the curve (curve_search.hpp): a place further beyond the end than that is
// off the curve.
#pragma once

#include <span>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/base/status.hpp"

namespace catena {

class WatchedElements {
 public:
  explicit WatchedElements(const Evaluator& evaluator);

  /// `singular`, naming the first element that is undefined at the evaluator's configuration and time, and why; or one
  /// that has left its curve or table, and at which end.
  Report check() const;
  /// The part of it about curves and tables that end.
  Report check_ends() const;
  /// The part of it about ropes.
  Report check_ropes() const;
  /// Whether any element could leave a curve.
  bool has_ends() const { return !ending_.empty(); }
  /// `singular`, naming the first force whose law of state has no value at the evaluator's configuration and time and
  /// these velocities (empty: at rest), and why: a table of it is left, or its formula has no finite value.
  Report check_laws(std::span<const double> qd) const;
  /// Whether any law could leave a table.
  bool has_law_ends() const { return has_law_ends_; }
  /// Whether any could leave a curve, a table or a pulley.
  bool may_end() const { return has_ends() || has_law_ends_ || !ropes_.empty(); }
  /// The place of each of these on its curve at the evaluator's configuration: 0 and 1 are the ends; NaN where it does
  /// not use the curve.
  void find_places(std::vector<double>& out) const;
  /// An excess above this one is not rounding.
  static constexpr double allowed_excess = 2e-9;

 private:
  const Evaluator& evaluator_;
  Report undefined(int element, const char* why) const;

  std::vector<int> elements_, ending_, ropes_;
  bool has_law_ends_ = false;
};

}  // namespace catena
