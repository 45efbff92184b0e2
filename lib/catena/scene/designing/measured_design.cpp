#include "catena/scene/designing/measured_design.hpp"

#include <algorithm>
#include <limits>

namespace catena {
namespace {

/// Rows of analyses inside of a sweep: nobody wants them.
class NoRows final : public RowSink {
 public:
  void begin(std::span<const ColumnInfo>) override {}
  bool row(std::span<const double>) override { return true; }
};

}  // namespace

Status measure_design(const AnalysisContext& context, const ParameterSeeds& seeds, std::vector<double>& measures) {
  SystemState state = context.state;
  NoRows rows;
  bool measured = true;
  for (const AnalysisTask& read : context.task.of) {
    AnalysisTask inner = read;
    inner.parameters = context.models->values(*read.table, seeds);
    if (inner.from_initial) state = {};
    AnalysisContext within{.task = inner,
                           .model = context.models->model(*inner.table, seeds),
                           .state = state,
                           .rows = rows,
                           .cancel = context.cancel,
                           .progress = {},
                           .models = context.models,
                           .seeds = seeds};
    if (!within.model) return Status::refused;
    if (inner.has("parameter"))
      within.parameter_name = context.models->names().all()[static_cast<std::size_t>(inner.word("parameter"))];
    AnalysisResult result;
    try {
      analysis_function(inner.type())(within, result);
    } catch (const std::bad_alloc&) {
      throw;
    } catch (const std::exception&) {
      return Status::refused;
    }
    if (!result.report.ok()) return result.report.status;
    for (const PlacedMeasure& placed : inner.measures) {
      const auto found = std::find_if(result.measures.begin(), result.measures.end(),
                                      [&](const MeasureResult& m) { return m.name == placed.request.name; });
      const bool has = found != result.measures.end() && found->value.has_value();
      measures.push_back(has ? *found->value : std::numeric_limits<double>::quiet_NaN());
      measured = measured && has;
    }
  }
  return measured ? Status::ok : Status::not_converged;
}

}  // namespace catena
