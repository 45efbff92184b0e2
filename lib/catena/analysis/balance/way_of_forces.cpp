#include "catena/analysis/balance/way_of_forces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "catena/base/at.hpp"

namespace catena {

double way_of_forces(Evaluator& evaluator) {
  const Plan& plan = evaluator.plan();
  const std::vector<double> q = evaluator.given_configuration(), rest(q.size(), 0.0);
  std::vector<double> given(q.size()), now(q.size()), moved(q.size());
  // The largest difference over the coordinates that are places.
  const auto apart = [&](const std::vector<double>& a, const std::vector<double>& b) {
    double most = 0;
    for (const int k : plan.coordinate) {
      if (k % 3 != 2) most = std::max(most, std::abs(a[at(k)] - b[at(k)]));
    }
    return most;
  };
  evaluator.set_configuration(q);
  evaluator.applied_forces(rest, given);
  const double force = apart(given, rest);
  const double longest = std::sqrt(std::numeric_limits<double>::max());
  for (double s = 1 / longest; force > 0 && s < longest; s *= 2) {
    moved = q;
    for (const int k : plan.coordinate) {
      // What ties two of them does not change where they move alike.
      if (k % 3 != 2) moved[at(k)] += s * (1 + k % 7);
    }
    evaluator.set_configuration(moved);
    evaluator.applied_forces(rest, now);
    if (apart(now, given) >= force) return s;
  }
  return 0;
}

}  // namespace catena
