#include "catena/drawing/figures/axis_ticks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

namespace catena {
namespace {

/// 1, 2 or 5 times a power of ten, not below `least`.
double nice_step(double least) {
  const double power = std::pow(10, std::floor(std::log10(least)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (factor * power >= least * (1 - 1e-9)) return factor * power;
  }
  return 10 * power;
}

std::string decimal(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value == 0 ? 0.0 : value);
  return text;
}

/// The label in the form 2e-6, where decimals would be long.
std::string scientific(double value, double step) {
  if (value == 0) return "0";
  const int decimals = std::max(0, static_cast<int>(std::floor(std::log10(std::abs(value)) + 1e-9)) -
                                       static_cast<int>(std::floor(std::log10(step) + 1e-9)));
  char text[64];
  std::snprintf(text, sizeof text, "%.*e", std::min(decimals, 12), value);
  std::string label(text);
  const std::size_t e = label.find('e');
  int exponent = std::stoi(label.substr(e + 1));
  return label.substr(0, e) + "e" + std::to_string(exponent);
}

AxisTicks linear_ticks(double low, double high, int wanted, AxisEnds ends) {
  // A line of equal values gets some room; so does one whose values differ by rounding alone.
  const double size = std::max(std::abs(low), std::abs(high));
  if (high - low <= 1e-12 * size || high == low) {
    const double room = size > 0 ? 0.1 * size : 1;
    low -= room;
    high += room;
  }
  AxisTicks axis;
  const double step = nice_step((high - low) / std::max(1, wanted));
  axis.first = std::floor(low / step + 1e-9) * step;
  axis.last = std::ceil(high / step - 1e-9) * step;
  const auto count = static_cast<int>(std::lround((axis.last - axis.first) / step));
  const double largest = std::max(std::abs(axis.first), std::abs(axis.last));
  const bool long_numbers = largest >= 1e5 || largest < 1e-3;
  const int decimals = std::max(0, static_cast<int>(-std::floor(std::log10(step) + 1e-9)));
  for (int k = 0; k <= count; ++k) {
    const double value = std::abs(axis.first + k * step) < 1e-9 * step ? 0 : axis.first + k * step;
    axis.at.push_back(value);
    axis.labels.push_back(long_numbers ? scientific(value, step) : decimal(value, decimals));
  }
  if (ends == AxisEnds::round) return axis;
  // The outer marks may lie beyond the values.
  axis.first = low;
  axis.last = high;
  while (axis.at.back() > high + 1e-9 * step) axis.at.pop_back(), axis.labels.pop_back();
  if (axis.at.front() < low - 1e-9 * step) {
    axis.at.erase(axis.at.begin());
    axis.labels.erase(axis.labels.begin());
  }
  return axis;
}

AxisTicks logarithmic_ticks(double low, double high, int wanted) {
  AxisTicks axis;
  axis.logarithmic = true;
  const auto first = static_cast<int>(std::floor(std::log10(low) + 1e-9));
  const auto last = std::max(first + 1, static_cast<int>(std::ceil(std::log10(high) - 1e-9)));
  axis.first = std::pow(10, first);
  axis.last = std::pow(10, last);
  const int every = std::max(1, (last - first) / std::max(1, wanted));
  for (int power = first; power <= last; power += every) {
    axis.at.push_back(std::pow(10, power));
    axis.labels.push_back("1e" + std::to_string(power));
  }
  return axis;
}

}  // namespace

double AxisTicks::place(double value) const {
  if (!logarithmic) return (value - first) / (last - first);
  if (!(value > 0)) return std::numeric_limits<double>::quiet_NaN();
  return std::log(value / first) / std::log(last / first);
}

AxisTicks choose_ticks(std::span<const double> values, int wanted, bool logarithmic, AxisEnds ends) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (const double value : values) {
    if (!std::isfinite(value) || (logarithmic && !(value > 0))) continue;
    low = std::min(low, value);
    high = std::max(high, value);
  }
  if (!(low <= high)) low = logarithmic ? 1 : 0, high = logarithmic ? 10 : 1;  // nothing to show
  return logarithmic ? logarithmic_ticks(low, high, wanted) : linear_ticks(low, high, wanted, ends);
}

}  // namespace catena
