#include "catena/scene/designing/measured_design.hpp"

#include <algorithm>
#include <limits>

namespace catena {
namespace {

/// Rows of analyses inside of an optimisation or a sweep: nobody wants them.
class NoRows final : public RowSink {
 public:
  void begin(std::span<const ColumnInfo>) override {}
  bool row(std::span<const double>) override { return true; }
};

}  // namespace

std::optional<Status> run_design(const AnalysisContext& context, ParameterSeeds seeds, const DesignRequest* design,
                                 DesignSink* watch, const TakeAnalysis& take) {
  SystemState state = context.state;
  const ParameterSeeds given = seeds;
  NoRows nobody;
  for (const AnalysisTask& read : context.task.of) {
    AnalysisTask inner = read;
    if (inner.from_initial) {
      state = {};
      seeds = given;
    }
    inner.parameters = context.models->values(*read.table, seeds);
    std::shared_ptr<const Model> model = context.models->model(*inner.table, seeds);
    if (!model) return std::nullopt;
    AnalysisContext within{.task = inner,
                           .model = std::move(model),
                           .state = state,
                           .rows = watch ? watch->begin_analysis(inner.type()) : nobody,
                           .cancel = context.cancel,
                           .progress = {},
                           .models = context.models,
                           .seeds = seeds,
                           .design = design,
                           .poses = watch ? &watch->poses() : nullptr};
    if (watch) watch->poses().begin_poses(within.model);
    if (inner.has("parameter"))
      within.parameter_name = context.models->names().all()[static_cast<std::size_t>(inner.word("parameter"))];
    AnalysisResult result;
    result.type = inner.type();
    try {
      analysis_function(inner.type())(within, result);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception& error) {
      refuse(result, error.what());
    }
    if (watch) watch->end_analysis(result);
    if (!result.report.ok()) return result.report.status;
    if (!take(inner, result)) break;
    // What an analysis leaves behind, as the last value of a path's parameter, holds for those after it.
    for (const ParameterSeed<double>& value : within.values_at_end) {
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
                      std::vector<double>& measures) {
  bool measured = true;
  const auto take = [&](const AnalysisTask& inner, const AnalysisResult& result) {
    for (const PlacedMeasure& placed : inner.measures) {
      const MeasureResult* found = value_of(placed, result);
      measures.push_back(found ? *found->value : std::numeric_limits<double>::quiet_NaN());
      measured = measured && found;
    }
    return true;
  };
  const Status status = run_design(context, seeds, nullptr, watch, take).value_or(Status::refused);
  return status == Status::ok && !measured ? Status::not_converged : status;
}

void show_design(const AnalysisContext& context, const ParameterSeeds& seeds, DesignLabel label,
                 std::unique_ptr<DesignSink> watch) {
  const auto all = [](const AnalysisTask&, const AnalysisResult&) { return true; };
  static_cast<void>(run_design(context, seeds, nullptr, watch.get(), all));  // its analyses say how they ended
  context.poses->add_design(std::move(label), std::move(watch));
}

}  // namespace catena
