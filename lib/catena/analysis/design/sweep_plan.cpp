#include "catena/analysis/design/sweep_plan.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace catena {
namespace {

bool is_sampled(SweepKind kind) { return kind != SweepKind::grid && kind != SweepKind::together; }

/// How many values a list or steps have.
double size(const SweepRange& range) {
  return range.kind == SweepRange::Kind::steps ? range.count : static_cast<double>(range.values.size());
}

/// Value k of them.
double value(const SweepRange& range, std::int64_t k) {
  if (range.kind != SweepRange::Kind::steps) return range.values[static_cast<std::size_t>(k)];
  const auto step = static_cast<double>(k), last = range.count - 1;
  // The last one exactly.
  return step == last && last > 0 ? range.second
                                  : range.first + step * (range.second - range.first) / std::max(1.0, last);
}

/// Designs of a plan, as a number that may be larger than any plan.
double count(const SweepRequest& request) {
  if (is_sampled(request.kind)) return static_cast<double>(request.samples);
  double product = 1, longest = 1;
  for (const SweepRange& range : request.over) {
    product *= size(range);
    longest = std::max(longest, size(range));
  }
  return request.kind == SweepKind::grid ? product : longest;
}

/// A value of a range by a number in (0, 1).
double value_at(const SweepRange& range, double u) {
  switch (range.kind) {
    case SweepRange::Kind::normal:
      return range.first + range.second * normal_quantile(u);
    case SweepRange::Kind::uniform:
      return range.first + u * (range.second - range.first);
    case SweepRange::Kind::steps:
      // A single step is the first value.
      return range.count > 1 ? range.first + u * (range.second - range.first) : range.first;
    case SweepRange::Kind::list:
      break;
  }
  // Rounding may bring u n to n.
  const auto n = static_cast<double>(range.values.size());
  return range.values[static_cast<std::size_t>(std::min(std::floor(u * n), n - 1))];
}

}  // namespace

std::optional<std::string> SweepPlan::trouble(const SweepRequest& request) {
  if (request.over.empty()) return "a sweep needs at least one parameter in \"over\"";
  for (const SweepRange& range : request.over) {
    if (!range.is_distribution() && !(size(range) >= 1)) return "a parameter has no values";
    if (range.is_distribution() && !is_sampled(request.kind))
      return "distributions are sampled: take \"design\" sobol, latin or random";
  }
  if (is_sampled(request.kind) && request.samples < 1) return "\"samples\" must be at least 1";
  if (request.kind == SweepKind::sobol && request.over.size() > SamplePoints::most_sobol_directions) {
    return "Sobol's sequence is made for at most " + std::to_string(SamplePoints::most_sobol_directions) +
           " parameters; take latin or random";
  }
  const auto numbers = static_cast<double>(request.samples) * static_cast<double>(request.over.size());
  if (request.kind == SweepKind::latin && numbers > static_cast<double>(most_latin_numbers)) {
    return fmt::format("a latin design keeps all its samples: {:.3g} numbers are more than {}; take sobol or random",
                       numbers, most_latin_numbers);
  }
  const double designs = count(request);
  if (designs >= static_cast<double>(most_designs)) {
    return fmt::format("{:.3g} designs are asked for; a sweep has less than {}{}", designs, most_designs,
                       is_sampled(request.kind) ? "" : ": take a sampled \"design\", such as sobol");
  }
  if (request.kind != SweepKind::together) return {};
  for (const SweepRange& range : request.over) {
    if (size(range) != 1 && size(range) != designs) {
      return fmt::format("\"together\" wants lists of one length: there are lists of {} and of {} values", size(range),
                         designs);
    }
  }
  return {};
}

SweepPlan::SweepPlan(SweepRequest request) : request_(std::move(request)) {
  if (const std::optional<std::string> why = trouble(request_)) throw std::invalid_argument(*why);
  designs_ = static_cast<std::int64_t>(count(request_));
  if (!is_sampled(request_.kind)) return;
  constexpr Sampling kinds[] = {Sampling::sobol, Sampling::latin, Sampling::random};
  points_.emplace(kinds[static_cast<int>(request_.kind) - static_cast<int>(SweepKind::sobol)], designs_,
                  static_cast<int>(request_.over.size()), request_.seed);
}

void SweepPlan::values(std::int64_t k, std::span<double> out) const {
  const std::size_t n = request_.over.size();
  if (points_) {
    points_->point(k, out);
    for (std::size_t p = 0; p < n; ++p) out[p] = value_at(request_.over[p], out[p]);
    return;
  }
  for (std::size_t p = n; p-- > 0;) {
    const auto values = static_cast<std::int64_t>(size(request_.over[p]));
    const std::int64_t place = request_.kind == SweepKind::grid ? k % values : values == 1 ? 0 : k;
    out[p] = value(request_.over[p], place);
    if (request_.kind == SweepKind::grid) k /= values;
  }
}

}  // namespace catena
