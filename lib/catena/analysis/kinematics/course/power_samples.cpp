#include "catena/analysis/kinematics/course/power_samples.hpp"

#include <algorithm>
#include <cmath>

namespace catena {
namespace {

// The places in a stretch of length one: those of WorkSum between its ends.
constexpr std::array<double, PowerSamples::places> place_in_stretch = {
    0, 0.069431844202973712, 0.33000947820757187, 0.66999052179242813, 0.93056815579702629, 1};
// p2 ... p5 there.
constexpr std::array<std::array<double, PowerSamples::places>, 4> polynomials = {{
    {0.418853908291696, 0.134696646659995, -0.553550554951690, -0.553550554951690, 0.134696646659995,
     0.418853908291695},
    {-0.366053325651938, 0.199606046717428, 0.571106285110746, -0.571106285110746, -0.199606046717428,
     0.366053325651938},
    {0.397359707119513, -0.561417978614763, 0.164058271495249, 0.164058271495249, -0.561417978614762,
     0.397359707119513},
    {-0.311085508419128, 0.510399649179225, -0.377780365515913, 0.377780365515913, -0.510399649179225,
     0.311085508419128},
}};

}  // namespace

void PowerSamples::begin(const Evaluator& evaluator) {
  laws_.begin(evaluator);
  for (std::vector<Vec2<double>>& there : pressing_) there.clear();
}

void PowerSamples::take(std::size_t place, double dissipated, double supplied, std::span<const double> qd) {
  power_[0][place] = dissipated;
  power_[1][place] = supplied;
  laws_.read(qd, differences_[place]);
}

double PowerSamples::error(double span) const {
  double largest = 0;
  for (const auto& power : power_) {
    std::array<double, polynomials.size()> c{};
    for (std::size_t k = 0; k < c.size(); ++k) {
      for (std::size_t place = 0; place < places; ++place) c[k] += polynomials[k][place] * power[place];
    }
    const double low = std::hypot(c[0], c[1]), top = std::hypot(c[2], c[3]) / std::sqrt(double{places});
    const double part = std::hypot(c[2], c[3]) / (unresolved * low);
    largest = std::max(largest, std::abs(span) * top * (part < 1 ? part * part : 1));
  }
  return largest;
}

double PowerSamples::turning_power() const {
  double all = 0;
  for (std::size_t k = 0; k < pressing_[1].size(); ++k) {
    std::array<double, places> t{}, v{};
    std::size_t known = 0;
    Vec2<double> start{};
    double largest = 0;
    for (std::size_t place = 0; place < places; ++place) {
      if (pressing_[place].empty()) continue;
      const Vec2<double>& p = pressing_[place][k];
      if (dot(start, start) == 0) start = p;
      largest = std::max(largest, std::hypot(p.x, p.y));
      t[known] = place_in_stretch[place];
      v[known++] = dot(start, p);
    }
    if (LawSwitches::may_switch(std::span<const double>(t).first(known), std::span<const double>(v).first(known)))
      all += largest;
  }
  return all;
}

bool PowerSamples::may_switch() const {
  for (std::size_t k = 0; k < differences_[0].size(); ++k) {
    std::array<double, places> v{};
    for (std::size_t place = 0; place < places; ++place) v[place] = differences_[place][k];
    if (LawSwitches::may_switch(place_in_stretch, v)) return true;
  }
  return false;
}

}  // namespace catena
