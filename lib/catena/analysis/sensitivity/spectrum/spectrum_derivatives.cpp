#include "catena/analysis/sensitivity/spectrum/spectrum_derivatives.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/sensitivity/start_derivatives.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Forces are in balance if what is left of them is at most this part: what modes take for balance, see modes.cpp.
constexpr double balanced = 1e-6;

/// Fills the metric (1, 1, radius^2) and Phi_q, and factors.
bool factor_metric(Evaluator& evaluator, SaddleSystem& system, std::span<double> jacobian) {
  const Plan& plan = evaluator.plan();
  evaluator.start_jacobian(jacobian);
  evaluator.jacobian(jacobian);
  const std::vector<double> weight = length_metric(evaluator);
  return system.factorize(std::span<const double>(jacobian).first(at(plan.trash_slot())), [&] {
    for (int c = 0; c < 3 * plan.moving; ++c) system.add_diagonal(c, weight[at(c)]);
  });
}

}  // namespace

std::vector<double> length_metric(const Evaluator& evaluator) {
  const Plan& plan = evaluator.plan();
  const std::vector<double> radius = evaluator.attachment_radii();
  std::vector<double> weights(at(plan.coordinates()), 0.0);
  for (int c = 0; c < 3 * plan.moving; ++c) weights[at(c)] = c % 3 == 2 ? radius[at(c / 3)] * radius[at(c / 3)] : 1;
  return weights;
}

std::optional<std::vector<double>> balancing_multipliers(Evaluator& evaluator, double t, std::span<const double> q) {
  const Plan& plan = evaluator.plan();
  evaluator.set_time(t);
  evaluator.set_configuration(q);
  SaddleSystem system(evaluator.shared_plan(), SaddleBlock::diagonal);
  std::vector<double> jacobian(at(plan.trash_slot()) + 1), f(at(plan.coordinates())), b(at(plan.rows), 0.0);
  if (!factor_metric(evaluator, system, jacobian)) return {};
  evaluator.applied_forces(std::vector<double>(f.size(), 0.0), f);
  if (!system.solve(f, b)) return {};
  return b;
}

SpectrumDerivatives::SpectrumDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters,
                                         bool from_model)
    : StateDerivatives(evaluator, models, parameters),
      from_model_(from_model),
      metric_(evaluator.shared_plan(), SaddleBlock::diagonal),
      rest_(at(plan().coordinates()), 0.0),
      values_(at(plan().trash_slot()) + 1) {}

// What the forces leave at the place, as a part of them.
bool SpectrumDerivatives::is_in_balance() {
  std::vector<double> loads(rest_.size());
  evaluator().applied_forces(rest_, loads);
  std::vector<double> held(at(plan().columns), 0.0);
  multiply_transposed_add(plan().jacobian, jacobian(), lambda_, held);
  std::vector<double> stiffness(rest_.size(), 0.0);
  evaluator().visit_stiffness(rest_, [&](int i, int j, const ElementMatrix& m) {
    for (std::size_t r = 0; r < 6; ++r) {
      const int body = r < 3 ? i : j;
      if (body >= 0 && body < plan().moving) stiffness[at(3 * body) + r % 3] += std::abs(m[7 * r]);
    }
  });
  double size = 0, left = 0;
  for (int c = 0; c < plan().columns; ++c) {
    const int coordinate = plan().coordinate[at(c)];
    const double load = loads[at(coordinate)], rest = std::abs(load - held[at(c)]);
    const double none = thresholds::carried_rounding * stiffness[at(coordinate)] *
                        (coordinate % 3 == 2 ? 1 : evaluator().length_scale());
    size = std::max(size, std::abs(load));
    if (rest > none) left = std::max(left, rest);
  }
  return left <= balanced * size;
}

// The place is an equilibrium, which moves with the parameters.
bool SpectrumDerivatives::find_as_equilibrium(const Snapshot& snapshot) {
  SaddleSystem system(evaluator().shared_plan(), SaddleBlock::elements);
  if (!system.factorize(jacobian(), [&] { system.tangent().add_stiffness(evaluator(), lambda_); })) return false;
  std::vector<double> f(rest_.size()), b(lambda_.size());
  for (Group& group : groups()) {
    lift_state(group, snapshot);
    fill_residual(group, snapshot.t);
    for (std::size_t p = 0; p < at(group.count); ++p) {
      for (std::size_t c = 0; c < f.size(); ++c) f[c] = -group.loads[c].d[p];
      for (std::size_t r = 0; r < b.size(); ++r) b[r] = -group.rows[r].f.d[p];
      if (!system.solve(f, b)) return false;
      for (const int c : plan().coordinate) group.q[at(c)].d[p] = f[at(c)];
      for (std::size_t r = 0; r < b.size(); ++r) group.lambda[r].d[p] = b[r];
      if (const int row = system.contradicted_row(); row >= 0) leave_out_parameter(group, p, row);
    }
  }
  return true;
}

void SpectrumDerivatives::fill_residual(Group& group, double t) {
  group.mechanism.freeze_time(t);
  group.mechanism.set_state(group.q);
  group.mechanism.rows(group.rows);
  group.mechanism.applied_forces(group.loads);
  for (DesignScalar& load : group.loads) load = -load;
  group.mechanism.add_constraint_loads(group.lambda, group.loads);
}

