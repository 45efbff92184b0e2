#include "catena/scene/designing/design_runs.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catena {

DesignRuns::DesignRuns(const AnalysisContext& context, bool by_values)
    : context_(context), goal_(context.task.goal), try_lanes_(by_values) {
  request_.rows = false;
  for (const DesignVariable& variable : goal_.variables) {
    request_.parameters.push_back(variable.parameter);
    request_.names.push_back(context.models->names().all()[static_cast<std::size_t>(variable.parameter)]);
  }
}

ParameterSeeds DesignRuns::seeds_of(std::span<const double> x) const {
  ParameterSeeds seeds = context_.seeds;
  for (std::size_t v = 0; v < x.size(); ++v) seeds.push_back({goal_.variables[v].parameter, x[v]});
  return seeds;
}

std::vector<std::string> DesignRuns::doubts() const {
  std::vector<std::string> doubts;
  for (const auto& [what, why] : doubts_) doubts.push_back(fmt::format("{} in some designs: {}", what, why));
  return doubts;
}

std::string DesignRuns::take_measures(const AnalysisTask& inner, const AnalysisResult& result, bool gradients,
                                      std::vector<Measured>& measures) {
  for (const PlacedMeasure& placed : inner.measures) {
    const MeasureResult* found = value_of(placed, result);
    if (!found) return "not_measured";
    Measured measured{*found->value, std::vector<double>(request_.names.size(), 0.0)};
    for (std::size_t p = 0; gradients && p < measured.gradient.size(); ++p) {
      // One that is not a number stays so in whatever is made of it, and the search takes the design for failed.
      measured.gradient[p] = p < found->gradient.size() ? found->gradient[p] : std::nan("");
      if (std::isfinite(measured.gradient[p])) continue;
      const std::string why = found->trouble.empty() ? "see the analysis by itself" : found->trouble;
      const std::lock_guard lock(mutex_);
      const auto [known, added] = doubts_.emplace(
          fmt::format("measure \"{}\" has no derivative by \"{}\"", found->name, request_.names[p]), why);
      if (!added) known->second = std::min(known->second, why);
    }
    measures.push_back(std::move(measured));
  }
  return {};
}

std::optional<std::vector<double>> DesignRuns::measure_in_lane(const ParameterSeeds& seeds) {
  std::unique_ptr<LaneDesigns> lanes;
  {
    const std::lock_guard lock(mutex_);
    if (!try_lanes_) return {};
    if (!idle_lanes_.empty()) {
      lanes = std::move(idle_lanes_.back());
      idle_lanes_.pop_back();
    }
  }
  std::string why_not;
  if (!lanes) lanes = LaneDesigns::make(context_, why_not);
  LaneDesigns::Outcome outcome;
  if (lanes) lanes->measure({&seeds, 1}, {&outcome, 1});
  const std::lock_guard lock(mutex_);
  if (lanes)
    idle_lanes_.push_back(std::move(lanes));
  else
    try_lanes_ = false;
  return std::move(outcome.measures);
}

std::string DesignRuns::measure(const ParameterSeeds& seeds, bool gradients, std::vector<Measured>& measures,
                                AdjointRecord& record) {
  if (const auto values = gradients ? std::nullopt : measure_in_lane(seeds)) {
    for (const double value : *values) measures.push_back({value, std::vector<double>(request_.names.size(), 0.0)});
    return {};
  }
  std::string reason;
  const std::optional<Status> status = run_design(
      context_, seeds, gradients ? &request_ : nullptr, nullptr,
      [&](const AnalysisTask& inner, const AnalysisResult& result) {
        reason = take_measures(inner, result, gradients, measures);
        return reason.empty();
      },
      nullptr, &record);
  if (!status) return "invalid";
  return *status == Status::ok ? reason : std::string(to_string(*status));
}

std::vector<DesignScalar> DesignRuns::evaluate_formula(const DesignFormula& formula,
                                                       const std::vector<std::vector<DesignScalar>>& parameters,
                                                       const std::vector<Measured>& measures) const {
  std::vector<DesignScalar> values;
  for (std::size_t g = 0; g < parameters.size(); ++g) {
    const std::span<const DesignScalar> group = parameters[g];
    const Formula<DesignScalar> bound =
        formula.expression.formula<DesignScalar>(group, {}, context_.models->tables(*context_.task.table, group));
    values.push_back(bound.evaluate([&](std::uint32_t input) {
      const Measured& measured = measures[static_cast<std::size_t>(formula.measures[input])];
      DesignScalar value(measured.value);
      for (std::size_t k = 0; k < parameters_at_once; ++k) {
        const std::size_t p = parameters_at_once * g + k;
        if (p < measured.gradient.size()) value.d[k] = measured.gradient[p];
      }
      return value;
    }));
  }
  return values;
}

DesignEvaluation DesignRuns::evaluate(std::span<const double> x, bool gradients, AdjointRecord& record) {
  DesignEvaluation evaluation;
  const ParameterSeeds seeds = seeds_of(x);
  std::vector<Measured> measures;
  evaluation.failure = measure(seeds, gradients, measures, record);
  if (!evaluation.failure.empty()) return evaluation;
  const auto parameters = context_.models->dual_values(*context_.task.table, seeds, request_.parameters);
  DesignValues& values = evaluation.values;
  bool finite = true;
  const auto take = [&](const std::vector<DesignScalar>& groups, double sign, std::vector<double>& gradient) {
    finite = finite && std::isfinite(groups.front().v);
    for (std::size_t p = 0; gradients && p < x.size(); ++p)
      gradient.push_back(sign * groups[p / parameters_at_once].d[p % parameters_at_once]);
    return sign * groups.front().v;
  };
  values.objective =
      take(evaluate_formula(goal_.objective, parameters, measures), goal_.maximise ? -1 : 1, values.gradient);
  for (const DesignRelation& relation : goal_.relations) {
    std::vector<DesignScalar> left = evaluate_formula(relation.left, parameters, measures);
    const std::vector<DesignScalar> right = evaluate_formula(relation.right, parameters, measures);
    for (std::size_t g = 0; g < left.size(); ++g) left[g] = left[g] - right[g];
    auto& target = relation.equality ? values.equal : values.unequal;
    target.push_back(take(left, 1, relation.equality ? values.equal_gradient : values.unequal_gradient));
  }
  if (!finite) evaluation.failure = "not_finite";
  return evaluation;
}

}  // namespace catena
