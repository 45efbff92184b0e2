#include "catena/analysis/accuracy/motion_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/balance/force_sizes.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
constexpr double least_claimed = 1.5;  // digits: larger errors have no effect in proportion any more
constexpr double cost_of_row = 3;      // evaluations of accelerations and factors
constexpr double grown = 1.25;         // an error, or the count of rows, since the last row that was looked at or kept
constexpr double astray = 0.2;         // part of an error in every direction
// 12492 columns of 492 random mechanisms (seeds 1 to 500 of stress/digits_test.cpp) were optimistic by 7.3 at most,
// pessimistic by 81 at the median; those of two runs by 5.7 and 81.
constexpr double factor = 2.3;

}  // namespace

MotionAccuracy::MotionAccuracy(const Evaluator& evaluator, const ColumnSet& columns)
    : columns_(columns),
      carried_(evaluator),
      errors_(columns.size()),
      terms_(evaluator),
      curves_(!evaluator.curve_places().empty()),
      timed_(!evaluator.model().functions.empty() && !curves_) {}

MotionAccuracy::MotionAccuracy(Dynamics& analysis, const ColumnSet& columns)
    : MotionAccuracy(analysis.evaluator(), columns) {
  follow(analysis);
}

MotionAccuracy::MotionAccuracy(DynamicsWithEvents& analysis, const ColumnSet& columns)
    : MotionAccuracy(analysis.evaluator(), columns) {
  finds_instants_ = analysis.watches_events();
  follow(analysis);
}

template <class Analysis>
void MotionAccuracy::follow(Analysis& analysis) {
  analysis.follow(&carried_);
  motion_.follow = [&analysis](StepFollower* follower) { analysis.follow(follower); };
  motion_.is_smooth = [&analysis] { return analysis.singular_points().empty() && analysis.jolts().empty(); };
}

void MotionAccuracy::take(const Snapshot& snapshot, std::span<const double> values) {
  errors_.take_row(values.first(columns_.size()));
  if (carried_.lost()) return;
  row_.t = snapshot.t;
  row_.rate = carried_.rate();
  row_.q.assign(snapshot.q.begin(), snapshot.q.end());
  row_.qd.assign(snapshot.qd.begin(), snapshot.qd.end());
  row_.values.assign(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(columns_.size()));
  row_.error.resize(2 * row_.q.size());
  if (!carried_.at_instant(row_.t, row_.error)) return;
  if (const double off = carried_.norm_of_places(row_.error); std::isnan(off) || off > places_) places_ = off;
  keep();
  keep_sharpest(snapshot.qdd);
  const double size = carried_.norm(row_.error);
  examined_.is_last = size > grown * examined_.size && carried_.spend(cost_of_row);
  if (!examined_.is_last) return;
  examined_.size = size;
  examine(row_);
}

// What the rounding of time does differs from row to row with the phase of what depends on it: a few late rows are
// kept.
void MotionAccuracy::keep() {
  if (!timed_ || ++kept_.count < kept_.next) return;
  kept_.rows[at(kept_.oldest)] = row_;
  kept_.oldest = (kept_.oldest + 1) % late_rows;
  kept_.next = static_cast<std::int64_t>(grown * static_cast<double>(kept_.count)) + 1;
}

// Where accelerations have a peak, a small error of places makes a large one of theirs.
void MotionAccuracy::keep_sharpest(std::span<const double> qdd) {
  if (curves_) return;
  double largest = 0;
  for (std::size_t c = 0; c < qdd.size(); ++c)
    largest = std::max(largest, std::abs(qdd[c]) / (c % 3 == 2 ? 1 : carried_.length()));
  if (!(largest > kept_.sharpest)) return;
  kept_.sharpest = largest;
  kept_.rows[at(late_rows)] = row_;
}

std::vector<double> MotionAccuracy::digits(const AnalysisReport& report) {
  const ColumnErrors* known = errors(report);
  return known ? claimed(*known) : std::vector<double>{};
}

std::string MotionAccuracy::why_none() const {
  if (!carried_.lost()) return {};
  return "no digits are claimed: the error could not be carried along with the motion, which passes a singular "
         "position, is stiff, or would need more evaluations for it than a fiftieth of its own";
}

std::vector<double> MotionAccuracy::claimed(const ColumnErrors& errors) {
  std::vector<double> all = errors.digits();
  for (double& digits : all) {
    if (digits < least_claimed) digits = 0;
  }
  return all;
}

