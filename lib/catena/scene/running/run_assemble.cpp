// assemble and check: the assembled configuration of a mechanism, and its mobility there.
#include <fmt/format.h>

#include <algorithm>
#include <functional>

#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/motion/initial_velocities.hpp"
#include "catena/analysis/pose/mobility.hpp"
#include "catena/analysis/run/process_time.hpp"
#include "catena/analysis/run/rope_ways_at.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/sensitivity/assembly_derivatives.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/scene/judging/gap_watch.hpp"
#include "catena/scene/running/analysis_run.hpp"

namespace catena {
namespace {

std::string quoted_names(const Model& model, const std::vector<int>& elements) {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t k = 0; k < elements.size() && k < most; ++k)
    text += (k == 0 ? "\"" : ", \"") + model.element_name(elements[k]) + "\"";
  return elements.size() > most ? text + ", ..." : text;
}

void start(Kinematics& analysis, const AnalysisContext& context) {
  SystemState state = context.state;
  state.t = frozen_time(context);
  analysis.start_from(state);
  if (context.trace) analysis.evaluator().trace = &context.trace;
}

void take_outcome(AnalysisReport& report, const AssemblyOutcome& outcome, Kinematics& analysis) {
  static_cast<Report&>(report) = outcome;
  report.bodies = analysis.plan().bodies;
  report.rows = analysis.plan().rows;
  report.islands = analysis.plan().islands;
}

void add_misfits(AnalysisResult& result, const AssemblyOutcome& outcome, const Model& model) {
  if (outcome.misfits.empty()) return;
  std::vector<FieldRecord> records;
  for (const Misfit& misfit : outcome.misfits) {
    records.push_back({{"element", model.element_name(misfit.element)},
                       {"residual", misfit.size},
                       {"unit", std::string(misfit.angle ? "rad" : "m")}});
  }
  result.fields.push_back({"misfits", std::move(records)});
}

/// Measures of the assembled place, as the rows of assemble have them.
void measure_place(const AnalysisContext& context, Kinematics& analysis, double residual, AnalysisResult& result) {
  const double t = analysis.time();
  MeasureSet measures(context.task.measure_requests(), *context.model, analysis.plan(),
                      {.analysis = context.task.type()}, {t, t});
  if (measures.empty()) return;
  if (result.report.ok()) {
    analysis.evaluator().set_configuration(analysis.q());
    measures.take_row({.evaluator = analysis.evaluator(), .t = t, .q = analysis.q(), .residual = residual}, true);
  }
  for (MeasureResult& measure : measures.results()) {
    if (!measure.trouble.empty())
      result.report.warnings.push_back(fmt::format("measure \"{}\": {}", measure.name, measure.trouble));
    result.measures.push_back(std::move(measure));
  }
}

/// Checks the changes that a start of dynamics would make to the given velocities.
void check_velocities(Kinematics& analysis, const Model& model, AnalysisReport& report) {
  const bool given = std::any_of(model.bodies.begin(), model.bodies.end(),
                                 [](const auto& body) { return body.velocity_given || body.angular_velocity_given; });
  if (!given) return;
  EquationsOfMotion equations(analysis.evaluator());
  if (!equations.use_masses().ok()) return;
  equations.weigh_massless(analysis.q());
  std::vector<double> qd(analysis.q().size());
  const VelocityOutcome outcome = find_initial_velocities(equations, analysis.q(), {}, qd);
  if (!outcome.ok()) {
    report.warnings.push_back("initial velocities: " + outcome.message);
  } else if (outcome.changed_part > thresholds::contradiction) {
    report.warnings.push_back(
        fmt::format("the given velocities do not meet the constraints: dynamics changes them by up to {:.3g} {} "
                    "(body \"{}\")",
                    outcome.changed, outcome.changed_turn ? "rad/s" : "m/s", model.body_name(outcome.changed_body)));
  }
}

/// Ropes lie as they can at the place that was assembled.
void lay_ropes(const AnalysisContext& context, RopeWaysAt& ways, Kinematics& analysis) {
  if (!ways.any()) return;
  if (ways.find(analysis.evaluator())) {
    analysis.evaluator().set_model(*ways.model());
    analysis.evaluator().set_configuration(analysis.q());
  }
  if (context.design && !ways.lie_as_given())
    throw ModelError(
        "derivatives are those of ropes that lie as in the given configuration; here one meets or leaves a pulley, or "
        "is wound further: give the bodies a place nearer to it");
}

}  // namespace

