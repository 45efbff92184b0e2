#include "catena/analysis/adjoint/static_adjoint.hpp"

#include <algorithm>
#include <limits>

#include "catena/base/at.hpp"

namespace catena {

StaticAdjoint::StaticAdjoint(const Evaluator& evaluator, const DesignModels& models, int parameters)
    : StaticDerivatives(evaluator, models, parameters), mechanism_(this->evaluator()) {
  for (Group& group : groups())
    reached_.push_back(std::make_unique<AdjointMechanism::Reached>(mechanism_, group.mechanism));
}

bool StaticAdjoint::find(const Snapshot& snapshot) {
  lift_at_rest(snapshot);
  return true;
}

bool StaticAdjoint::derive(const ColumnSet& columns, const Snapshot& snapshot, std::span<double> out,
                           std::span<double> change) {
  std::fill(change.begin(), change.end(), 0.0);
  std::fill(out.begin(), out.end(), std::numeric_limits<double>::quiet_NaN());
  if (!find(snapshot) || !factorize(snapshot, true)) return false;
  // Which parameters contradict them is seen by carrying derivatives forward alone.
  if (!system().dependent_rows().empty()) return fail("constraints depend on each other");
  ColumnSlopes slopes(evaluator().model(), columns, mechanisms(), parameters());
  slopes.look(snapshot);
  mechanism_.set_motion(evaluator(), {}, {});
  const std::span<double> w = loads_scratch(), mu = rows_scratch();
  const auto all = at(parameters());
  for (std::size_t k = 0; k < columns.size(); ++k) {
    StateSlopes by = slopes.empty();
    slopes.add(k, 1, by);
    std::copy(by.by_q.begin(), by.by_q.end(), w.begin());
    std::fill(mu.begin(), mu.end(), 0.0);
    std::copy(by.by_lambda.begin(), by.by_lambda.end(), mu.begin());
    if (!system().solve(w, mu)) return neutral();
    // Coordinates that are no unknowns do not move with w.
    for (std::size_t c = 0; c < w.size(); ++c) {
      if (c >= plan().column.size() || plan().column[c] < 0) w[c] = 0;
    }
    const AdjointWeights weights{.w = w, .lambda = snapshot.lambda, .phi = mu};
    for (std::size_t g = 0, first = 0; g < groups().size(); first += parameters_at_once, ++g) {
      const auto part = mechanism_.by_parameters(groups()[g].mechanism, *reached_[g], weights, {});
      for (std::size_t p = 0; p < at(groups()[g].count); ++p) out[k * all + first + p] = by.by_p[first + p] + part[p];
    }
  }
  return true;
}

}  // namespace catena
