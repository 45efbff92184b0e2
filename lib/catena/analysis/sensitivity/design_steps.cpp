#include "catena/analysis/sensitivity/design_steps.hpp"

#include "catena/analysis/sensitivity/recomputed_steps.hpp"
#include "catena/base/at.hpp"

namespace catena {

void combine_stages(const StageSum& sum, double h, const DesignVector& from, const std::vector<DesignVector>& stages,
                    DesignVector& out) {
  out = from;
  for (const StageTerm& term : sum) {
    const DesignScalar weight(h * term.weight);
    const DesignVector& k = stages[at(term.stage)];
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += weight * k[i];
  }
}

void interpolate_derivatives(double part, double h, const DesignVector& begin, const DesignVector& end,
                             const std::vector<DesignVector>& stages, DesignVector& y) {
  const InterpolantWeights weights = interpolant_weights(part);
  for (std::size_t i = 0; i < y.size(); ++i) {
    for (std::size_t p = 0; p < static_cast<std::size_t>(parameters_at_once); ++p) {
      double d = (1 - weights.end) * begin[i].d[p] + weights.end * end[i].d[p];
      for (std::size_t s = 0; s < weights.slope.size(); ++s) d += h * weights.slope[s] * stages[s][i].d[p];
      y[i].d[p] = d;
    }
  }
}

}  // namespace catena