const ColumnErrors* MotionAccuracy::errors(const AnalysisReport& report) {
  if (!report.ok() || !motion_.is_smooth() || carried_.lost() || row_.q.empty()) return nullptr;
  if (!examined_.is_last && !carried_.can_look()) return nullptr;
  if (!examined_.is_last) examine(row_);
  std::vector<double> seen{row_.t};
  for (const Row& row : kept_.rows) {
    if (row.q.empty() || std::find(seen.begin(), seen.end(), row.t) != seen.end()) continue;
    seen.push_back(row.t);
    if (carried_.spend(cost_of_row)) examine(row);
  }
  errors_.take_places(columns_.info(), carried_.length());
  for (std::size_t k = 0; finds_instants_ && k < columns_.size(); ++k) {
    if (columns_.info()[k].name == "t") errors_.take_error(k, unknown);
  }
  return &errors_;
}

double MotionAccuracy::error_of_places() const { return carried_.lost() ? unknown : places_; }

// What forces and gamma change by from t to t (1 + size eps); the evaluator is left there.
void MotionAccuracy::add_change_with_time(double t, double size, std::span<double> gamma) {
  Evaluator& evaluator = carried_.equations().evaluator();
  if (!timed_) return;
  const std::span<const double> before = carried_.equations().applied_forces();
  change_.assign(q_.size(), 0.0);
  gamma_.assign(gamma.size(), 0.0);
  evaluator.gamma(qd_, gamma_);
  for (std::size_t r = 0; r < gamma.size(); ++r) gamma[r] -= gamma_[r];
  evaluator.set_time_along(t * (1 + size * Disturbance::epsilon), t);
  evaluator.applied_forces(qd_, change_);
  evaluator.gamma(qd_, gamma_);
  for (std::size_t r = 0; r < gamma.size(); ++r) gamma[r] += gamma_[r];
  const Plan& plan = evaluator.plan();
  for (const int k : plan.coordinate) loads_[at(k)] += change_[at(k)] - before[at(k)];
}

// Accelerations and multipliers at q_, qd_ with `size` times the rounding of their equations.
bool MotionAccuracy::solve_accelerations(double t, double size, Snapshot& snapshot) {
  EquationsOfMotion& equations = carried_.equations();
  Evaluator& evaluator = equations.evaluator();
  const Plan& plan = evaluator.plan();
  qdd_.assign(q_.size(), 0.0);
  if (!equations.accelerations(t, Side::after, q_, qd_, qdd_)) return false;
  lambda_.assign(equations.multipliers().begin(), equations.multipliers().end());
  jacobian_.assign(at(plan.trash_slot()) + 1, 0.0);
  evaluator.start_jacobian(jacobian_);
  if (plan.rows > 0) evaluator.jacobian(jacobian_);
  const std::vector<double> sizes = force_sizes(evaluator).all;
  const std::vector<double>& mass = equations.masses().mass;
  loads_.assign(q_.size(), 0.0);
  moduli_.assign(q_.size(), 0.0);
  for (int c = 0; c < plan.columns; ++c) {
    const std::size_t coordinate = at(plan.coordinate[at(c)]);
    double terms = sizes[coordinate] + std::abs(mass[coordinate] * qdd_[coordinate]);
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k)
      terms += std::abs(jacobian_[at(k)] * lambda_[at(plan.jacobian.row_index[at(k)])]);
    loads_[coordinate] = size * Disturbance::epsilon * random_.next() * terms;
    moduli_[coordinate] = mass[coordinate] > 0 ? terms / mass[coordinate] : std::abs(qdd_[coordinate]);
  }
  const std::span<double> gamma = terms_.sum(jacobian_, moduli_, qd_);
  for (double& term : gamma) term *= size * Disturbance::epsilon * random_.next();
  add_change_with_time(t, size, gamma);
  for (std::size_t c = 0; c < qdd_.size(); ++c) qdd_[c] += size * Disturbance::epsilon * random_.next() * moduli_[c];
  change_.assign(q_.size(), 0.0);
  change_lambda_.assign(lambda_.size(), 0.0);
  equations.solve_motion(loads_, gamma, change_, change_lambda_);
  for (std::size_t c = 0; c < qdd_.size(); ++c) qdd_[c] += change_[c];
  for (std::size_t r = 0; r < lambda_.size(); ++r)
    lambda_[r] = equations.is_dependent() ? unknown : lambda_[r] + change_lambda_[r];
  snapshot.qdd = qdd_;
  snapshot.lambda = lambda_;
  return true;
}

// Of the columns at q_, qd_; nothing of what is summed up over time.
bool MotionAccuracy::values_at(const Row& row, double size) {
  const Needs& needs = columns_.needs();
  Evaluator& evaluator = carried_.equations().evaluator();
  Snapshot snapshot{.evaluator = evaluator, .t = row.t, .q = q_, .qd = qd_};
  if (needs.acceleration || needs.multipliers) {
    if (!solve_accelerations(row.t, size, snapshot)) return false;
  } else {
    evaluator.set_time(row.t);
    if (timed_) evaluator.set_time_along(row.t * (1 + size * Disturbance::epsilon), row.t);
    evaluator.set_configuration(q_);
  }
  snapshot.residual = snapshot.work = snapshot.dissipated = snapshot.initial_energy = unknown;
  unknown_.assign(evaluator.model().elements.size(), unknown);
  snapshot.driver_work = unknown_;
  other_.resize(columns_.size());
  columns_.evaluate(snapshot, other_);
  return true;
}

