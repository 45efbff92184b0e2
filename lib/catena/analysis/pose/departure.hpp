// How drivers begin to move after an instant at which they rest, or came to rest before it.
//
// Where drivers rest in a singular position all velocities are zero and do not tell branches apart. The mechanism moves
// along a branch in proportion to the driver that has moved furthest: s(t), m or rad, is the displacement of that
// driver at t, positive in the direction in which it begins to move, negative on the other side (before the instant, if
// it passes through).
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
  /// Acceleration at the instant of rest of the driver that has moved furthest at t; its sign as that of s.
  double acceleration(double t) const;
  /// s, s' and s'' at t of the driver that has moved furthest at `later`. Leaves the evaluator at t.
  Taylor<double> rates(double t, double later) const;
  /// The driver (element) that has moved furthest at t; -1: there is none.
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

/// The time after which the drivers have moved by `way`, m or rad; infinite where they never do, or where their
/// functions of time are not known so late.
double time_to_depart(Evaluator& evaluator, double rest, double direction, double way);

/// Whether functions of time may be asked for t: those of the user's own only within the run.
bool functions_exist_at(const Evaluator& evaluator, double t);

}  // namespace catena
