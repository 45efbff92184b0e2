#include "catena/analysis/design/sweep_plan.hpp"

#include <algorithm>
#include <stdexcept>

namespace catena {
namespace {

bool is_sampled(SweepKind kind) { return kind != SweepKind::grid && kind != SweepKind::together; }

/// Designs of a plan; negative: more than are allowed.
std::int64_t count(const SweepRequest& request) {
  if (is_sampled(request.kind)) return request.samples > SweepPlan::most_designs ? -1 : request.samples;
  std::int64_t product = 1, longest = 1;
  for (const SweepRange& range : request.over) {
    const auto n = static_cast<std::int64_t>(range.values.size());
    longest = std::max(longest, n);
    if (product > SweepPlan::most_designs / std::max<std::int64_t>(n, 1)) return -1;
    product *= n;
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
    case SweepRange::Kind::list:
      break;
  }
  const auto [least, greatest] = std::minmax_element(range.values.begin(), range.values.end());
  return *least + u * (*greatest - *least);
}

}  // namespace

std::optional<std::string> SweepPlan::trouble(const SweepRequest& request) {
  if (request.over.empty()) return "a sweep needs at least one parameter in \"over\"";
  for (const SweepRange& range : request.over) {
    if (range.kind == SweepRange::Kind::list && range.values.empty()) return "a parameter has no values";
    if (range.kind != SweepRange::Kind::list && !is_sampled(request.kind))
      return "distributions are sampled: take \"design\" sobol, latin or random";
  }
  if (is_sampled(request.kind) && request.samples < 1) return "\"samples\" must be at least 1";
  if (request.kind == SweepKind::sobol && request.over.size() > SamplePoints::most_sobol_directions) {
    return "Sobol's sequence is made for at most " + std::to_string(SamplePoints::most_sobol_directions) +
           " parameters; take latin or random";
  }
  const std::int64_t designs = count(request);
  if (designs < 0) return "more than " + std::to_string(most_designs) + " designs are asked for";
  if (request.kind != SweepKind::together) return {};
  for (const SweepRange& range : request.over) {
    const auto n = static_cast<std::int64_t>(range.values.size());
    if (n != 1 && n != designs) {
      return "\"together\" wants lists of one length: there are lists of " + std::to_string(n) + " and of " +
             std::to_string(designs) + " values";
    }
  }
  return {};
}

SweepPlan::SweepPlan(SweepRequest request) : request_(std::move(request)) {
  if (const std::optional<std::string> why = trouble(request_)) throw std::invalid_argument(*why);
  designs_ = count(request_);
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
    const std::vector<double>& values = request_.over[p].values;
    const auto size = static_cast<std::int64_t>(values.size());
    const std::int64_t place = request_.kind == SweepKind::grid ? k % size : size == 1 ? 0 : k;
    out[p] = values[static_cast<std::size_t>(place)];
    if (request_.kind == SweepKind::grid) k /= size;
  }
}

}  // namespace catena
