// PhasedMeasures: steps of the motion that are too long for y^, in parts.
#include <algorithm>
#include <cmath>

#include "catena/analysis/adjoint/phased_measures.hpp"
#include "catena/analysis/motion/stage_sums.hpp"
#include "catena/analysis/sensitivity/recomputed_steps.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

double largest_part(std::span<const double> y) {
  double largest = 0;
  for (const double x : y) largest = std::max(largest, std::abs(x));
  return largest;
}

}  // namespace

std::size_t PhasedMeasures::begun() const {
  return at(static_cast<int>(std::count_if(ways_.begin(), ways_.end(), [](const Way& way) { return way.begun; })));
}

bool PhasedMeasures::errors_back(double h, std::size_t stage, Way& way) {
  static const std::array weights = {stage_weights_back(false, dormand_prince_8().error),
                                     stage_weights_back(false, dormand_prince_8().error_low)};
  Vector slope(2 * n_);
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const auto vector_of = [&](int j) { return (j == step_end ? way.y1 : way.errors[k][at(j)]).data(); };
    add_stages({}, h, weights[k][stage], vector_of, slope);
    if (!stage_back(stage, slope, way.errors[k][stage])) return false;
  }
  return true;
}

double PhasedMeasures::excess() const {
  double worst = 0;
  for (const Way& way : ways_) {
    if (!way.begun) continue;
    std::array<double, 2> errors{};
    for (std::size_t k = 0; k < errors.size(); ++k) {
      Vector sum(2 * n_, 0.0);
      for (const Vector& back : way.errors[k]) add_times(sum, 1, back);
      for (const std::size_t first : {std::size_t{0}, n_}) {
        const auto part = [&](const Vector& y) { return largest_part(std::span(y).subspan(first, n_)); };
        const double size = std::max(part(way.y0), part(way.y1));
        if (size > 0) errors[k] = std::max(errors[k], part(sum) / size);
      }
    }
    worst = std::max(worst, error_of_step(errors[0], errors[1]));
  }
  return worst / aim_.allowed();
}

// Where parts begin states are those of the recomputed motion, and places on curves those of the step.
bool PhasedMeasures::divide(std::size_t& k, int parts) {
  const Step whole = steps_[k - 1];
  const double h = (whole.to - whole.from) / parts;
  if (!is_long_enough(h, whole.from)) return lose(whole.from, "the adjoint changes too fast for steps of any length,");
  std::vector<Step> some;
  Step part = whole;
  for (int number = 1; number <= parts; ++number) {
    part.to = number == parts ? whole.to : whole.from + h * number;
    part.end = whole.end;
    if (number < parts) {
      if (!recompute(part, false)) return false;
      add_stages(
          part.begin, part.to - part.from, dormand_prince_8().b, [&](int s) { return slope_[at(s)].data(); }, part.end);
    }
    some.push_back(part);
    part.from = part.to;
    part.begin = part.end;
  }
  replace_by_parts(steps_, crossings_, k, some);
  return true;
}

}  // namespace catena
