// limit_load_gradient: the left null vector of an equilibrium's matrix at a fold.
#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/sensitivity/spectrum/spectrum_derivatives.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// |w^T F_P| below this part of |w| |F_P|: the load does no work on the mode, as at branch points of symmetric
// structures.
constexpr double no_work = 1e-7;

/// F_p at the place, parameter after parameter: derivatives of [Phi_q^T lambda - Q, Phi] at fixed q and lambda.
class ResidualDerivatives final : public StateDerivatives {
 public:
  using StateDerivatives::StateDerivatives;
  bool find(const Snapshot& snapshot) override {
    for (Group& group : groups()) {
      lift_state(group, snapshot);
      group.mechanism.freeze_time(snapshot.t);
      group.mechanism.set_state(group.q);
      group.mechanism.rows(group.rows);
      group.mechanism.applied_forces(group.loads);
      for (DesignScalar& load : group.loads) load = -load;
      group.mechanism.add_constraint_loads(group.lambda, group.loads);
    }
    return true;
  }
  /// w^T F_p; `size`: |F_p| of the last parameter.
  std::vector<double> products(std::span<const double> v, std::span<const double> mu, double& size) {
    std::vector<double> all;
    for (Group& group : groups()) {
      for (std::size_t p = 0; p < at(group.count); ++p) {
        double sum = 0, squares = 0;
        for (const int c : plan().coordinate) {
          sum += v[at(c)] * group.loads[at(c)].d[p];
          squares += group.loads[at(c)].d[p] * group.loads[at(c)].d[p];
        }
        for (std::size_t r = 0; r < mu.size(); ++r) {
          sum += mu[r] * group.rows[r].f.d[p];
          squares += group.rows[r].f.d[p] * group.rows[r].f.d[p];
        }
        all.push_back(sum);
        size = std::sqrt(squares);
      }
    }
    return all;
  }
};

}  // namespace

std::optional<std::vector<double>> limit_load_gradient(const Evaluator& evaluator, const DesignModels& models,
                                                       int parameters, const StaticPlace& place, std::string& why) {
  EvaluationWork work;
  Evaluator here(evaluator, work);
  const Plan& plan = here.plan();
  here.set_time(place.t);
  here.set_configuration(place.q);
  std::vector<double> jacobian(at(plan.trash_slot()) + 1);
  here.start_jacobian(jacobian);
  here.jacobian(jacobian);
  SaddleSystem system(here.shared_plan(), SaddleBlock::elements);
  if (!system.begin(std::span<const double>(jacobian).first(at(plan.trash_slot())))) {
    why = "the equations of the equilibrium cannot be solved";
    return {};
  }
  system.tangent().add_stiffness(here, place.lambda);
  const double largest = system.tangent().largest_stiffness();
  // At the fold itself nothing could be solved; a shift of rounding turns the vector by as little.
  for (int c = 0; c < 3 * plan.moving; ++c) system.add_diagonal(c, thresholds::carried_rounding * largest);
  if (!system.factorize()) {
    why = "the equations of the equilibrium cannot be solved";
    return {};
  }
  std::vector<double> v(at(plan.coordinates())), mu(at(plan.rows));
  for (std::size_t c = 0; c < v.size(); ++c) v[c] = 1 + 0.1 * static_cast<double>(c % 7);
  for (int n = 0; n < thresholds::null_vector_steps; ++n) {
    if (!system.solve(v, mu)) {
      why = "the singular mode could not be found";
      return {};
    }
    double size = 0;
    for (const int c : plan.coordinate) size = std::max(size, std::abs(v[at(c)]));
    for (double& x : v) x /= size;
    for (double& x : mu) x /= size;
  }
  ResidualDerivatives residual(here, models, parameters);
  const Snapshot snapshot{.evaluator = here, .t = place.t, .q = place.q, .lambda = place.lambda};
  residual.find(snapshot);
  double size = 0, length = 0;
  std::vector<double> products = residual.products(v, mu, size);
  for (const double x : v) length += x * x;
  for (const double x : mu) length += x * x;
  const double by_load = products.back();
  if (!(std::abs(by_load) > no_work * size * std::sqrt(length))) {
    why = "the load does no work on the singular mode: a branch point, whose load has no derivative along the path";
    return {};
  }
  products.pop_back();
  for (double& product : products) product = -product / by_load;
  return products;
}

}  // namespace catena
