// Drivers that move on against closed contacts, stops, cables and ropes: a motion that cannot be made.
//
//   w_n = b_n + D_nn x_n >= 0,  x_n >= 0        has no solution where D_nn = 0 and b_n < 0
//
// D_nn = g M^-1 g^T but for what the constraints take away, g the gradient of the gap; where nothing is left of it, g
// is a combination of rows of constraints and drivers, g = w^T Phi_q, and the drivers of that combination are
// concerned.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/contact/contact_switch.hpp"
#include "catena/base/at.hpp"

namespace catena {
// Whether a touching place moves when a force presses it, or acts along it: rows as those of D.
bool ContactSwitch::gives_way(std::size_t row, double response) const {
  const Evaluator::ScalarMotion& motion = row % 2 == 0 ? gap_[active_[row / 2]] : slide_[active_[row / 2]];
  const std::vector<double>& mass = equations_.masses().mass;
  const std::size_t moving = 3 * at(evaluator_.plan().moving);
  std::vector<double> gradient(unit_.load.size(), 0.0);
  scatter_gradient(motion, 1, gradient);
  double free = 0;
  for (std::size_t c = 0; c < moving; ++c) {
    if (mass[c] > 0) free += gradient[c] * gradient[c] / mass[c];
    // What has no mass moves as far as its constraints let it.
    if (!(mass[c] > 0) && gradient[c] != 0) return response > 0;
  }
  return response > ContactProblem::no_response * free;
}

// Whether the places cannot be held even without friction. `accelerates`: by forces, else by impulses.
bool ContactSwitch::is_jammed(bool accelerates) const {
  ContactProblem problem(active_.size());
  fill(problem);
  for (std::size_t a = 0; a < active_.size(); ++a) {
    problem.place[a].has_friction = false;
    problem.place[a].limit = problem.place[a].kinetic = 0;
    problem.place[a].growth = 1;
    const Evaluator::ScalarMotion& gap = gap_[active_[a]];
    if (!problem.place[a].has_normal) continue;
    problem.b[2 * a] = accelerates ? gap.bend + product(gap, unit_.qdd) : gap.rate;
  }
  return !problem.solve();
}

// Whether place k, which closed just now, was let go at this very instant: it has not left by more than rounding.
bool ContactSwitch::returns(double t, std::size_t k, const Cause& cause) const {
  return cause.place >= 0 && k == static_cast<std::size_t>(cause.place) &&
         t - past_.left_at[k] <= 4 * std::numeric_limits<double>::epsilon() * std::abs(t);
}

// Touching places that no force holds and that drivers push through: with an acceleration, or with what shows only
// after it, when the place that was let go closes again at once.
std::vector<std::size_t> ContactSwitch::pushed_through(double t, const ContactProblem& problem, const Cause& cause) {
  std::vector<std::size_t> places;
  for (std::size_t a = 0; a < active_.size(); ++a) {
    if (!problem.place[a].has_normal || problem.D(2 * a, 2 * a) > 0) continue;
    const std::size_t k = active_[a];
    std::vector<double> gradient(unit_.load.size(), 0.0);
    scatter_gradient(gap_[k], 1, gradient);
    double terms = std::abs(gap_[k].bend);
    for (std::size_t c = 0; c < gradient.size(); ++c) terms = std::max(terms, std::abs(gradient[c] * unit_.qdd[c]));
    const double rounding = ContactProblem::rounding_of_sums * terms;
    const bool accelerates = problem.b[2 * a] < -rounding;
    if (accelerates || (returns(t, k, cause) && problem.b[2 * a] <= rounding)) places.push_back(k);
    past_.left_at[k] = t;
  }
  return places;
}

Report ContactSwitch::blocked(double t, std::span<const std::size_t> places) {
  SingularPoint& point = blocked_.emplace();
  point.kind = SingularPoint::Kind::lock_up;
  point.t = t;
  std::vector<double> w(unit_.nothing), nu(unit_.nothing);
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const bool concerned = std::find(places.begin(), places.end(), active_[a]) != places.end();
    for (std::size_t r = 0; concerned && r < w.size(); ++r) w[r] += multipliers_[2 * a][r];
  }
  evaluator_.nu(nu);
  point.find_driver(evaluator_, w, nu);
  Report report = point.report_lock_up(*model_);
  report.message += fmt::format("; {} {} in the way: nothing else can give way", names_of(*model_, points_, places),
                                places.size() == 1 ? "is" : "are");
  return report;
}

}  // namespace catena
