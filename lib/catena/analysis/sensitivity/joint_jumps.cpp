// Jumps of functions of time that meet at an instant and move apart.
#include <algorithm>
#include <array>
#include <cmath>

#include "catena/analysis/sensitivity/moving_instants.hpp"

namespace catena {
namespace {

// Jumps are looked for within so many times the way that the instant moves, and may miss its place by this part of it.
constexpr double neighbourhood = 3, same_place = 0.01;

bool jumps_at(const TimeFunction<double>& function, double t) {
  const TimeRange domain = function.domain();
  if (!domain.contains(t)) return false;
  const Taylor<double> before = function.evaluate(t, Side::before), after = function.evaluate(t, Side::after);
  std::array<double, 2> size{std::max(std::abs(before.d), std::abs(after.d)),
                             std::max(std::abs(before.dd), std::abs(after.dd))};
  double distance = std::max(std::abs(t), 1.0);
  for (int k = 0; k < jump_looks; ++k, distance /= 2) {
    for (const double there : {t - distance, t + distance}) {
      if (!domain.contains(there)) continue;
      const Taylor<double> f = function.evaluate(there);
      size[0] = std::max(size[0], std::abs(f.d));
      size[1] = std::max(size[1], std::abs(f.dd));
    }
  }
  return std::abs(before.d - after.d) > no_jump_part * size[0] ||
         std::abs(before.dd - after.dd) > no_jump_part * size[1];
}

}  // namespace

bool jumps_together(const std::vector<TimeFunction<double>>& moved, double t, double by) {
  const double reach = neighbourhood * std::abs(by), slack = same_place * std::abs(by);
  for (const TimeFunction<double>& function : moved) {
    if (function.is_constant()) continue;
    for (const double instant : function.breakpoints(t - reach, t + reach)) {
      if (std::abs(instant - t - by) > slack && jumps_at(function, instant)) return false;
    }
  }
  return true;
}

}  // namespace catena
