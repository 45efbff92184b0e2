#include "catena/analysis/accuracy/kinematic_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/balance/force_sizes.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();
// So far places (length scales, rad) and rates (of the largest) may change by a disturbance: what is of second order is
// then small beside the change. Ten times what equilibria allow: near a dead point the least disturbance, rounding
// itself, changes rates by more than that.
constexpr double largest_change = 1e-4;
constexpr int most_attempts = 6;
// Four rows take some eighty solves and a few factorizations: a small part of the run from this number of rows on, at
// six solves and a factorization each.
constexpr std::int64_t many_rows = 400;
// A row takes the place of the worst conditioned one if it is worse by this factor: copies are few.
constexpr double clearly_worse = 0.7;

}  // namespace

KinematicAccuracy::KinematicAccuracy(Kinematics& analysis, const ColumnSet& columns)
    : analysis_(analysis),
      columns_(columns),
      plan_(analysis.plan()),
      velocity_(columns.needs().velocity),
      acceleration_(columns.needs().acceleration),
      multipliers_(columns.needs().multipliers),
      errors_(columns.size()),
      terms_(analysis.evaluator()) {}

void KinematicAccuracy::keep(Row& row, const Snapshot& snapshot, std::span<const double> values) const {
  row.t = snapshot.t;
  row.model = &snapshot.evaluator.model();
  row.q.assign(snapshot.q.begin(), snapshot.q.end());
  row.values.assign(values.begin(), values.end());
  row.curves = snapshot.evaluator.curve_places();
}

void KinematicAccuracy::take(const Snapshot& snapshot, std::span<const double> values) {
  errors_.take_row(values.first(columns_.size()));
  residual_ = std::max(residual_, snapshot.residual);
  const DrivenSolver& solver = analysis_.solver();
  const double rcond = solver.rcond();
  // Conditions by pivots are crude: close to singular positions it is the rates that tell.
  const std::span<const double> rates = snapshot.qdd.empty() ? snapshot.qd : snapshot.qdd;
  const double rate = rates.empty() ? 0 : solver.rate_norm(rates);
  if (clearly_worse * rate > fastest_rate_) {
    keep(fastest_, snapshot, values);
    fastest_rate_ = rate;
  }
  if (count_ == 0 || rcond < clearly_worse * worst_rcond_) {
    keep(worst_, snapshot, values);
    worst_rcond_ = rcond;
  } else if (count_ == next_) {
    keep(middle_, snapshot, values);
    next_ *= 2;
  }
  last_.t = snapshot.t;
  last_.model = &snapshot.evaluator.model();
  last_.values.assign(values.begin(), values.end());
  ++count_;
}

std::vector<double> KinematicAccuracy::digits(const AnalysisReport& report) {
  if (plan_.columns > Disturbance::most_columns && count_ < many_rows) return {};
  if (!report.ok() || count_ == 0 || analysis_.interpolated() || !analysis_.singular_points().empty()) return {};
  // The rows' own counts are given already, and these are not of the run.
  left_of_rates_ = std::max(analysis_.solver().left_of_rates(), Disturbance::epsilon * Disturbance::epsilon);
  left_of_multipliers_ = analysis_.solver().left_of_multipliers();
  last_.q.assign(analysis_.q().begin(), analysis_.q().end());
  last_.curves = analysis_.evaluator().curve_places();
  kept_.unknown.assign(analysis_.evaluator().model().elements.size(), not_known);
  std::vector<double> examined;
  for (const Row* row : {&fastest_, &worst_, &middle_, &last_}) {
    if (row->q.empty() || std::find(examined.begin(), examined.end(), row->t) != examined.end()) continue;
    examined.push_back(row->t);
    if (!examine(*row)) return {};
  }
  errors_.take_places(columns_.info(), analysis_.evaluator().length_scale());
  return errors_.digits();
}

std::vector<double>& KinematicAccuracy::values_at(const Row& row, const State& state, std::vector<double>& values) {
  Evaluator& evaluator = analysis_.evaluator();
  evaluator.set_configuration(state.q);
  Snapshot snapshot{.evaluator = evaluator, .t = row.t, .q = state.q};
  snapshot.qd = state.qd;
  snapshot.qdd = state.qdd;
  snapshot.lambda = state.lambda;
  // What is summed up over time is not known here, and shows as such in the columns that are made of it.
  snapshot.residual = snapshot.work = snapshot.dissipated = snapshot.initial_energy = not_known;
  snapshot.driver_work = kept_.unknown;
  values.resize(columns_.size());
  columns_.evaluate(snapshot, values);
  return values;
}

