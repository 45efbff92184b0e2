#include "catena/analysis/sensitivity/static_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace catena {
namespace {

// A gap below this part of the length scale is closed; a push below this part of the largest multiplier is none.
// Both are what equilibria are found to (1e-11) with two digits to spare.
constexpr double touching = 1e-9, pushing = 1e-9;
// Places are rounded to this part of the length scale: what they make of the stiffest spring is no push either.
constexpr double rounding_of_places = 1e-14;

}  // namespace

StaticDerivatives::StaticDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters)
    : StateDerivatives(evaluator, models, parameters),
      system_(evaluator.shared_plan(), SaddleBlock::elements),
      rest_(static_cast<std::size_t>(plan().coordinates()), 0.0) {}

bool StaticDerivatives::leave_open_gaps_out(const Snapshot& snapshot) {
  std::vector<double> phi(static_cast<std::size_t>(plan().rows));
  evaluator().phi(phi);
  double largest = 0;
  for (const double multiplier : snapshot.lambda) largest = std::max(largest, std::abs(multiplier));
  double stiffest = 0;
  if (!plan().gap_rows.empty()) {
    evaluator().visit_stiffness(rest_, [&](int, int, const ElementMatrix& m) {
      for (const double entry : m) stiffest = std::max(stiffest, std::abs(entry));
    });
  }
  const double none = std::max(pushing * largest, rounding_of_places * evaluator().length_scale() * stiffest);
  std::vector<int> open;
  for (const int r : plan().gap_rows) {
    const auto row = static_cast<std::size_t>(r);
    const bool pushes = std::abs(snapshot.lambda[row]) > none;
    if (pushes) continue;
    if (phi[row] <= touching * evaluator().length_scale()) {
      const int element = plan().row_element[row];
      return fail(
          fmt::format("\"{}\" touches without a force that can be told from rounding: it opens one way and "
                      "closes the other",
                      evaluator().model().element_name(element)));
    }
    open.push_back(r);
  }
  system_.leave_out(std::move(open));
  return true;
}

bool StaticDerivatives::neutral() {
  return fail("the equilibrium is neutral or at a critical point: its place has no derivative");
}

bool StaticDerivatives::factorize(const Snapshot& snapshot, bool transposed) {
  evaluator().set_time(snapshot.t);
  evaluator().set_configuration(snapshot.q);
  if (!leave_open_gaps_out(snapshot)) return false;
  if (is_neutral_ && is_neutral_()) return neutral();
  if (!system_.begin(jacobian())) return neutral();
  evaluator().visit_stiffness(rest_, [&](int i, int j, ElementMatrix m) {
    for (std::size_t r = 0; transposed && r < 6; ++r) {
      for (std::size_t c = 0; c < r; ++c) std::swap(m[6 * r + c], m[6 * c + r]);
    }
    system_.add_element(i, j, m);
  });
  evaluator().visit_constraint_hessians(snapshot.lambda,
                                        [&](int i, int j, const ElementMatrix& m) { system_.add_element(i, j, m); });
  return system_.factorize() || neutral();
}

bool StaticDerivatives::find(const Snapshot& snapshot) {
  if (!factorize(snapshot, false)) return false;
  const std::span<double> f = loads_scratch(), b = rows_scratch();
  const bool unique = system_.dependent_rows().empty();
  for (Group& group : groups()) {
    DesignMechanism& mechanism = group.mechanism;
    mechanism.freeze_time(snapshot.t);
    lift_state(group, snapshot);
    mechanism.set_state(group.q);
    mechanism.rows(group.rows);
    mechanism.applied_forces(group.loads);
    for (DesignScalar& load : group.loads) load = -load;
    mechanism.add_constraint_loads(group.lambda, group.loads);
    for (std::size_t p = 0; p < static_cast<std::size_t>(group.count); ++p) {
      for (std::size_t c = 0; c < f.size(); ++c) f[c] = -group.loads[c].d[p];
      for (std::size_t r = 0; r < b.size(); ++r) b[r] = -group.rows[r].f.d[p];
      if (!system_.solve(f, b)) return neutral();
      for (const int c : plan().coordinate) group.q[static_cast<std::size_t>(c)].d[p] = f[static_cast<std::size_t>(c)];
      for (std::size_t r = 0; r < b.size(); ++r) group.lambda[r].d[p] = b[r];
      if (const int row = system_.contradicted_row(); row >= 0) leave_out_parameter(group, p, row);
    }
    if (!unique) leave_out_reactions(group);
    mechanism.set_state(group.q);
  }
  return true;
}

// Along q_p, V changes by V_q q_p = -lambda^T Phi_q q_p = lambda^T Phi_p: the derivative of V itself.
std::vector<double> StaticDerivatives::energy_gradient() {
  std::vector<double> gradient;
  for (Group& group : groups()) {
    const DesignScalar energy = group.mechanism.potential().f;
    for (std::size_t p = 0; p < static_cast<std::size_t>(group.count); ++p) gradient.push_back(energy.d[p]);
  }
  return gradient;
}

}  // namespace catena
