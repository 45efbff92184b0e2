#include "catena/scene/judging/distance_check.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "catena/elements/all.hpp"
#include "catena/elements/element.hpp"

namespace catena {
namespace {

using Function = TimeFunction<double>;

constexpr double samples_a_row = 4;
constexpr double least_samples = 64, most_samples = 2e5;

/// The root of `positive` turning false between a, where it holds, and b.
template <class F>
double turning_point(double a, double b, F&& positive) {
  for (int k = 0; k < 200 && a != b; ++k) {
    const double middle = a + (b - a) / 2;
    if (middle == a || middle == b) break;
    (positive(middle) ? a : b) = middle;
  }
  return b;
}

/// The first instant on the way from `first` to `last` at which f is not above zero.
std::optional<double> first_zero(const Function& f, double first, double last, int samples) {
  const auto positive = [&](double t) { return f.evaluate(t).f > 0; };
  if (!positive(first)) return first;
  double before = first;
  for (int k = 1; k <= samples && first != last; ++k) {
    const double t = k == samples ? last : first + (last - first) * k / samples;
    if (!positive(t)) return turning_point(before, t, positive);
    const auto falls = [&](double x) { return f.evaluate(x).d * (last - first) < 0; };
    if (falls(before) && !falls(t)) {
      const double least = turning_point(before, t, falls);
      if (!positive(least)) return turning_point(before, least, positive);
    }
    before = t;
  }
  return {};
}

}  // namespace

std::optional<std::string> vanishing_distance(const Model& model, double first, const TimeGrid& grid) {
  double last = grid.last();
  for (std::int64_t k = 0; k < grid.size() && grid.size() < 1000; ++k)
    if (std::abs(grid[k] - first) > std::abs(last - first)) last = grid[k];
  const double wanted = samples_a_row * static_cast<double>(grid.size());
  const int samples = static_cast<int>(std::clamp(wanted, least_samples, most_samples));
  std::optional<std::string> message;
  for_each_list(model.constraints, [&](const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    if constexpr (HasSquaredValue<E>) {
      for (const auto& entry : list) {
        const int function = entry.values[0].function;
        if (message || function < 0) continue;
        const auto t = first_zero(model.functions[static_cast<std::size_t>(function)], first, last, samples);
        if (t)
          message = fmt::format(
              "the distance of {} \"{}\" is not above zero at t = {:.12g} s; keep it positive, or drive the two "
              "coordinates instead",
              E::type, model.element_name(entry.id), *t);
      }
    }
  });
  return message;
}

}  // namespace catena
