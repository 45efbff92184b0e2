// Dynamics where no step can be made because drivers ask for what the mechanism cannot do: the place is located, told
// and given a last row.
//
//   towards a dead point   q = q* - a sqrt(t* - t):   t* - t = |qd|^2 / (2 qd . qdd),   q* = q + 2 (t* - t) qd
//
// but for terms of t* - t. What rounding has left of the accelerations is mended from the constraints: along d = qd /
// |qd|, which is the null vector there, w^T Phi_q(q + s d) d vanishes linearly at q*; and w^T Phi(q*, t*) = 0 has the
// instant.
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/motion/runaway.hpp"
#include "catena/analysis/pose/dead_point.hpp"
#include "catena/analysis/pose/singular_point.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// How much longer than by its accelerations the way to the dead point may be.
constexpr double longest_way = 10;

// |qd|^2 / (2 qd . qdd), s; not positive where velocities do not grow.
double time_by_accelerations(const Evaluator& evaluator, std::span<const double> qd, std::span<const double> qdd) {
  const auto unit = [&](std::size_t k) { return k % 3 == 2 ? 1 : evaluator.length_scale(); };
  double product = 0, square = 0;
  for (std::size_t k = 0; k < 3 * static_cast<std::size_t>(evaluator.plan().moving); ++k) {
    product += qd[k] / unit(k) * (qdd[k] / unit(k));
    square += qd[k] / unit(k) * (qd[k] / unit(k));
  }
  return square / (2 * product);
}

// The combination w of rows that velocities grow with, at (t, q); empty where nu has no part in
// one. S^-1 nu, S = Phi_q M^-1 Phi_q^T, is w but for terms of the square of the sine at which rows depend on each
// other: columns that vanish there, where a coordinate alone becomes free, need no scale.
std::vector<double> vanishing_combination(EquationsOfMotion& equations, double t, std::span<const double> q) {
  const auto rows = static_cast<std::size_t>(equations.plan().rows);
  std::vector<double> nu(rows), w(rows), none(q.size(), 0.0), velocities(none);
  if (!equations.factorize(t, Side::after, q)) return {};
  equations.evaluator().nu(nu);
  equations.solve_motion(none, nu, velocities, w);
  if (!(disagreement(equations.evaluator(), w, nu) > vanishing_part)) return {};
  double largest = 0;
  for (const double weight : w) largest = std::max(largest, std::abs(weight));
  for (double& weight : w) weight /= largest;
  return w;
}

}  // namespace

// Where no step can be made: the dead point ahead, if drivers ask for a motion that the constraints rule out,
// w^T Phi_q = 0 but w^T nu != 0 (apps/manual/kinematics.md#singular-configurations).
std::optional<SingularPoint> Dynamics::dead_point_ahead() {
  if (plan_->rows == 0) return {};
  const bool is_fixed = options_.step > 0;
  if (is_fixed || methods_.present == IntegrationMethod::alpha) {
    // A step of fixed size, or of order 2, fails far from the place: shorter ones of order 8 lead on, no further than
    // two of its steps, or than a dead point can be.
    const double now = under_way_.integrator->time();
    const double way =
        longest_way * time_by_accelerations(evaluator_, under_way_.integrator->state().subspan(q_.size()),
                                            under_way_.integrator->accelerations());
    const double step = std::exchange(options_.step, 0);
    const bool second_order =
        methods_.present == IntegrationMethod::alpha || methods_.present == IntegrationMethod::rattle;
    const IntegrationMethod method =
        std::exchange(methods_.present, second_order ? IntegrationMethod::rk8 : methods_.present);
    std::unique_ptr<Integrator> shorter = make_integrator(*under_way_.motion, run_.grid.last());
    options_.step = step;
    methods_.present = method;
    const double end = std::min({now + (is_fixed ? 2 * step : way), next_breakpoint(now), run_.grid.last()});
    if (!(end > now && (is_fixed || std::isfinite(way)))) return {};
    if (!shorter->start(under_way_.integrator->time(), under_way_.integrator->state())) return {};
    while (shorter->time() < end && shorter->advance(end)) continue;
    if (!(shorter->time() < end)) return {};
    under_way_.integrator = std::move(shorter);
    t_ = under_way_.integrator->time();
  }
  if (!(equations_.smallest_pivot_ratio() < dependence::worth_a_search)) return {};
  const std::size_t n = q_.size();
  const double t = under_way_.integrator->time();
  std::vector<double> q(under_way_.integrator->state().begin(),
                        under_way_.integrator->state().begin() + static_cast<std::ptrdiff_t>(n));
  const std::span<const double> qd = under_way_.integrator->state().subspan(n, n);
  const std::vector<double> w = vanishing_combination(equations_, t, q);
  if (w.empty()) return {};
  const double rest = time_to_dead_point(w, q);
  evaluator_.set_time(t + rest);
  std::optional<SingularPoint> point = find_dead_point(evaluator_, q, dependence::follows_at_end);
  if (!point) return {};
  // Of all motions that are possible there those count that grow without bound.
  const std::vector<double> motion(qd.begin(), qd.end());
  point->name_bodies(evaluator_, std::span(&motion, 1));
  return point;
}

