#include "catena/analysis/motion/derivative_error.hpp"

#include <array>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

EmbeddedError make_error(const StageSum& weights) {
  std::array<double, 12> of_q{};
  for (const StageTerm& outer : weights) {
    for (const StageTerm& inner : dormand_prince_8().a[at(outer.stage)])
      of_q[at(inner.stage)] += outer.weight * inner.weight;
  }
  EmbeddedError error{weights, {}};
  for (int s = 0; s < static_cast<int>(of_q.size()); ++s) {
    if (of_q[at(s)] != 0) error.of_q.term[at(error.of_q.count++)] = {s, of_q[at(s)]};
  }
  return error;
}

}  // namespace

// e is 3 to 20 times what an oscillation truly misses (over 0.3 ... 2 radians, whatever its phase): some tenth of the
// tolerance a step, as steps add up. Derivatives have a hundred times the rounding of the motion.
double DerivativeAim::allowed() const { return std::max(tolerance, 1e-12); }

// Positions of metres have rounding of 1e-16, derivatives some hundred times as much.
double DerivativeAim::least(std::size_t p) const {
  const double size = p < sizes.size() && sizes[p] != 0 ? std::abs(sizes[p]) : 1;
  return 1e-14 / (allowed() * size);
}

const EmbeddedError& embedded_error_high() {
  static const EmbeddedError error = make_error(dormand_prince_8().error);
  return error;
}

const EmbeddedError& embedded_error_low() {
  static const EmbeddedError error = make_error(dormand_prince_8().error_low);
  return error;
}

double relative_error(double h, double of_q, double of_qd, const StepSizes& sizes, double least) {
  const double v = std::max({sizes.qd, std::sqrt(sizes.q * sizes.qdd), h * sizes.qdd, least});
  return std::max(h * h * of_q / std::max(sizes.q, least), h * of_qd / v);
}

int parts_for(double excess) {
  // More than numbers have digits is no estimate: parts are divided again.
  return 1 + static_cast<int>(std::pow(std::min(excess, 1 / std::numeric_limits<double>::epsilon()), 1.0 / 8));
}

bool is_long_enough(double h, double from) { return h > thresholds::carried_rounding * std::max(1.0, std::abs(from)); }

bool BackChecks::is_due(double h, std::size_t begun) const {
  if (begun != begun_ || since_ >= dormand_prince_8().c.size()) return true;
  return excess_ * std::pow(h / length_, 8) > 1;
}

void BackChecks::note(double h, std::size_t begun, double excess) {
  length_ = h;
  excess_ = excess;
  since_ = 0;
  begun_ = begun;
}

}  // namespace catena