void run_assemble(AnalysisContext& context, AnalysisResult& result) {
  const ProcessTimer timer;
  const std::vector<std::string> names = context.task.output_names();
  RopeWaysAt ways(context.model);
  if (!context.state.q.empty() && ways.begin(context.state)) context.model = ways.model();
  Kinematics analysis(context.model, plan_without_gaps(*context.model, context.task.column_names(), context.state));
  const ColumnSources sources{.analysis = context.task.type()};
  const ColumnSet columns = ColumnSet::resolve(*context.model, analysis.plan(), names, sources);
  start(analysis, context);
  AnalysisRows rows(columns, context, *context.model, analysis.plan(), sources, {context.state.t, context.state.t});
  if (context.design) {
    rows.differentiate(std::make_unique<AssemblyDerivatives>(analysis.evaluator(), designs_of(context),
                                                             static_cast<int>(context.design->names.size()),
                                                             context.state.q.empty()));
  }
  rows.begin();
  const AssemblyOutcome outcome = analysis.assemble();
  AnalysisReport report;
  take_outcome(report, outcome, analysis);
  // In metres, as the column: angles count times the length scale, unless there is nothing else.
  const std::vector<char>& angles = analysis.plan().row_is_angle;
  const bool only_angles = !angles.empty() && std::all_of(angles.begin(), angles.end(), std::identity());
  const double scale = analysis.evaluator().length_scale();
  if (outcome.ok()) {
    analysis.evaluator().set_configuration(analysis.q());
    lay_ropes(context, ways, analysis);
    rows.observe({.evaluator = analysis.evaluator(),
                  .t = analysis.time(),
                  .q = analysis.q(),
                  .residual = outcome.residual * scale});
    // Places alone change hands: the velocities and the time stay those of the motion so far.
    SystemState found = analysis.state();
    context.state.q = std::move(found.q);
    context.state.curves = std::move(found.curves);
    context.state.ropes = ways.turns(context.state);
    for (std::string& doubt : violated_gaps(analysis.evaluator())) report.warnings.push_back(std::move(doubt));
  }
  report.counters = analysis.evaluator().counters;
  report.seconds = timer.seconds();
  result.report = std::move(report);
  rows.finish(result);
  result.fields = {{"residual", outcome.residual * (only_angles ? 1 : scale)},
                   {"moved", outcome.moved},
                   {"iterations", std::int64_t{outcome.iterations}}};
  add_misfits(result, outcome, *context.model);
  add_field_measures(context, result);
}

void run_check(AnalysisContext& context, AnalysisResult& result) {
  if (context.design)
    return refuse(result, "check has no derivatives: take assemble, whose columns and measures have them");
  const ProcessTimer timer;
  const Model& model = *context.model;
  // Every equation counts here, those of welded bodies too.
  PlanOptions options = plan_without_gaps(model, {}, context.state);
  options.keep_elements.clear();
  for (int e = 0; e < static_cast<int>(model.elements.size()); ++e) options.keep_elements.push_back(e);
  Kinematics analysis(context.model, options);
  start(analysis, context);
  const AssemblyOutcome outcome = analysis.assemble();
  AnalysisReport report;
  take_outcome(report, outcome, analysis);
  if (context.poses && outcome.ok()) {
    analysis.evaluator().set_configuration(analysis.q());
    context.poses->pose({.evaluator = analysis.evaluator(), .t = analysis.time(), .q = analysis.q()});
  }
  const MobilityReport mobility = analyse_mobility(analysis.evaluator(), analysis.q());
  report.rank = mobility.rank;
  report.dof = mobility.dof();
  report.mobility = mobility.mobility();
  for (const int element : mobility.redundant_elements) report.redundant.push_back(model.element_name(element));
  report.warnings.insert(report.warnings.end(), mobility.warnings.begin(), mobility.warnings.end());
  for (std::size_t k = 0; k < mobility.redundant_elements.size() && k < 10; ++k) {
    if (mobility.dependent_on[k].empty()) continue;
    const std::vector<int>& wrong = mobility.contradictory_elements;
    const bool agrees = std::find(wrong.begin(), wrong.end(), mobility.redundant_elements[k]) == wrong.end();
    report.warnings.push_back(fmt::format("\"{}\" {} {}{}", model.element_name(mobility.redundant_elements[k]),
                                          agrees ? "repeats what follows from" : "contradicts",
                                          quoted_names(model, mobility.dependent_on[k]),
                                          agrees ? "" : ": the places fit, the velocities do not"));
  }
  std::optional<FreeMotions> free;
  if (outcome.ok() && mobility.dof() > 0) free = find_free_motions(context.model, analysis.state());
  const bool any_free = free && free->count > 0;
  if (outcome.ok()) {
    for (std::string& doubt : violated_gaps(analysis.evaluator())) report.warnings.push_back(std::move(doubt));
    check_velocities(analysis, model, report);
    for (std::string& doubt : gears_that_do_not_fit(analysis.evaluator())) report.warnings.push_back(std::move(doubt));
    for (std::string& doubt : ropes_in_loops(*context.model)) report.warnings.push_back(std::move(doubt));
    for (std::string& doubt : keys_without_effect(*context.model)) report.warnings.push_back(std::move(doubt));
  }
  report.counters = analysis.evaluator().counters;
  report.seconds = timer.seconds();
  result.report = std::move(report);
  if (!mobility.free_bodies.empty()) result.fields.push_back({"free_bodies", mobility.free_bodies});
  if (any_free) {
    result.fields.push_back({"free_motions", std::int64_t{free->count}});
    result.fields.push_back({"moving_freely", free->bodies});
  }
  add_misfits(result, outcome, model);
  measure_place(context, analysis, outcome.residual * analysis.evaluator().length_scale(), result);
  add_field_measures(context, result);
}

}  // namespace catena
