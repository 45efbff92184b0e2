#include "catena/analysis/dynamics/integrators/stages.hpp"

#include <algorithm>

namespace catena {

void Stages::combine(const StageSum& sum, double h, const double* from, std::span<double> out) const {
  constexpr std::size_t piece = 256;  // stays in the first cache while all stages are added
  for (std::size_t begin = 0; begin < out.size(); begin += piece) {
    const std::size_t end = std::min(begin + piece, out.size());
    for (std::size_t i = begin; i < end; ++i) out[i] = from ? from[i] : 0;
    for (const StageTerm& term : sum) {
      const double weight = h * term.weight;
      const double* k = slope_[static_cast<std::size_t>(term.stage)].data();
      for (std::size_t i = begin; i < end; ++i) out[i] += weight * k[i];
    }
  }
}

}  // namespace catena