bool KinematicAccuracy::examine(const Row& row) {
  Evaluator& evaluator = analysis_.evaluator();
  DrivenSolver& solver = analysis_.solver();
  if (row.model != &evaluator.model()) evaluator.set_model(*row.model);
  evaluator.set_time(row.t);
  evaluator.go_to_curve_places(row.curves);
  if (!(solver.factor_at(row.q) > 0)) return false;
  State exact;
  exact.q = row.q;
  kept_.change.resize(exact.q.size());
  if (!solver.respond(solver.phi(), kept_.change)) return false;
  for (std::size_t k = 0; k < kept_.change.size(); ++k) exact.q[k] -= kept_.change[k];
  // A row that is further off was not solved to the equations that hold here.
  if (!(solver.distance(exact.q, row.q, nullptr) <= largest_change)) return false;
  solver.residual_at(exact.q);
  if (!solve_rates(exact, nullptr, 0)) return false;
  values_at(row, exact, kept_.first);
  kept_.square.assign(columns_.size(), 0.0);
  for (int k = 0; k < Disturbance::disturbed_values; ++k) {
    if (!disturb(row, exact)) return false;
  }
  for (std::size_t k = 0; k < kept_.square.size(); ++k) {
    // Columns that are not defined here, alike in both, are judged in other rows.
    if (std::isnan(row.values[k])) continue;
    errors_.take_error(k, std::abs(row.values[k] - kept_.first[k]) +
                              Disturbance::deviations * std::sqrt(kept_.square[k] / Disturbance::disturbed_values));
  }
  return true;
}

// Adds the squares of what a disturbance does to the columns. Near a singular position rates change fast: there it must
// be smaller to have an effect in proportion.
bool KinematicAccuracy::disturb(const Row& row, const State& exact) {
  const Disturbance begin = random_;
  State state;
  // What is put in solves linear equations: parts of one rounding tell as much as many.
  double size = Disturbance::amplification;
  for (int attempt = 0; attempt < most_attempts; ++attempt) {
    random_ = begin;
    if (!disturb_by(size, row, exact, state)) return false;
    const double changed = change(exact, state);
    if (!std::isfinite(changed)) return false;
    if (changed <= largest_change) {
      values_at(row, state, kept_.other);
      for (std::size_t k = 0; k < kept_.square.size(); ++k) {
        const double difference = (kept_.other[k] - kept_.first[k]) / size;
        kept_.square[k] += difference * difference;
      }
      return true;
    }
    size *= 0.1 * largest_change / changed;
  }
  return false;
}

// The largest change: of places in length scales and rad, of rates as parts of the largest.
double KinematicAccuracy::change(const State& exact, const State& state) const {
  const DrivenSolver& solver = analysis_.solver();
  double largest = solver.distance(state.q, exact.q, nullptr);
  std::vector<double> difference(exact.q.size());
  const auto compare = [&](const std::vector<double>& before, const std::vector<double>& after) {
    for (std::size_t k = 0; k < after.size(); ++k) difference[k] = after[k] - before[k];
    const double all = after.empty() ? 0 : solver.rate_norm(before);
    if (all > 0) largest = std::max(largest, solver.rate_norm(difference) / all);
  };
  compare(exact.qd, state.qd);
  compare(exact.qdd, state.qdd);
  return largest;
}

bool KinematicAccuracy::disturb_by(double size, const Row& row, const State& exact, State& state) {
  Evaluator& evaluator = analysis_.evaluator();
  DrivenSolver& solver = analysis_.solver();
  evaluator.go_to_curve_places(row.curves);
  evaluator.set_time_along(row.t * (1 + size * Disturbance::epsilon * random_.next()), row.t);
  solver.residual_at(exact.q);
  // Of the equations off by this, and by the time.
  place_moduli(evaluator, exact.q, kept_.moduli);
  const std::span<double> rows = terms_.sum(solver.jacobian(), kept_.moduli);
  for (int r = 0; r < plan_.rows; ++r) {
    const double unit = plan_.row_is_angle[at(r)] ? 1 / evaluator.length_scale() : 1;
    rows[at(r)] = size * random_.next() * (Disturbance::epsilon * rows[at(r)] + residual_ * unit) - solver.phi()[at(r)];
  }
  if (!solver.respond(rows, kept_.change)) return false;
  state.q = exact.q;
  for (const int k : plan_.coordinate)
    state.q[at(k)] += kept_.change[at(k)] + size * Disturbance::epsilon / 2 * random_.next() * kept_.moduli[at(k)];
  solver.residual_at(state.q);
  return solve_rates(state, &exact, size);
}

