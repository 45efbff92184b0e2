// How drivers that rest at an instant leave it.
//
// Where drivers rest in a singular position no velocity tells the ways on apart, and the mechanism moves along one of
// them in step with the driver that comes furthest: s(t), m or rad, is how far that one has come at t, positive in the
// sense in which it leaves, negative where it lies on the other side (before the instant, if it passes through).
#pragma once

#include <vector>

#include "catena/assembly/evaluate.hpp"

namespace catena {

class Departure {
 public:
  /// `direction`: 1 after `rest` (s), -1 before it.
  Departure(Evaluator& evaluator, double rest, double direction);

  /// s(t). Leaves the evaluator at t.
  double at(double t) const;
  /// Acceleration at rest of the driver that is furthest at t, of the same sign.
  double acceleration(double t) const;
  /// s, s' and s'' at t of the driver that is furthest at `later`. Leaves the evaluator at t.
  Taylor<double> rates(double t, double later) const;
  /// The element that is furthest at t; -1: there is no driver.
  int leader(double t) const { return drivers_.empty() ? -1 : drivers_[fastest_at(t).driver]; }

 private:
  struct Fastest {
    std::size_t driver = 0;
    double sign = 0;
  };
  double way(std::size_t k) const { return evaluator_.element_value(drivers_[k]).f - start_[k].f; }
  Fastest fastest_at(double t) const;

  Evaluator& evaluator_;
  double rest_, direction_;
  std::vector<int> drivers_;
  std::vector<Taylor<double>> start_;
};

/// The time after which the drivers have come by `way`; infinite: they do not, or nothing is known of them then.
double time_to_depart(Evaluator& evaluator, double rest, double direction, double way);

/// Whether functions of time may be asked for t: those of the user's own only within the run.
bool functions_exist_at(const Evaluator& evaluator, double t);

}  // namespace catena
