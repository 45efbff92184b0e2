#include "catena/analysis/sensitivity/design_steps.hpp"

#include <algorithm>
#include <cmath>

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

double error_of_derivatives(double h, const DesignVector& begin, const DesignVector& end,
                            const std::vector<DesignVector>& stages, const DerivativeAim& aim, std::size_t group) {
  const std::size_t n = begin.size() / 2, last = at(dormand_prince_8().stages - 1);
  double largest = 0;
  for (std::size_t p = 0; p < static_cast<std::size_t>(parameters_at_once); ++p) {
    const auto missed = [&](const StageSum& terms) {
      double worst = 0;
      for (std::size_t c = n; c < 2 * n; ++c) {
        double error = 0;
        for (const StageTerm& term : terms) error += term.weight * stages[at(term.stage)][c].d[p];
        worst = std::max(worst, std::abs(error));
      }
      return worst;
    };
    StepSizes sizes;
    for (std::size_t c = 0; c < n; ++c) {
      for (const DesignVector* y : {&begin, &end}) {
        sizes.q = std::max(sizes.q, std::abs((*y)[c].d[p]));
        sizes.qd = std::max(sizes.qd, std::abs((*y)[n + c].d[p]));
      }
      for (const std::size_t s : {std::size_t{0}, last})
        sizes.qdd = std::max(sizes.qdd, std::abs(stages[s][n + c].d[p]));
    }
    const double least = aim.least(group * parameters_at_once + p);
    const auto error = [&](const EmbeddedError& of) {
      return relative_error(h, missed(of.of_q), missed(of.of_qd), sizes, least);
    };
    largest = std::max(largest, error_of_step(error(embedded_error_high()), error(embedded_error_low())));
  }
  return largest;
}

}  // namespace catena
