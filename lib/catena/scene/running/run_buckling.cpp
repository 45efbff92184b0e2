// buckling: values of a load parameter at which the current equilibrium loses its stability; one row a value, with the
// shape in which it does if outputs are named.
#include <fmt/format.h>

#include <cmath>
#include <limits>

#include "catena/analysis/run/rope_ways_at.hpp"
#include "catena/analysis/run/weightless_bodies.hpp"
#include "catena/analysis/sensitivity/spectrum/spectrum_derivatives.hpp"
#include "catena/analysis/stability/buckling.hpp"
#include "catena/columns/column_errors.hpp"
#include "catena/scene/running/analysis_run.hpp"
#include "catena/scene/running/drawn_shapes.hpp"
#include "catena/scene/running/shape_columns.hpp"

namespace catena {
namespace {

// Loads nearer to each other than this part count as double: their shapes, known to 1e-8, turn into each other.
constexpr double apart = 1e-6;
constexpr const char* singular = "constraints are singular at this place";

/// Loads of one kind: the name of their field, their values, and of each the shape and the frequency, 0 of divergence.
struct CriticalLoads {
  std::string field;
  std::vector<double> values, omega{};
  std::vector<std::span<const double>> shapes{};
};

/// Under forces without a potential loads of flutter are among all others.
CriticalLoads loads_of(const BucklingReport& report, bool flutter) {
  CriticalLoads loads{flutter ? "flutter" : "loads", flutter ? report.flutter : report.loads};
  for (std::size_t k = 0; k < report.shapes.size(); ++k) {
    const double omega = report.critical.empty() ? 0 : report.critical[k].omega;
    if ((omega > 0) != flutter) continue;
    loads.omega.push_back(omega);
    loads.shapes.emplace_back(report.shapes[k]);
  }
  return loads;
}

/// The present equilibrium, which moves with every parameter but the load.
struct PresentPlace {
  const AnalysisContext& context;
  Buckling& analysis;
  StaticDerivatives equilibrium;
  std::string trouble{};

  PresentPlace(const AnalysisContext& of, Buckling& buckling)
      : context(of),
        analysis(buckling),
        equilibrium(buckling.evaluator(), designs_of(of, of.task.word("parameter")),
                    static_cast<int>(of.design->names.size()) + 1) {
    Evaluator& present = analysis.evaluator();
    const auto held = balancing_multipliers(present, analysis.time(), analysis.q());
    if (!held)
      trouble = singular;
    else if (!equilibrium.find({.evaluator = present, .t = analysis.time(), .q = analysis.q(), .lambda = *held}))
      trouble = equilibrium.why();
  }

