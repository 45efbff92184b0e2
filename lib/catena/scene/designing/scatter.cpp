#include "catena/scene/designing/scatter.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/scene/designing/measured_design.hpp"

namespace catena {
namespace {

bool is_fixed(const SweepRange& range) { return range.kind == SweepRange::Kind::list && range.values.size() == 1; }

double mean_of(const SweepRange& range) {
  if (is_fixed(range)) return range.values.front();
  return range.kind == SweepRange::Kind::normal ? range.first : range.first + 0.5 * (range.second - range.first);
}

double deviation_of(const SweepRange& range) {
  if (is_fixed(range)) return 0;
  return range.kind == SweepRange::Kind::normal ? range.second : (range.second - range.first) / std::sqrt(12.0);
}

/// Values and gradients of the measures at the means of the parameters; what is missing is not a number.
struct AtMeans {
  std::vector<double> values;
  std::vector<std::vector<double>> gradients;
};

AtMeans at_means(const AnalysisContext& context, std::vector<std::string>& warnings) {
  DesignRequest request;
  request.rows = false;
  ParameterSeeds seeds = context.seeds;
  for (const SweepRange& range : context.task.sweep.over) {
    request.parameters.push_back(range.parameter);
    request.names.push_back(context.models->names().all()[static_cast<std::size_t>(range.parameter)]);
    seeds.push_back({range.parameter, mean_of(range)});
  }
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  AtMeans found;
  const auto take = [&](const AnalysisTask& inner, const AnalysisResult& result) {
    for (const PlacedMeasure& placed : inner.measures) {
      const MeasureResult* measure = value_of(placed, result);
      found.values.push_back(measure ? *measure->value : none);
      std::vector<double>& gradient = found.gradients.emplace_back(request.names.size(), none);
      if (measure)
        std::copy_n(measure->gradient.begin(), std::min(gradient.size(), measure->gradient.size()), gradient.begin());
      const bool whole = std::all_of(gradient.begin(), gradient.end(), [](double g) { return std::isfinite(g); });
      if (!whole)
        warnings.push_back(fmt::format("measure \"{}\" has no first-order deviation: {}", placed.request.name,
                                       measure ? measure->trouble : "it has no value at the means of the parameters"));
    }
    return true;
  };
  std::string why;
  const std::optional<Status> status = run_design(context, seeds, &request, nullptr, take, &why);
  if (status != Status::ok)
    warnings.push_back("there are no first-order deviations: at the means of the parameters " + why);
  return found;
}

}  // namespace

bool Scatter::is_meant(const SweepRequest& request) {
  const auto varies = [](const SweepRange& range) { return range.is_distribution(); };
  const auto fits = [&](const SweepRange& range) { return varies(range) || is_fixed(range); };
  return std::all_of(request.over.begin(), request.over.end(), fits) &&
         std::any_of(request.over.begin(), request.over.end(), varies);
}

void Scatter::add(std::span<const double> measures) {
  ++designs_;
  for (std::size_t m = 0; m < sums_.size() && m < measures.size(); ++m) {
    const double before = measures[m] - sums_[m].mean;
    sums_[m].mean += before / static_cast<double>(designs_);
    sums_[m].squares += before * (measures[m] - sums_[m].mean);
  }
}

std::vector<FieldRecord> Scatter::records(const AnalysisContext& context, std::vector<std::string>& warnings) const {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const AtMeans first_order = at_means(context, warnings);
  const std::vector<SweepRange>& over = context.task.sweep.over;
  std::vector<FieldRecord> records;
  for (const AnalysisTask& inner : context.task.of) {
    for (const PlacedMeasure& placed : inner.measures) {
      const std::size_t m = records.size();
      const double variance = sums_[m].squares / static_cast<double>(designs_ - 1);
      FieldRecord record{{"measure", placed.request.name},
                         {"mean", designs_ > 0 ? sums_[m].mean : none},
                         {"deviation", designs_ > 1 ? std::sqrt(variance) : none}};
      const bool known = m < first_order.values.size();
      record.emplace_back("first_order_mean", known ? first_order.values[m] : none);
      double squares = known ? 0 : none;
      FieldRecord shares;
      for (std::size_t p = 0; p < over.size(); ++p) {
        const double share = known ? first_order.gradients[m][p] * deviation_of(over[p]) : none;
        squares += share * share;
        shares.emplace_back("due_to " + context.models->names().all()[static_cast<std::size_t>(over[p].parameter)],
                            share);
      }
      record.emplace_back("first_order_deviation", std::sqrt(squares));
      record.insert(record.end(), shares.begin(), shares.end());
      records.push_back(std::move(record));
    }
  }
  return records;
}

}  // namespace catena
