// equilibrium: the configuration at rest, certified.
#include <fmt/format.h>

#include <algorithm>

#include "catena/analysis/accuracy/equilibrium_accuracy.hpp"
#include "catena/analysis/adjoint/static_adjoint.hpp"
#include "catena/analysis/contact/contact_points.hpp"
#include "catena/analysis/contact/holding/holding.hpp"
#include "catena/analysis/run/energyless_forces.hpp"
#include "catena/analysis/run/process_time.hpp"
#include "catena/analysis/run/rope_ways_at.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/weightless_bodies.hpp"
#include "catena/analysis/sensitivity/static_derivatives.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/analysis/statics/solvers/static_ipopt.hpp"
#include "catena/analysis/statics/solvers/static_nlopt.hpp"
#include "catena/scene/running/analysis_run.hpp"
#include "catena/scene/running/drawn_shapes.hpp"

namespace catena {
namespace {

/// Whether friction can hold the position that there is.
void run_holding(AnalysisContext& context, AnalysisResult& result) {
  const ProcessTimer timer;
  const std::vector<std::string> names = context.task.output_names();
  RopeWaysAt ways(context.model);
  ways.begin(context.state);
  context.model = ways.model();
  ContactHolding analysis(context.model);
  Evaluator& evaluator = analysis.evaluator();
  const ColumnSources sources{.analysis = context.task.type()};
  const ColumnSet columns = ColumnSet::resolve(evaluator.model(), evaluator.plan(), names, sources);
  SystemState start = context.state;
  start.t = frozen_time(context);
  AnalysisRows rows(columns, context, evaluator.model(), evaluator.plan(), sources, {start.t, start.t});
  rows.begin();
  std::vector<double> q;
  const Holding holding = analysis.find(start, q);
  AnalysisReport report;
  report.status = holding.status;
  report.message = holding.message;
  if (holding.ok()) {
    rows.observe({.evaluator = evaluator, .t = start.t, .q = q});
    SystemState held = state_of(evaluator, start.t, q);
    context.state.q = std::move(held.q);
    context.state.curves = std::move(held.curves);
    context.state.ropes = ways.turns(context.state);
    result.fields = {{"held", holding.held()}};
    if (holding.utilisation) result.fields.push_back({"utilisation", *holding.utilisation});
    if (std::string remark = remark_on_weightless(*context.model, evaluator.plan()); !remark.empty())
      report.warnings.push_back(std::move(remark));
    if (!holding.utilisation) report.warnings.emplace_back("no friction, however large, can hold this position");
  }
  report.counters = evaluator.counters;
  report.seconds = timer.seconds();
  result.report = std::move(report);
  rows.finish(result);
  add_field_measures(context, result);
}

// A rope's way is one way of many: as the energy goes on smoothly from one to the next, that of a place of rest is
// found by solving with the way of the last place until it stays. Ropes beside many pulleys take a pass for each at
// most.
constexpr int most_passes = 50;

/// Gives the context the model whose ropes lie as they do at rest; `start`: becomes that place where they lie
/// otherwise. The report of a search that failed, if so: it need not be made again.
std::optional<EquilibriumReport> find_ways_at_rest(AnalysisContext& context, const EquilibriumOptions& options,
                                                   RopeWaysAt& ways, SystemState& start) {
  std::optional<EquilibriumReport> failed;
  if (!ways.any()) return failed;
  ways.begin(start);
  EquilibriumOptions one = options;
  one.find = 1;
  for (int pass = 0; pass < most_passes; ++pass) {
    Equilibrium trial(ways.model(), plan_options(*ways.model(), context.task.column_names(), start), one);
    trial.start_from(start);
    EquilibriumReport report = trial.solve();
    trial.evaluator().set_configuration(trial.q());
    const bool failed_inside = report.status == Status::not_converged;
    if (failed_inside || !ways.find(trial.evaluator())) {
      if (!report.ok() && options.find == 1) failed = std::move(report);
      break;
    }
    start = trial.state();
  }
  if (context.design && !ways.lie_as_given())
    throw ModelError(
        "derivatives are those of ropes that lie as in the given configuration; here one meets or leaves a "
        "pulley, or is wound further: give the bodies a place nearer to rest");
  context.model = ways.model();
  return failed;
}

bool measures_energy(const AnalysisTask& task) {
  return std::any_of(task.measures.begin(), task.measures.end(), [](const PlacedMeasure& placed) {
    return placed.request.kind == MeasureKind::field && placed.request.field == "energy";
  });
}

EquilibriumOptions equilibrium_options_of(const AnalysisContext& context) {
  const AnalysisTask& task = context.task;
  // In the order of the keys' words.
  constexpr StaticSolver solvers[] = {StaticSolver::automatic, StaticSolver::newton, StaticSolver::ipopt,
                                      StaticSolver::nlopt};
  EquilibriumOptions options;
  options.solver = solvers[task.word("solver")];
  options.verbose = context.verbose;
  options.find = static_cast<int>(task.number("find", 1));
  options.tolerance = task.number("tolerance", options.tolerance);
  options.accept = task.word("accept") == 0 ? Accept::stable : Accept::stationary;
  return options;
}

/// Why these options cannot be met; empty: they can.
std::string trouble_with(const EquilibriumOptions& options, const Model& model) {
  const bool ipopt = options.solver == StaticSolver::ipopt, nlopt = options.solver == StaticSolver::nlopt;
  if ((ipopt && !ipopt_is_built_in()) || (nlopt && !nlopt_is_built_in())) {
    return fmt::format(
        "this catena was built without {} (CATENA_WITH_{}=OFF); leave \"solver\" out, or "
        "take \"newton\"",
        ipopt ? "Ipopt" : "NLopt", ipopt ? "IPOPT" : "NLOPT");
  }
  if (options.find > 1 && !rope_routes(model).empty()) {
    return "\"find\" looks for places of rest with ropes that lie in one way, but a rope over a pulley may "
           "lie otherwise in each: leave \"find\" out and start near the place that is meant";
  }
  return {};
}

/// Why the solver cannot serve this mechanism; empty: it can.
std::string trouble_with_solver(StaticSolver solver, Equilibrium& analysis, const Model& model) {
  const bool ipopt = solver == StaticSolver::ipopt, nlopt = solver == StaticSolver::nlopt;
  if ((ipopt || nlopt) && !analysis.evaluator().conservative()) {
    return fmt::format("the solver {} minimises an energy, but {}; leave \"solver\" out", ipopt ? "ipopt" : "nlopt",
                       forces_without_energy(model));
  }
  if (nlopt && analysis.plan().columns > StaticNloptOptions::most_columns) {
    return fmt::format("the solver nlopt is dense and made for at most {} coordinates; this scene has {}",
                       StaticNloptOptions::most_columns, analysis.plan().columns);
  }
  return {};
}

/// What is found out beside the rows: derivatives and digits, where they are asked for.
struct RowCompanions {
  StaticDerivatives* derivatives = nullptr;
  EquilibriumAccuracy* accuracy = nullptr;
};

RowCompanions accompany(AnalysisContext& context, Equilibrium& analysis, const ColumnSet& columns, AnalysisRows& rows) {
  RowCompanions companions;
  if (context.design) {
    const auto parameters = static_cast<int>(context.design->names.size());
    std::unique_ptr<StaticDerivatives> found;
    if (goes_back(context))
      found = std::make_unique<StaticAdjoint>(analysis.evaluator(), designs_of(context), parameters);
    else
      found = std::make_unique<StaticDerivatives>(analysis.evaluator(), designs_of(context), parameters);
    companions.derivatives = found.get();
    found->ask_whether_neutral([&analysis] { return analysis.is_neutral(); });
    rows.differentiate(std::move(found));
  } else if (context.digits) {
    auto judge = std::make_unique<EquilibriumAccuracy>(analysis, columns);
    companions.accuracy = judge.get();
    rows.judge(std::move(judge));
  }
  return companions;
}

std::vector<NamedField> fields_of(const EquilibriumReport& report, bool one_sided) {
  std::vector<NamedField> fields;
  if (report.certified) {
    if (report.has_energy) fields.push_back({"energy", report.energy});
    fields.push_back({"stable", report.stable});
    fields.push_back({"neutral", report.neutral});
    fields.push_back({"negative_modes", static_cast<std::int64_t>(report.negative_modes)});
    if (report.flutter > 0) fields.push_back({"flutter", static_cast<std::int64_t>(report.flutter)});
    if (report.free_motions > 0) {
      fields.push_back({"free_motions", static_cast<std::int64_t>(report.free_motions)});
      fields.push_back({"moving_freely", report.free_bodies});
    }
  }
  if (report.certified || report.ok()) {
    fields.push_back({"residual", report.residual});
    fields.push_back({"solver", report.solver});
    fields.push_back({"iterations", static_cast<std::int64_t>(report.iterations)});
  }
  if (one_sided && report.ok()) fields.push_back({"active", report.active});
  if (report.found.empty()) return fields;
  std::vector<FieldRecord> list;
  for (const FoundEquilibrium& f : report.found) {
    list.push_back({{"row", static_cast<std::int64_t>(list.size())},
                    {"energy", f.energy},
                    {"stable", f.stable},
                    {"negative_modes", static_cast<std::int64_t>(f.negative_modes)}});
  }
  fields.push_back({"equilibria", std::move(list)});
  return fields;
}

void warn_of_friction(const Model& model, EquilibriumReport& report) {
  const int friction = first_friction(model);
  if (friction < 0) return;
  report.warnings.push_back(fmt::format(
      "dry friction (\"{}\") is left out: the position is that without any; \"friction\": \"hold\" asks whether it "
      "holds the given one",
      model.element_name(friction)));
}

/// Of the measures of the energy.
void differentiate_energy(AnalysisContext& context, Equilibrium& analysis, StaticDerivatives& derivatives,
                          AnalysisResult& result) {
  const Snapshot snapshot{
      .evaluator = analysis.evaluator(), .t = analysis.time(), .q = analysis.q(), .lambda = analysis.lambda()};
  std::string why;
  const std::vector<double> gradient = derivatives.energy_gradient(snapshot, why);
  set_field_gradient(context, result, "energy", 0, gradient, why);
}

}  // namespace

void run_equilibrium(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  if (task.word("friction") == 1) {
    if (context.design) return refuse(result, "what friction can hold has no derivatives yet");
    return run_holding(context, result);
  }
  const EquilibriumOptions options = equilibrium_options_of(context);
  if (std::string trouble = trouble_with(options, *context.model); !trouble.empty())
    return refuse(result, std::move(trouble));
  SystemState start = context.state;
  start.t = frozen_time(context);
  RopeWaysAt ways(context.model);
  const std::optional<EquilibriumReport> failed = find_ways_at_rest(context, options, ways, start);
  Equilibrium analysis(context.model, plan_options(*context.model, task.column_names(), start), options);
  if (std::string trouble = trouble_with_solver(options.solver, analysis, *context.model); !trouble.empty())
    return refuse(result, std::move(trouble));
  const ColumnSources sources{.analysis = task.type(), .multipliers = true};
  const ColumnSet columns = ColumnSet::resolve(*context.model, analysis.plan(), task.output_names(), sources);
  analysis.start_from(start);
  if (context.trace) analysis.evaluator().trace = &context.trace;
  AnalysisRows rows(columns, context, *context.model, analysis.plan(), sources, {start.t, start.t});
  const auto [derivatives, accuracy] = accompany(context, analysis, columns, rows);
  rows.begin();
  Needs needs = rows.needs();
  needs.multipliers = needs.multipliers || derivatives;
  EquilibriumReport report = failed ? *failed : analysis.run(TimeGrid::instant(start.t), needs, rows);
  if (accuracy && (report.neutral || report.free_motions > 0)) accuracy->withhold();
  context.state = analysis.state();
  if (report.ok()) context.state.ropes = ways.turns(context.state);
  warn_of_friction(*context.model, report);
  if (std::string remark = remark_on_weightless(*context.model, analysis.plan()); !remark.empty())
    report.warnings.push_back(std::move(remark));
  for (NamedField& field : fields_of(report, !analysis.plan().gap_rows.empty()))
    result.fields.push_back(std::move(field));
  if (report.ok()) draw_softest_mode(context);
  result.report = report;
  rows.finish(result);
  add_field_measures(context, result);
  if (derivatives && report.certified && report.has_energy && report.ok() && measures_energy(task))
    differentiate_energy(context, analysis, *derivatives, result);
}

}  // namespace catena