  /// h_p by every parameter and the load; nothing, and why, where it is not known.
  std::optional<std::vector<double>> slopes(double load, double omega, std::span<const double> shape,
                                            std::string& why) {
    const int parameter = context.task.word("parameter");
    const std::shared_ptr<const Model> model = model_at(context, parameter, load);
    if (!model) {
      why = "the scene allows no model at this load";
      return {};
    }
    EvaluationWork work;
    Evaluator evaluator(analysis.evaluator().shared_plan(), *model, work);
    const auto lambda = balancing_multipliers(evaluator, analysis.time(), analysis.q());
    why = singular;
    if (!lambda) return {};
    SpectrumDerivatives derivatives(evaluator, designs_of(context, parameter, ParameterSeed<double>{parameter, load}),
                                    equilibrium.parameters(), true);
    std::optional<std::vector<double>> h;
    if (derivatives.find_held({.evaluator = evaluator, .t = analysis.time(), .q = analysis.q(), .lambda = *lambda},
                              equilibrium)) {
      h = omega > 0 ? derivatives.gradient_of_meeting(omega * omega, shape)
          : evaluator.conservative()
              ? derivatives.gradient(0, shape)
              : derivatives.gradient_without_energy(0, shape, SpectrumDerivatives::Metric::lengths);
    }
    why = derivatives.why();
    return h;
  }
};

/// dP/dp = -h_p / h_P, h = v^T K v on the null space, of unsymmetric K with the vector on its left, and less omega2 M
/// where two frequencies meet; see spectrum_derivatives.hpp.
void differentiate(PresentPlace& place, const CriticalLoads& loads, AnalysisResult& result) {
  const AnalysisContext& context = place.context;
  const std::size_t count = context.design->names.size();
  for (std::size_t k = 0; k < loads.values.size(); ++k) {
    const double load = loads.values[k];
    std::vector<double> gradient(count, std::numeric_limits<double>::quiet_NaN());
    std::string trouble = place.trouble;
    for (std::size_t other = 0; other < loads.values.size(); ++other) {
      if (other != k && std::abs(load - loads.values[other]) <= apart * std::abs(load))
        trouble = fmt::format("load {} is double: it has no derivative", k + 1);
    }
    std::optional<std::vector<double>> h;
    if (trouble.empty()) h = place.slopes(load, loads.omega[k], loads.shapes[k], trouble);
    if (h && (*h)[count] == 0) {
      trouble = fmt::format("load {} does not change the stiffness along its shape: it has no derivative", k + 1);
    } else if (h) {
      for (std::size_t p = 0; p < count; ++p)
        gradient[p] = context.design->parameters[p] == context.task.word("parameter") ? 0 : -(*h)[p] / (*h)[count];
    }
    set_field_gradient(context, result, loads.field, static_cast<int>(k) + 1, gradient, trouble);
  }
}

/// Of the loads; shapes claim nothing.
std::vector<double> digits_of(const BucklingReport& report, std::size_t columns) {
  if (report.errors.empty()) return {};
  ColumnErrors errors(columns);
  std::vector<double> row(columns, 0.0);
  for (std::size_t k = 0; k < report.errors.size(); ++k) {
    row[0] = report.loads[k];
    errors.take_row(row);
    errors.take_error(0, report.errors[k]);
  }
  return errors.digits();
}

/// One row a load, with its shape if outputs are named; the columns, and how many rows were given.
std::int64_t give_rows(AnalysisContext& context, Buckling& analysis, BucklingReport& report,
                       std::vector<ColumnInfo>& info) {
  const AnalysisTask& task = context.task;
  info = {{std::string(context.parameter_name), UnitKind::own}};
  // Forces without a potential: the frequency tells divergence, 0, from flutter.
  const bool circulatory = !analysis.evaluator().conservative();
  if (circulatory) info.push_back({"omega", UnitKind::angular_velocity});
  const std::size_t values = info.size();
  std::optional<ShapeColumns> shapes;
  if (!task.outputs.empty()) {
    shapes.emplace(*context.model, analysis.plan(), task.output_names(), task.type());
    info.insert(info.end(), shapes->info().begin(), shapes->info().end());
    if (!shapes->note().empty()) report.warnings.push_back(shapes->note());
  }
  context.rows.begin(info);
  std::vector<double> row(info.size());
  std::int64_t rows = 0;
  for (std::size_t k = 0; k < report.shapes.size(); ++k, ++rows) {
    row[0] = circulatory ? report.critical[k].value : report.loads[k];
    if (circulatory) row[1] = report.critical[k].omega;
    if (shapes)
      shapes->evaluate(analysis.evaluator(), analysis.q(), report.shapes[k], std::span<double>(row).subspan(values));
    if (!context.rows.row(row)) break;
  }
  return rows;
}

}  // namespace

void run_buckling(AnalysisContext& context, AnalysisResult& result) {
  const AnalysisTask& task = context.task;
  const int parameter = task.word("parameter");
  BucklingOptions options;
  options.present = task.parameters.at(static_cast<std::size_t>(parameter));
  options.count = static_cast<int>(task.number("count", 1));
  options.errors = context.digits && !context.design;
  SystemState start = context.state;
  start.t = frozen_time(context);
  if (const std::string why = trouble_with_one_sided(context, start); !why.empty()) return refuse(result, why);
  Buckling analysis(
      context.model, [&](double value) { return model_at(context, parameter, value); }, options,
      plan_options(*context.model, {}, start));
  analysis.start_from(start);
  BucklingReport report = analysis.run([&] { return !(context.cancel && context.cancel->load()); });
  if (std::string remark = remark_on_weightless(*context.model, analysis.plan()); !remark.empty())
    report.warnings.push_back(std::move(remark));
  std::vector<ColumnInfo> info;
  const std::int64_t rows = give_rows(context, analysis, report, info);
  draw_shapes(context, analysis.evaluator(), start.t, analysis.q(), report.shapes);
  // Places alone change hands: velocities and time stay those of the motion so far.
  if (report.ok()) {
    SystemState found = analysis.state();
    context.state.q = std::move(found.q);
    context.state.curves = std::move(found.curves);
    context.state.ropes = RopeWaysAt(context.model).turns(context.state);
  }
  result.fields = {{"loads", report.loads}};
  if (report.flutter_sought) {
    result.fields.push_back({"flutter", report.flutter});
    std::vector<double> omega;
    for (const BucklingReport::Critical& load : report.critical) {
      if (load.omega > 0) omega.push_back(load.omega);
    }
    result.fields.push_back({"flutter_omega", std::move(omega)});
  }
  if (!analysis.plan().gap_rows.empty()) result.fields.push_back({"active", report.active});
  result.report = report;
  if (report.ok()) result.digits = digits_of(report, info.size());
  take_rows(result, std::move(info), rows);
  add_field_measures(context, result);
  if (!context.design || !report.ok()) return;
  PresentPlace place(context, analysis);
  for (const bool flutter : {false, true}) differentiate(place, loads_of(report, flutter), result);
}

}  // namespace catena
