#include "catena/analysis/sensitivity/static_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {

StaticDerivatives::StaticDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters)
    : StateDerivatives(evaluator, models, parameters), system_(evaluator.shared_plan(), SaddleBlock::elements) {}

std::vector<int> StaticDerivatives::gaps_without_force(const Snapshot& snapshot, int& touches) {
  std::vector<double> phi(static_cast<std::size_t>(plan().rows));
  evaluator().phi(phi);
  double largest = 0;
  for (const double multiplier : snapshot.lambda) largest = std::max(largest, std::abs(multiplier));
  double stiffest = 0;
  if (!plan().gap_rows.empty()) {
    evaluator().visit_stiffness({}, [&](int, int, const ElementMatrix& m) {
      for (const double entry : m) stiffest = std::max(stiffest, std::abs(entry));
    });
  }
  const double none =
      std::max(thresholds::no_force * largest, thresholds::sum_rounding * evaluator().length_scale() * stiffest);
  std::vector<int> open;
  touches = -1;
  for (const int r : plan().gap_rows) {
    const auto row = static_cast<std::size_t>(r);
    const bool pushes = std::abs(snapshot.lambda[row]) > none;
    if (pushes) continue;
    if (touches < 0 && phi[row] <= thresholds::closed_gap * evaluator().length_scale())
      touches = plan().row_element[row];
    open.push_back(r);
  }
  return open;
}

bool StaticDerivatives::leave_open_gaps_out(const Snapshot& snapshot) {
  int touches = -1;
  std::vector<int> open = gaps_without_force(snapshot, touches);
  if (touches >= 0) {
    return fail(
        fmt::format("\"{}\" touches without a force that can be told from rounding: it opens one way and "
                    "closes the other",
                    evaluator().model().element_name(touches)));
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
  const bool factored =
      system_.factorize(jacobian(), [&] { system_.tangent().add_stiffness(evaluator(), snapshot.lambda, transposed); });
  return factored || neutral();
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

void StaticDerivatives::lift_at_rest(const Snapshot& snapshot) {
  for (Group& group : groups()) {
    group.mechanism.freeze_time(snapshot.t);
    lift_state(group, snapshot);
    group.mechanism.set_state(group.q);
  }
}

// Along q_p, V changes by V_q q_p = -lambda^T Phi_q q_p = lambda^T Phi_p. Gaps without a force have no part of it,
// whichever way they go.
std::vector<double> StaticDerivatives::energy_gradient(const Snapshot& snapshot, std::string& why) {
  evaluator().set_time(snapshot.t);
  evaluator().set_configuration(snapshot.q);
  lift_at_rest(snapshot);
  std::vector<double> gradient;
  for (Group& group : groups()) {
    DesignScalar lagrangian = group.mechanism.potential().f;
    group.mechanism.rows(group.rows);
    for (std::size_t r = 0; r < group.rows.size(); ++r) lagrangian += DesignScalar(group.lambda[r].v) * group.rows[r].f;
    for (std::size_t p = 0; p < at(group.count); ++p) gradient.push_back(lagrangian.d[p]);
  }
  leave_out_contradicting(snapshot, gradient, why);
  return gradient;
}

// The least change of place, m and rad, that rows ask for: any that meets the independent ones tells contradictions.
void StaticDerivatives::leave_out_contradicting(const Snapshot& snapshot, std::vector<double>& gradient,
                                                std::string& why) {
  const auto moves = [](const Taylor<DesignScalar>& row) {
    return std::any_of(row.f.d.begin(), row.f.d.end(), [](double d) { return d != 0; });
  };
  if (std::none_of(groups().begin(), groups().end(),
                   [&](const Group& group) { return std::any_of(group.rows.begin(), group.rows.end(), moves); }))
    return;
  SaddleSystem least(evaluator().shared_plan(), SaddleBlock::diagonal);
  int touches = -1;
  least.leave_out(gaps_without_force(snapshot, touches));
  bool regular = least.begin(jacobian());
  if (regular && least.dependent_rows().empty()) return;
  for (const int c : plan().coordinate) {
    if (regular) least.add_diagonal(c, 1);
  }
  regular = regular && least.factorize();
  const std::span<double> f = loads_scratch(), b = rows_scratch();
  std::size_t place = 0;
  for (Group& group : groups()) {
    for (std::size_t p = 0; p < at(group.count); ++p, ++place) {
      std::fill(f.begin(), f.end(), 0.0);
      for (std::size_t r = 0; r < b.size(); ++r) b[r] = -group.rows[r].f.d[p];
      const bool solved = regular && least.solve(f, b);
      const int row = solved ? least.contradicted_row() : -1;
      if (solved && row < 0) continue;
      gradient[place] = std::numeric_limits<double>::quiet_NaN();
      why = solved ? describe_contradiction(evaluator().model(), plan(), row)
                   : "constraints depend on each other, and which parameters contradict them cannot be told";
    }
  }
}

}  // namespace catena
