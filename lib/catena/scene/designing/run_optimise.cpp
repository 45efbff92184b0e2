// optimise: parameters that make an objective least under constraints; one row a design that is better than all before.
#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <memory>

#include "catena/scene/designing/design_runs.hpp"
#include "catena/scene/designing/measured_design.hpp"

namespace catena {
namespace {

// In the order of the key's words after auto, slsqp, mma, ipopt.
constexpr MinimiserMethod methods[] = {MinimiserMethod::slsqp, MinimiserMethod::slsqp,  MinimiserMethod::mma,
                                       MinimiserMethod::ipopt, MinimiserMethod::bobyqa, MinimiserMethod::cobyla,
                                       MinimiserMethod::crs2,  MinimiserMethod::isres,  MinimiserMethod::direct};
constexpr std::string_view names[] = {"slsqp", "mma", "ipopt", "bobyqa", "cobyla", "crs2", "isres", "direct"};

DesignOptions options_of(const AnalysisContext& context) {
  const AnalysisTask& task = context.task;
  DesignOptions options;
  options.method = methods[task.word("solver")];
  options.starts = static_cast<int>(task.number("starts", 1));
  options.threads = context.threads;
  options.seed = static_cast<std::uint64_t>(task.number("seed", 1));
  options.tolerance = task.number("tolerance", options.tolerance);
  options.max_evaluations = static_cast<int>(task.number("max_evaluations", options.max_evaluations));
  options.go_on = [&context] { return !(context.cancel && context.cancel->load(std::memory_order_relaxed)); };
  return options;
}

/// Values of relations in the order of the scene: left less right.
std::vector<double> relation_values(const DesignGoal& goal, const DesignValues& values) {
  std::vector<double> all;
  std::size_t unequal = 0, equal = 0;
  for (const DesignRelation& relation : goal.relations)
    all.push_back(relation.equality ? values.equal[equal++] : values.unequal[unequal++]);
  return all;
}

/// The relations and bounds that hold the design, by name.
std::vector<std::string> active_limits(const DesignGoal& goal, const DesignOutcome& outcome,
                                       const std::vector<std::string>& variables) {
  std::vector<std::string> active;
  int unequal = 0;
  for (const DesignRelation& relation : goal.relations) {
    const auto& held = outcome.active_unequal;
    if (relation.equality || std::find(held.begin(), held.end(), unequal) != held.end())
      active.push_back(relation.text);
    if (!relation.equality) ++unequal;
  }
  for (const int v : outcome.at_lower) active.push_back(variables[static_cast<std::size_t>(v)] + " >= min");
  for (const int v : outcome.at_upper) active.push_back(variables[static_cast<std::size_t>(v)] + " <= max");
  return active;
}

/// What an end without an optimum means, and what may help.
std::string describe_end(const DesignOutcome& outcome, int max_evaluations) {
  switch (outcome.end) {
    case DesignEnd::converged:
      break;
    case DesignEnd::slow:
      return fmt::format("{} designs did not lead to an optimum (max_evaluations = {}); the best so far is given",
                         outcome.evaluations, max_evaluations);
    case DesignEnd::broken_off:
      return fmt::format(
          "the method gave up after {} designs without an optimum; the best so far is given; likely cause: kinks or "
          "noise in measures; another \"solver\", such as \"bobyqa\", may go on",
          outcome.evaluations);
    case DesignEnd::not_stationary:
      return fmt::format(
          "the method counts itself done after {} designs, but its best one is not stationary: its optimality is "
          "{:.3g}, and a short step against the gradient leads to a better design; likely cause: a valley too flat or "
          "too narrow for the method; a smaller \"tolerance\", another \"solver\" or \"start\" may go on",
          outcome.evaluations, outcome.optimality.value_or(std::numeric_limits<double>::quiet_NaN()));
    case DesignEnd::cancelled:
      return "stopped; the best design so far is given";
    case DesignEnd::infeasible:
      return fmt::format(
          "the constraints cannot be met: the least infeasible design misses them by {:.3g} of their size; likely "
          "cause: relations that exclude each other within the bounds",
          outcome.violation);
    case DesignEnd::failed: {
      std::string text = "no design could be analysed, neither the start nor others within the bounds:";
      for (const auto& [reason, count] : outcome.failed) text += fmt::format(" {} ({})", reason, count);
      return text;
    }
  }
  return {};
}

Status status_of(DesignEnd end) {
  switch (end) {
    case DesignEnd::converged:
      return Status::ok;
    case DesignEnd::cancelled:
      return Status::cancelled;
    case DesignEnd::infeasible:
      return Status::infeasible;
    default:
      return Status::not_converged;
  }
}

/// Whether no design had the derivatives that the method searches by; `doubts`: those that were missing.
bool lacks_derivatives(const DesignOutcome& outcome, const std::vector<std::string>& doubts) {
  return outcome.end == DesignEnd::failed && outcome.failed.contains("no_derivative") && !doubts.empty();
}

/// One search, whose designs are analysed by `runs`.
DesignOutcome search(DesignProblem& problem, DesignRuns& runs, const DesignOptions& options) {
  problem.begin_search = [&runs] {
    return [&runs, record = AdjointRecord()](std::span<const double> x, bool gradients) mutable {
      return runs.evaluate(x, gradients, record);
    };
  };
  return optimise_design(problem, options);
}

/// `doubts`: derivatives that were missing.
Report report_of(const DesignOutcome& outcome, int max_evaluations, const std::vector<std::string>& doubts) {
  Report report;
  if (lacks_derivatives(outcome, doubts)) {
    report.status = Status::refused;
    report.message = doubts.front() +
                     "; the solver searches by derivatives: take \"solver\": \"bobyqa\", which needs none, or measure "
                     "something else";
    return report;
  }
  report.status = status_of(outcome.end);
  report.message = describe_end(outcome, max_evaluations);
  if (outcome.is_constant) {
    report.warnings.push_back(fmt::format(
        "the objective is {:.9g} in all designs that could be analysed: no variable changes it; likely cause: measures "
        "that do not depend on the variables",
        outcome.values.objective));
  }
  if (outcome.end == DesignEnd::converged && outcome.at_kink) {
    report.warnings.push_back(fmt::format(
        "the design found is not stationary to first order (optimality {:.3g}), though short steps against its "
        "gradient lead to no better one: a kink of the objective or of a constraint holds it there, or a limit that "
        "the gradient does not see; check its neighbours, by a \"sweep\"",
        *outcome.optimality));
  }
  return report;
}

/// What came of it, as fields of the result.
void add_fields(AnalysisResult& result, const DesignGoal& goal, const DesignOutcome& outcome,
                const std::vector<std::string>& variables, MinimiserMethod method) {
  FieldRecord values, constraints, failed;
  for (std::size_t v = 0; v < outcome.x.size(); ++v) values.emplace_back(variables[v], outcome.x[v]);
  for (const auto& [reason, count] : outcome.failed) failed.emplace_back(reason, std::int64_t{count});
  if (!outcome.x.empty()) {
    const std::vector<double> relations = relation_values(goal, outcome.values);
    for (std::size_t k = 0; k < relations.size(); ++k) constraints.emplace_back(goal.relations[k].text, relations[k]);
    result.fields.push_back({"variables", std::move(values)});
    result.fields.push_back({"objective", goal.maximise ? -outcome.values.objective : outcome.values.objective});
    result.fields.push_back({"constraints", std::move(constraints)});
    result.fields.push_back({"active", active_limits(goal, outcome, variables)});
    result.fields.push_back({"optimality", outcome.optimality.value_or(std::numeric_limits<double>::quiet_NaN())});
    if (!outcome.optimality && outcome.end != DesignEnd::cancelled)
      result.report.warnings.push_back("optimality is not known: some derivative is missing at the design found");
  }
  result.fields.push_back({"evaluations", std::int64_t{outcome.evaluations}});
  result.fields.push_back({"failed", std::move(failed)});
  result.fields.push_back({"solver", std::string(names[static_cast<std::size_t>(method)])});
}

/// Runs the analyses of the start and of the design found once more, for the pose sink.
void show_designs(const AnalysisContext& context, const DesignRuns& runs, const std::vector<double>& start,
                  const std::vector<double>& found, std::int64_t rows) {
  if (!context.poses || found.empty()) return;
  constexpr std::int64_t both = 2;
  const auto show = [&](std::string name, std::int64_t number, std::int64_t row, std::span<const double> x) {
    auto watch = context.poses->watch_design(number, both);
    if (!watch) return;
    DesignLabel label{.name = std::move(name), .row = row, .values = {}};
    for (std::size_t v = 0; v < x.size(); ++v) {
      const auto parameter = static_cast<std::size_t>(context.task.goal.variables[v].parameter);
      label.values.emplace_back(context.models->names().all()[parameter], x[v]);
    }
    show_design(context, runs.seeds_of(x), std::move(label), std::move(watch));
  };
  show("start", 0, -1, start);
  show("best", 1, rows - 1, found);
}

}  // namespace

void run_optimise(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  if (const MinimiserMethod method = methods[task.word("solver")]; !minimiser_is_built_in(method)) {
    const bool ipopt = method == MinimiserMethod::ipopt;
    return refuse(
        result,
        fmt::format("this catena was built without {0} (CATENA_WITH_{1}=OFF), which has the solver "
                    "\"{2}\"; {3}",
                    ipopt ? "Ipopt" : "NLopt", ipopt ? "IPOPT" : "NLOPT", names[static_cast<std::size_t>(method)],
                    ipopt ? "leave \"solver\" out, or take \"slsqp\" or \"mma\"" : "\"ipopt\" may be built in"));
  }
  std::vector<std::string> variables;
  std::vector<ColumnInfo> info;
  DesignProblem problem;
  for (const DesignVariable& variable : task.goal.variables) {
    variables.push_back(context.models->names().all()[static_cast<std::size_t>(variable.parameter)]);
    info.push_back({variables.back(), UnitKind::own});
    problem.lower.push_back(variable.least);
    problem.upper.push_back(variable.greatest);
    problem.start.push_back(variable.start);
  }
  info.push_back({"objective", UnitKind::own});
  for (const DesignRelation& relation : task.goal.relations) {
    info.push_back({relation.text, UnitKind::own});
    (relation.equality ? problem.equations : problem.inequalities) += 1;
  }
  context.rows.begin(info);
  DesignOptions options = options_of(context);
  std::int64_t rows = 0;
  options.improved = [&](std::span<const double> x, const DesignValues& values) {
    std::vector<double> row(x.begin(), x.end());
    row.push_back(task.goal.maximise ? -values.objective : values.objective);
    for (const double value : relation_values(task.goal, values)) row.push_back(value);
    context.rows.row(row);
    ++rows;
  };
  auto runs = std::make_unique<DesignRuns>(context, !uses_gradients(options.method));
  DesignOutcome outcome = search(problem, *runs, options);
  const std::vector<std::string> doubts = runs->doubts();
  const bool is_automatic = task.word("solver") == 0;
  if (is_automatic && lacks_derivatives(outcome, doubts) && outcome.evaluations < options.max_evaluations) {
    options.method = task.goal.relations.empty() ? MinimiserMethod::bobyqa : MinimiserMethod::cobyla;
    options.max_evaluations -= outcome.evaluations;
    const int before = outcome.evaluations;
    runs = std::make_unique<DesignRuns>(context, true);
    outcome = search(problem, *runs, options);
    outcome.evaluations += before;
    options.max_evaluations += before;
  }
  static_cast<Report&>(result.report) = report_of(outcome, options.max_evaluations, doubts);
  for (const std::string& doubt : doubts) result.report.warnings.push_back(doubt);
  result.has_rows = true;
  result.columns = std::move(info);
  result.rows = rows;
  add_fields(result, task.goal, outcome, variables, options.method);
  show_designs(context, *runs, problem.start, outcome.x, rows);
  for (std::size_t v = 0; v < outcome.x.size(); ++v)
    context.values_at_end.push_back({task.goal.variables[v].parameter, outcome.x[v]});
}

}  // namespace catena
