#include "catena/scene/designing/measured_design.hpp"

#include <algorithm>
#include <limits>

#include "catena/scene/designing/missing_derivatives.hpp"
#include "catena/scene/designing/no_rows.hpp"

namespace catena {
namespace {

/// The reason of a measure that has none.
std::string why_without_value(const PlacedMeasure& measure, const AnalysisResult& result) {
  const auto found = std::find_if(result.measures.begin(), result.measures.end(),
                                  [&](const MeasureResult& m) { return m.name == measure.request.name; });
  const std::string trouble = found != result.measures.end() ? found->trouble : std::string();
  return "measure \"" + measure.request.name + "\" has no value" + (trouble.empty() ? "" : ": " + trouble);
}

/// One run; why gradients by adjoints do not exist, or are not found, empty where they are or were not asked for.
std::string run_once(const AnalysisContext& outer, const AnalysisTask& task, std::shared_ptr<const Model> model,
                     InnerRun& run, AnalysisResult& result) {
  AnalysisContext context{.task = task,
                          .model = std::move(model),
                          .state = run.state,
                          .rows = run.rows,
                          .cancel = outer.cancel,
                          .progress = {},
                          .models = outer.models,
                          .seeds = run.seeds,
                          .design = run.design,
                          .poses = run.poses};
  if (context.poses) context.poses->begin_poses(context.model);
  if (run.is_shown) {
    context.progress = outer.progress;
    context.verbose = outer.verbose;
    context.trace = outer.trace;
  }
  if (task.has("parameter"))
    context.parameter_name = outer.models->names().all()[static_cast<std::size_t>(task.word("parameter"))];
  try {
    run_analysis(context, result);
  } catch (const std::bad_alloc&) {
    throw;
  } catch (const std::exception& error) {
    refuse(result, error.what());
  }
  run.values_at_end = std::move(context.values_at_end);
  run.went_back = context.goes_back;
  return context.goes_back ? std::move(context.no_adjoint) : std::move(context.forward_because);
}

}  // namespace

bool run_inner(const AnalysisContext& outer, const AnalysisTask& inner, InnerRun& run, AnalysisResult& result) {
  AnalysisTask task = inner;
  if (std::optional<std::string> why = outer.models->set_parameters(task, run.seeds)) {
    refuse(result, std::move(*why));
    return false;
  }
  std::string no_model;
  const std::shared_ptr<const Model> model = outer.models->model(*task.table, run.seeds, &no_model);
  if (!model) {
    refuse(result, std::move(no_model));
    return false;
  }
  const SystemState start = run.state;
  std::string forward_because = run_once(outer, task, model, run, result);
  if (run.went_back && !forward_because.empty()) {
    DesignRequest forward = *run.design;
    forward.mode = GradientMode::forward;
    NoRows no_rows;
    run.state = start;
    InnerRun again{.seeds = run.seeds, .state = run.state, .rows = no_rows, .design = &forward};
    AnalysisResult anew;
    anew.type = result.type;
    result = std::move(anew);
    static_cast<void>(run_once(outer, task, model, again, result));
    run.values_at_end = std::move(again.values_at_end);
    run.went_back = false;
    run.adjoint_failed = true;
  }
  if (run.design && run.design->mode == GradientMode::adjoint && !forward_because.empty())
    result.report.warnings.push_back("derivatives: carried forward, not by the adjoint: " + forward_because);
  return true;
}

std::optional<Status> run_design(const AnalysisContext& context, ParameterSeeds seeds, const DesignRequest* design,
                                 DesignSink* watch, const TakeAnalysis& take, std::string* why, AdjointRecord* record) {
  SystemState state = context.state;
  const ParameterSeeds given = seeds;
  NoRows no_rows;
  std::optional<MissingDerivatives> missing;
  if (design) missing.emplace(*context.models, *design);
  std::optional<DesignRequest> forward;
  if (record) record->resize(context.task.of.size());
  for (std::size_t k = 0; k < context.task.of.size(); ++k) {
    const AnalysisTask& inner = context.task.of[k];
    if (design && record && (*record)[k] < 0 && !forward) {
      forward = *design;
      forward->mode = GradientMode::forward;
    }
    if (inner.from_initial) {
      state = {};
      seeds = given;
      if (missing) missing->start_anew();
    }
    AnalysisResult result;
    result.type = inner.type();
    InnerRun run{.seeds = seeds,
                 .state = state,
                 .rows = watch ? watch->begin_analysis(inner.type()) : no_rows,
                 .design = design && record && (*record)[k] < 0 ? &*forward : design,
                 .poses = watch ? &watch->poses() : nullptr};
    const bool possible = run_inner(context, inner, run, result);
    if (record) (*record)[k] += static_cast<int>(run.went_back) - static_cast<int>(run.adjoint_failed);
    if (watch) watch->end_analysis(result);
    if (why && !result.report.ok()) *why = result.report.message;
    if (!possible) return std::nullopt;
    if (!result.report.ok()) return result.report.status;
    if (missing) missing->complete(inner, seeds, result);
    if (!take(inner, result)) break;
    if (missing) missing->go_on_from(inner, seeds, run.values_at_end);
    // What an analysis leaves behind, as the last value of a path's parameter, holds for those after it.
    for (const ParameterSeed<double>& value : run.values_at_end) {
      std::erase_if(seeds, [&](const auto& seed) { return seed.index == value.index; });
      seeds.push_back(value);
    }
  }
  return Status::ok;
}

const MeasureResult* value_of(const PlacedMeasure& measure, const AnalysisResult& result) {
  const auto found = std::find_if(result.measures.begin(), result.measures.end(),
                                  [&](const MeasureResult& m) { return m.name == measure.request.name; });
  return found != result.measures.end() && found->value ? &*found : nullptr;
}

Status measure_design(const AnalysisContext& context, const ParameterSeeds& seeds, DesignSink* watch,
                      std::vector<double>& measures, std::string& why) {
  bool measured = true;
  const auto take = [&](const AnalysisTask& inner, const AnalysisResult& result) {
    for (const PlacedMeasure& placed : inner.measures) {
      const MeasureResult* found = value_of(placed, result);
      measures.push_back(found ? *found->value : std::numeric_limits<double>::quiet_NaN());
      if (measured && !found) why = why_without_value(placed, result);
      measured = measured && found;
    }
    return true;
  };
  std::string failure;
  const Status status = run_design(context, seeds, nullptr, watch, take, &failure).value_or(Status::refused);
  if (status != Status::ok) why = std::move(failure);
  return status == Status::ok && !measured ? Status::not_converged : status;
}

void show_design(const AnalysisContext& context, const ParameterSeeds& seeds, DesignLabel label,
                 std::unique_ptr<DesignSink> watch) {
  const auto all = [](const AnalysisTask&, const AnalysisResult&) { return true; };
  static_cast<void>(run_design(context, seeds, nullptr, watch.get(), all));  // its analyses say how they ended
  context.poses->add_design(std::move(label), std::move(watch));
}

}  // namespace catena
