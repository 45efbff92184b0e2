// kinematics and inverse_dynamics: a driven mechanism over time.
#include "catena/analysis/kinematics.hpp"
#include "catena/scene/analysis_run.hpp"

namespace catena {
namespace {

/// "singular": [{"t", "kind", "nullity", "bodies", "branches"}], one object a singular configuration met.
void add_singular_points(AnalysisResult& result, const std::vector<SingularPoint>& points) {
  if (points.empty()) return;
  std::vector<FieldRecord> records;
  for (const SingularPoint& point : points) {
    std::string bodies;
    for (const std::string& body : point.bodies) bodies += (bodies.empty() ? "" : ", ") + body;
    records.push_back({{"t", point.t},
                       {"kind", std::string(point.kind_name())},
                       {"nullity", std::int64_t{point.nullity}},
                       {"bodies", bodies},
                       {"branches", point.describe_branches()}});
  }
  result.fields.push_back({"singular", std::move(records)});
}

void run(AnalysisContext& context, AnalysisResult& result, bool inverse_dynamics) {
  const AnalysisTask& task = context.task;
  if (task.word("free") != 0) return refuse(result, "\"free\": \"minimum_norm\" is not built yet; add drivers instead");
  const std::optional<TimeGrid> grid = time_grid(context, result.report);
  if (!grid) return;
  const std::vector<std::string> names = task.output_names();
  KinematicsOptions options;
  options.inverse_dynamics = inverse_dynamics;
  if (task.has("branch")) {
    options.branch = static_cast<int>(task.number("branch", 0));
    if (options.branch < 1) return refuse(result, "branches are numbered from 1");
  }
  Kinematics analysis(context.model, plan_options(*context.model, names), options);
  run_over_time(context, result, analysis, *grid, names,
                {.analysis = task.type(),
                 .timed = true,
                 .velocity = true,
                 .acceleration = true,
                 .multipliers = inverse_dynamics});
  add_singular_points(result, analysis.singular_points());
}

}  // namespace

void run_kinematics(AnalysisContext& context, AnalysisResult& result) { run(context, result, false); }
void run_inverse_dynamics(AnalysisContext& context, AnalysisResult& result) { run(context, result, true); }

}  // namespace catena
