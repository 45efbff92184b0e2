// Elements whose rows or forces mean nothing at some configurations: contacts off their curve, gears whose centres
// coincide, springs stretched beyond their table.
//
// The place on a curve is found to 1e-9 of the curve (curve_search.hpp): what is further beyond the end than that has
// left it.
#pragma once

#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/base/status.hpp"

namespace catena {

class WatchedElements {
 public:
  explicit WatchedElements(const Evaluator& evaluator);

  /// `singular`, naming the first element that means nothing at the evaluator's configuration and time, and why; or
  /// where one has left its curve or table, at which end.
  Report check() const;
  /// The part of it about curves and tables that end.
  Report check_ends() const;
  /// Whether any element could leave a curve.
  bool has_ends() const { return !ending_.empty(); }
  /// Where each of these is at the evaluator's configuration: 0 and 1 are the ends of its curve; NaN where it asks
  /// nothing of it.
  void find_places(std::vector<double>& out) const;
  /// An excess above this one is no rounding.
  static constexpr double allowed_excess = 2e-9;

 private:
  const Evaluator& evaluator_;
  std::vector<int> elements_, ending_;
};

}  // namespace catena
