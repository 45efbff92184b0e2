#include "catena/analysis/accuracy/motion_rounding.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/balance/force_sizes.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
MotionRounding::MotionRounding(const Evaluator& evaluator) : length_(evaluator.length_scale()) {
  const Plan& plan = evaluator.plan();
  std::vector<double> sum = force_sizes(evaluator).all;
  const auto reach = [&](int b) { return b >= 0 ? norm(evaluator.ground_frame(b).origin()) : 0.0; };
  evaluator.visit_stiffness({}, [&](int i, int j, const ElementMatrix& m) {
    const double places = length_ + reach(i) + reach(j);
    for (int row = 0; row < 6; ++row) {
      const int c = plan.column_of(i, j, row);
      if (c < 0) continue;
      for (int k = 0; k < 6; ++k)
        sum[at(plan.coordinate[at(c)])] += std::abs(m[at(6 * row + k)]) * (k % 3 == 2 ? 1 : places);
    }
  });
  for (int p = 0; p < plan.moving; ++p) {
    const auto& body = evaluator.model().bodies[at(plan.model_body[at(p)])];
    for (std::size_t c = 0; c < 3; ++c) {
      const double size = sum[3 * at(p) + c], inertia = c == 2 ? body.inertia : body.mass;
      force_ = std::max(force_, c == 2 ? size / length_ : size);
      if (inertia > 0) square_ = std::max(square_, size / (c == 2 ? inertia : inertia * length_));
    }
  }
}

double MotionRounding::least_error(UnitKind unit) const {
  const double rate = std::sqrt(square_), fastest = std::max(rate, rate_);
  switch (unit) {
    case UnitKind::velocity:
      return thresholds::few_roundings * length_ * fastest;
    case UnitKind::angular_velocity:
      return thresholds::few_roundings * fastest;
    case UnitKind::acceleration:
      return thresholds::few_roundings * length_ * fastest * fastest;
    case UnitKind::angular_acceleration:
      return thresholds::few_roundings * fastest * fastest;
    case UnitKind::force:
      return thresholds::few_roundings * force_;
    case UnitKind::torque:
    case UnitKind::energy:
      return thresholds::few_roundings * force_ * length_;
    case UnitKind::power:
      return thresholds::few_roundings * force_ * length_ * rate;
    case UnitKind::momentum:
      return rate > 0 ? thresholds::few_roundings * force_ / rate : 0;
    case UnitKind::angular_momentum:
      return rate > 0 ? thresholds::few_roundings * force_ * length_ / rate : 0;
    default:
      return 0;
  }
}

double fastest_rate(const Snapshot& snapshot, double length) {
  double rate = 0;
  for (std::size_t c = 0; c < snapshot.qd.size(); ++c)
    rate = std::max(rate, std::abs(snapshot.qd[c]) / (c % 3 == 2 ? 1 : length));
  return rate;
}

}  // namespace catena