// The rates that are needed where the solver is; `exact`: those nearby.
bool KinematicAccuracy::solve_rates(State& state, const State* exact, double size) {
  if (!velocity_ && !acceleration_ && !multipliers_) return true;
  DrivenSolver& solver = analysis_.solver();
  state.qd = exact ? exact->qd : std::vector<double>(state.q.size(), 0.0);
  if (!solver.solve_velocity(state.qd, exact != nullptr)) return false;
  if (exact && !add_response(state.qd, size, exact->qd, {})) return false;
  if (!acceleration_ && !multipliers_) return true;
  state.qdd = exact ? exact->qdd : std::vector<double>(state.q.size(), 0.0);
  if (!solver.solve_acceleration(state.qd, state.qdd, exact != nullptr)) return false;
  if (exact && !add_response(state.qdd, size, exact->qdd, exact->qd)) return false;
  return !multipliers_ || solve_loads(state, size);
}

// Multipliers; where equations depend on each other they are the least of many, and are left unknown here.
bool KinematicAccuracy::solve_loads(State& state, double size) {
  Evaluator& evaluator = analysis_.evaluator();
  DrivenSolver& solver = analysis_.solver();
  state.lambda.assign(at(plan_.rows), not_known);
  if (plan_.rows > plan_.columns) return true;
  std::vector<double> applied(state.q.size());
  evaluator.applied_forces(state.qd, applied);
  kept_.loads.resize(at(plan_.columns));
  const auto inertia_force = [&](int c) {
    const int coordinate = plan_.coordinate[at(c)];
    const auto& body = evaluator.model().bodies[at(plan_.model_body[at(coordinate / 3)])];
    return (coordinate % 3 == 2 ? body.inertia : body.mass) * state.qdd[at(coordinate)];
  };
  for (int c = 0; c < plan_.columns; ++c) kept_.loads[at(c)] = applied[at(plan_.coordinate[at(c)])] - inertia_force(c);
  if (!solver.solve_multipliers(kept_.loads, state.lambda)) return false;
  if (size == 0) return true;
  const std::vector<double> sizes = force_sizes(evaluator).all;
  const std::span<const double> jacobian = solver.jacobian();
  for (int c = 0; c < plan_.columns; ++c) {
    double terms = sizes[at(plan_.coordinate[at(c)])] + std::abs(inertia_force(c));
    for (int k = plan_.jacobian.column_start[at(c)]; k < plan_.jacobian.column_start[at(c) + 1]; ++k)
      terms += std::abs(jacobian[at(k)] * state.lambda[at(plan_.jacobian.row_index[at(k)])]);
    kept_.loads[at(c)] += size * Disturbance::epsilon * random_.next() * terms;
  }
  if (!solver.solve_multipliers(kept_.loads, state.lambda)) return false;
  double largest = 0;
  for (const double lambda : state.lambda) largest = std::max(largest, std::abs(lambda));
  for (double& lambda : state.lambda)
    lambda += size * random_.next() * (Disturbance::epsilon / 2 * std::abs(lambda) + left_of_multipliers_ * largest);
  return true;
}

bool KinematicAccuracy::add_response(std::span<double> x, double size, std::span<const double> moduli,
                                     std::span<const double> rates) {
  DrivenSolver& solver = analysis_.solver();
  const std::span<double> rows = terms_.sum(solver.jacobian(), moduli, rates);
  for (double& term : rows) term *= size * Disturbance::epsilon * random_.next();
  if (!solver.respond(rows, kept_.change)) return false;
  const double left = size * left_of_rates_ * solver.rate_norm(x), length = analysis_.evaluator().length_scale();
  for (const int k : plan_.coordinate) {
    const double rounding = Disturbance::epsilon / 2 * std::abs(moduli[at(k)]);
    x[at(k)] +=
        kept_.change[at(k)] + size * random_.next() * rounding + left * random_.next() * (k % 3 == 2 ? 1 : length);
  }
  return true;
}

}  // namespace catena
