// kinematics and inverse_dynamics: a driven mechanism over time.
#include "catena/analysis/kinematics/kinematic_look.hpp"
#include "catena/analysis/kinematics/minimum_norm_motion.hpp"
#include "catena/analysis/sensitivity/kinematic_derivatives.hpp"
#include "catena/scene/running/analysis_run.hpp"

namespace catena {
namespace {

/// The branches in words; where none goes on, that.
std::vector<std::string> branches_of(const SingularPoint& point) {
  if (!point.branches.empty()) return point.branches;
  if (point.kind == SingularPoint::Kind::lock_up) return {"none goes on beyond the dead point"};
  return {point.kind == SingularPoint::Kind::isolated ? "none goes on" : "not known"};
}

/// "singular": one object a singular configuration met.
void add_singular_points(AnalysisResult& result, const std::vector<SingularPoint>& points, const Model& model) {
  if (points.empty()) return;
  std::vector<FieldRecord> records;
  for (const SingularPoint& point : points) {
    FieldRecord record{{"t", point.t},
                       {"kind", std::string(point.kind_name())},
                       {"nullity", std::int64_t{point.nullity}},
                       {"bodies", point.bodies},
                       {"branches", branches_of(point)}};
    if (point.driver >= 0) {
      record.emplace_back("driver", model.element_name(point.driver));
      record.emplace_back("value", point.driver_value);
    }
    records.push_back(std::move(record));
  }
  result.fields.push_back({"singular", std::move(records)});
}

/// One-sided elements do not take part: they are watched.
PlanOptions plan_without_gaps(const Model& model, const std::vector<std::string>& outputs) {
  PlanOptions options = plan_options(model, outputs);
  options.released_elements = model.gaps();
  return options;
}

/// Whether constraints and drivers determine the motion where the analysis starts.
bool is_driven(const AnalysisContext& context) {
  Kinematics analysis(context.model, plan_without_gaps(*context.model, {}));
  analysis.start_from(context.state);
  RowFunction nothing([](const Snapshot&) { return true; });
  return analysis.run(TimeGrid::instant(context.state.t), {}, nothing).status != Status::under_driven;
}

void run(AnalysisContext& context, AnalysisResult& result, bool inverse_dynamics) {
  const AnalysisTask& task = context.task;
  const std::optional<TimeGrid> grid = time_grid(context, result.report);
  if (!grid) return;
  const std::vector<std::string> names = task.output_names();
  const PlanOptions plan = plan_without_gaps(*context.model, task.column_names());
  KinematicsOptions options;
  options.inverse_dynamics = inverse_dynamics;
  if (task.has("branch")) {
    options.branch = static_cast<int>(task.number("branch", 0));
    if (options.branch < 1) return refuse(result, "branches are numbered from 1");
  }
  const ColumnSources sources{.analysis = task.type(),
                              .timed = true,
                              .velocity = true,
                              .acceleration = true,
                              .multipliers = inverse_dynamics,
                              .work = inverse_dynamics};
  if (task.word("free") != 0 && !is_driven(context)) {
    if (inverse_dynamics) {
      return refuse(result,
                    "\"minimum_norm\" is for kinematics alone: motions that nothing drives would need forces of their "
                    "own; add drivers");
    }
    if (context.design)
      return refuse(result, "motions that nothing drives have no derivatives yet: leave \"free\" out, or add drivers");
    MinimumNormMotion analysis(context.model, plan);
    run_over_time(context, result, analysis, *grid, names, sources, [](AnalysisRows& rows) { rows.take_rows_alone(); });
    return add_singular_points(result, analysis.singular_points(), *context.model);
  }
  Kinematics analysis(context.model, plan, options);
  std::optional<KinematicLook> look;
  const auto prepare = [&](AnalysisRows& rows) {
    if (!task.measures.empty()) {
      look.emplace(context.model, plan, options, rows.needs());
      rows.look_by([&](const Snapshot& snapshot) {
        look->start_from(snapshot);
        return AnalysisRows::Look([&](double t) { return look->at(t); });
      });
    }
    if (!context.design) return;
    rows.differentiate(std::make_unique<KinematicDerivatives>(analysis.evaluator(), designs_of(context),
                                                              static_cast<int>(context.design->names.size())));
  };
  run_over_time(context, result, analysis, *grid, names, sources, prepare);
  add_singular_points(result, analysis.singular_points(), *context.model);
}

}  // namespace

void run_kinematics(AnalysisContext& context, AnalysisResult& result) { run(context, result, false); }
void run_inverse_dynamics(AnalysisContext& context, AnalysisResult& result) { run(context, result, true); }

}  // namespace catena