// Multipliers balance the forces best wherever the place moves to,  W x + Phi_q^T lambda = Q,  Phi_q x = 0:  what they
// leave over, W x, turns with the constraints, (dPhi_q) x.
bool SpectrumDerivatives::find_multipliers(double t) {
  const auto find_in = [&](Group& group) { return find_multipliers(group, t); };
  return (factor_metric(evaluator(), metric_, values_) && std::all_of(groups().begin(), groups().end(), find_in)) ||
         fail("constraints are singular");
}

bool SpectrumDerivatives::find_multipliers(Group& group, double t) {
  fill_residual(group, t);
  std::vector<double> f(rest_.size()), b(lambda_.size());
  for (std::size_t c = 0; c < f.size(); ++c) f[c] = -group.loads[c].v;
  if (!metric_.solve(f, b)) return false;
  // As the rate of a motion along x, without derivatives of its own.
  const std::vector<DesignScalar> x(f.begin(), f.end());
  group.mechanism.set_state(group.q, x);
  group.mechanism.rows(group.rows);
  for (std::size_t p = 0; p < at(group.count); ++p) {
    for (std::size_t c = 0; c < f.size(); ++c) f[c] = -group.loads[c].d[p];
    for (std::size_t r = 0; r < b.size(); ++r) b[r] = -group.rows[r].d.d[p];
    if (!metric_.solve(f, b)) return false;
    for (std::size_t r = 0; r < b.size(); ++r) group.lambda[r].d[p] = b[r];
  }
  return true;
}

bool SpectrumDerivatives::find(const Snapshot& snapshot) {
  lambda_.assign(snapshot.lambda.begin(), snapshot.lambda.end());
  evaluator().set_time(snapshot.t);
  evaluator().set_configuration(snapshot.q);
  if (is_in_balance() && find_as_equilibrium(snapshot)) return true;
  // No balance, or one that nothing holds: the place follows the given configuration.
  StartDerivatives start(evaluator(), {.places = from_model_});
  for (Group& group : groups()) {
    lift_state(group, snapshot);
    if (!start.find_places(group.mechanism, group.count, group.q))
      return fail("the place has no derivative: " + start.why());
    if (!start.lack().empty()) lack_derivatives(start.lack());
  }
  return find_multipliers(snapshot.t);
}

bool SpectrumDerivatives::find_held(const Snapshot& snapshot, const StateDerivatives& equilibrium) {
  lambda_.assign(snapshot.lambda.begin(), snapshot.lambda.end());
  evaluator().set_time(snapshot.t);
  evaluator().set_configuration(snapshot.q);
  for (std::size_t g = 0; g < groups().size(); ++g) {
    Group& group = groups()[g];
    lift_state(group, snapshot);
    const std::span<const DesignScalar> moved = equilibrium.configuration(g);
    const bool last = g + 1 == groups().size();
    for (std::size_t c = 0; c < moved.size(); ++c) {
      group.q[c].d = moved[c].d;
      if (last) group.q[c].d[at(group.count - 1)] = 0;
    }
  }
  return find_multipliers(snapshot.t);
}

std::optional<std::vector<double>> SpectrumDerivatives::holding_multipliers(double omega2, std::span<const double> v) {
  std::vector<double> f(v.size(), 0.0), b(at(plan().rows), 0.0);
  visit_tangent(evaluator(), lambda_, [&](int row, int column, double value) { f[at(row)] -= value * v[at(column)]; });
  for (int c = 0; c < 3 * plan().moving; ++c) f[at(c)] += omega2 * groups().front().mechanism.mass(c).v * v[at(c)];
  if (!factor_metric(evaluator(), metric_, values_) || !metric_.solve(f, b)) {
    fail("constraints are singular");
    return {};
  }
  return b;
}

std::optional<std::vector<double>> SpectrumDerivatives::gradient(double omega2, std::span<const double> shape) {
  std::vector<double> v(at(plan().coordinates()), 0.0), gradient;
  for (int c = 0; c < plan().columns; ++c) v[at(plan().coordinate[at(c)])] = shape[at(c)];
  const std::optional<std::vector<double>> mu = holding_multipliers(omega2, v);
  if (!mu) return {};
  std::vector<DesignScalar> along(v.begin(), v.end());
  for (Group& group : groups()) {
    group.mechanism.set_state(group.q, along);
    group.mechanism.rows(group.rows);
    DesignScalar sum = group.mechanism.potential().dd;
    for (std::size_t r = 0; r < mu->size(); ++r)
      sum += group.lambda[r] * group.rows[r].dd + DesignScalar(2 * (*mu)[r]) * group.rows[r].d;
    for (int c = 0; c < 3 * plan().moving; ++c)
      sum -= DesignScalar(omega2 * v[at(c)] * v[at(c)]) * group.mechanism.mass(c);
    for (std::size_t p = 0; p < at(group.count); ++p) gradient.push_back(sum.d[p]);
  }
  return gradient;
}

}  // namespace catena
