#include "catena/analysis/dynamics/integrators/stages.hpp"

#include "catena/analysis/motion/stage_sums.hpp"

namespace catena {

void Stages::combine(const StageSum& sum, double h, std::span<const double> from, std::span<double> out) const {
  add_stages(
      from, h, sum, [&](int stage) { return slope_[static_cast<std::size_t>(stage)].data(); }, out);
}

}  // namespace catena