// Where no step can be made: the instant at which drivers have led to infinity.
std::optional<SingularPoint> Dynamics::infinity_ahead() {
  if (plan_->rows == 0) return {};
  const std::size_t n = q_.size();
  const double t = under_way_.integrator->time();
  const std::span<const double> y = under_way_.integrator->state();
  std::vector<double> slope(y.size(), 0.0);
  if (!equations_.accelerations(t, Side::after, y.first(n), y.subspan(n, n), std::span(slope).subspan(n, n))) return {};
  const std::optional<double> instant =
      instant_at_infinity(evaluator_, t, y.first(n), y.subspan(n, n), std::span(slope).subspan(n, n), run_.grid.last());
  if (!instant) return {};
  const std::vector<double> w = vanishing_combination(equations_, t, y.first(n));
  if (w.empty()) return {};
  SingularPoint point;
  put_at_infinity(point, evaluator_, *instant, y.first(n), y.subspan(n, n), w);
  return point;
}

std::optional<Report> Dynamics::lock_up_ahead() {
  std::optional<SingularPoint> point = dead_point_ahead();
  if (!point) point = infinity_ahead();
  if (!point) return {};
  run_.singular_points.push_back(std::move(*point));
  return run_.singular_points.back().report_lock_up(*model_);
}

// Moves q, where the integrator is, to the dead point ahead, and returns the time until then; w: the combination of
// rows that vanishes there.
double Dynamics::time_to_dead_point(std::span<const double> w, std::vector<double>& q) {
  const std::size_t n = q.size();
  const double t = under_way_.integrator->time(), longest = run_.grid.last() - t;
  const std::span<const double> y = under_way_.integrator->state(), qd = y.subspan(n, n);
  std::vector<double> slope(y.size(), 0.0);
  if (!equations_.accelerations(t, Side::after, y.first(n), qd, std::span(slope).subspan(n, n))) return 0;
  const double rest = time_by_accelerations(evaluator_, qd, std::span(slope).subspan(n, n));
  if (!(rest > 0) || !(rest < longest)) return 0;
  const auto place = [&](double part) {
    for (std::size_t k = 0; k < n; ++k) q[k] = y[k] + part * 2 * rest * qd[k];
  };
  std::vector<double> change(static_cast<std::size_t>(plan_->rows)), direction;
  for (int c : plan_->coordinate) direction.push_back(qd[static_cast<std::size_t>(c)]);
  const auto dependence = [&](double part) {
    place(part);
    std::fill(change.begin(), change.end(), 0.0);
    multiply_add(plan_->jacobian, jacobian_values(evaluator_, q), direction, change);
    double sum = 0;
    for (std::size_t r = 0; r < change.size(); ++r) sum += w[r] * change[r];
    return sum;
  };
  const double here = dependence(0), there = dependence(1);
  const double part = here / (here - there);
  place(part > 0 && part < longest_way ? part : 1);
  evaluator_.set_configuration(q);
  evaluator_.phi(change);
  std::vector<double> nu(change);
  evaluator_.nu(nu);
  double off = 0, speed = 0;
  for (std::size_t r = 0; r < nu.size(); ++r) off += w[r] * change[r], speed += w[r] * nu[r];
  const double by_constraints = off / speed;
  return by_constraints >= 0 && by_constraints < longest ? by_constraints : rest;
}

// The mechanism where it locks: places and times are known, rates and loads grow without bound.
void Dynamics::give_row_at_lock_up(RowObserver& observer) {
  const SingularPoint& point = run_.singular_points.back();
  if (point.at_infinity) return;
  const std::size_t n = q_.size();
  const double none = std::numeric_limits<double>::quiet_NaN();
  row_.y.resize(std::max(row_.y.size(), 2 * n));
  row_.slope.assign(row_.y.size(), none);
  std::fill(row_.y.begin(), row_.y.end(), none);
  std::copy_n(point.q.begin(), n, row_.y.begin());
  row_.lambda.assign(static_cast<std::size_t>(plan_->rows), none);
  std::fill(row_.contact_loads.begin(), row_.contact_loads.end(), ContactLoad{none, none, none});
  evaluator_.set_time(point.t);
  evaluator_.set_configuration(point.q);
  row_.residual = equations_.position_residual(point.q);
  evaluator_.add_turns(std::span(row_.y).first(n));
  Snapshot row = snapshot(point.t, row_.y, run_.needs);
  if (run_.needs.work) {
    row.work = row.dissipated = none;
    row_.driver_work.assign(model_->elements.size(), none);
    row.driver_work = row_.driver_work;
  }
  observer.observe(row);
}

}  // namespace catena