// A random change of places and rates: as far as the constraints at the row's place allow it, and what the rounding of
// these does there.
void MotionAccuracy::disturb(const Row& row, double size) {
  EquationsOfMotion& equations = carried_.equations();
  Evaluator& evaluator = equations.evaluator();
  const std::size_t n = row.q.size(), moving = 3 * at(evaluator.plan().moving);
  const double length = evaluator.length_scale();
  disturbance_.assign(2 * n, 0.0);
  place_moduli(evaluator, row.q, moduli_);
  const std::span<double> dq = std::span(disturbance_).first(n), dv = std::span(disturbance_).subspan(n);
  for (std::size_t c = 0; c < moving; ++c) {
    const double unit = astray * size * (c % 3 == 2 ? 1 : length);
    dq[c] = random_.next() * (unit + Disturbance::epsilon * moduli_[c]);
    dv[c] = random_.next() * (unit * row.rate + Disturbance::epsilon * std::abs(row.qd[c]));
  }
  if (evaluator.plan().rows == 0 || !equations.factorize(row.t, Side::after, row.q)) return;
  equations.remove_forbidden(dq.first(moving));
  equations.remove_forbidden(dv.first(moving));
  jacobian_.assign(at(evaluator.plan().trash_slot()) + 1, 0.0);
  evaluator.start_jacobian(jacobian_);
  evaluator.jacobian(jacobian_);
  loads_.assign(n, 0.0);
  change_lambda_.assign(at(evaluator.plan().rows), 0.0);
  const auto add_response = [&](std::span<const double> moduli, std::span<double> to) {
    const std::span<double> rows = terms_.sum(jacobian_, moduli);
    for (double& term : rows) term *= Disturbance::epsilon * random_.next();
    change_.assign(n, 0.0);
    equations.solve_motion(loads_, rows, change_, change_lambda_);
    for (std::size_t c = 0; c < moving; ++c) to[c] += change_[c];
  };
  add_response(moduli_, dq);
  // Bodies that are held move by rounding of what they would move by.
  for (std::size_t c = 0; c < n; ++c) moduli_[c] = std::abs(row.qd[c]) + row.rate * (c % 3 == 2 ? 1 : length);
  add_response(moduli_, dv);
}

// Adds the way that the motion makes in eps |t|: functions of time are not known better. Returns the radians of its
// rate in that time.
double MotionAccuracy::disturb_time(const Row& row) {
  qdd_.assign(row.q.size(), 0.0);
  if (!timed_ || !carried_.equations().accelerations(row.t, Side::after, row.q, row.qd, qdd_)) return 0;
  const double moment = Disturbance::epsilon * row.t;
  double largest_v = 0, largest_a = 0;
  for (std::size_t c = 0; c < qdd_.size(); ++c) {
    disturbance_[c] += moment * row.qd[c];
    disturbance_[qdd_.size() + c] += moment * qdd_[c];
    largest_v = std::max(largest_v, std::abs(row.qd[c]));
    largest_a = std::max(largest_a, std::abs(qdd_[c]));
  }
  return std::abs(moment) * std::max(row.rate, largest_v > 0 ? largest_a / largest_v : 0);
}

void MotionAccuracy::examine(const Row& row) {
  const std::size_t n = row.q.size();
  const double size = carried_.norm(row.error);
  disturb(row, size);
  const double radians = disturb_time(row);
  double s = Disturbance::shift / std::max(size, Disturbance::epsilon);
  if (radians > 0) s = std::min(s, std::max(1.0, Disturbance::shift / radians));
  largest_.assign(columns_.size(), 0.0);
  for (const double sign : {1.0, -1.0}) {
    q_ = row.q;
    qd_ = row.qd;
    for (std::size_t c = 0; c < n; ++c) {
      q_[c] += s * (row.error[c] + sign * disturbance_[c]);
      qd_[c] += s * (row.error[n + c] + sign * disturbance_[n + c]);
    }
    if (!values_at(row, sign * s)) other_.assign(columns_.size(), unknown);
    for (std::size_t k = 0; k < largest_.size(); ++k) {
      const double difference = std::abs(other_[k] - row.values[k]) / s;
      if (!(difference <= largest_[k])) largest_[k] = difference;
    }
  }
  for (std::size_t k = 0; k < largest_.size(); ++k) {
    // Columns that are not defined here are judged in other rows.
    if (!std::isnan(row.values[k]))
      errors_.take_error(k, factor * largest_[k] + thresholds::few_roundings * std::abs(row.values[k]));
  }
}

}  // namespace catena
