// modes: small oscillations about the current configuration; one row a mode.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "catena/analysis/run/rope_ways_at.hpp"
#include "catena/analysis/sensitivity/spectrum/spectrum_derivatives.hpp"
#include "catena/analysis/stability/modes.hpp"
#include "catena/columns/column_errors.hpp"
#include "catena/scene/running/analysis_run.hpp"
#include "catena/scene/running/drawn_shapes.hpp"
#include "catena/scene/running/shape_columns.hpp"

namespace catena {
namespace {

// Frequencies nearer to each other than this part count as double: their vectors, known to 1e-8, turn into each other.
constexpr double frequencies_apart = 1e-6;

bool is_double(const ModesReport& report, std::size_t k) {
  const auto complex = [&](std::size_t n) {
    return std::complex<double>(report.omega2[n], n < report.imaginary.size() ? report.imaginary[n] : 0);
  };
  for (std::size_t other = 0; other < report.omega2.size(); ++other) {
    const double size = std::max(std::abs(complex(k)), std::abs(complex(other)));
    if (other != k && std::abs(complex(k) - complex(other)) <= frequencies_apart * size) return true;
  }
  return false;
}

using Gradient = std::optional<std::vector<double>>;

/// omega = sqrt |omega2|.
void give_real(const AnalysisContext& context, const ModesReport& report, std::size_t k, Gradient gradient,
               std::string trouble, AnalysisResult& result) {
  const int number = static_cast<int>(k) + 1;
  const std::vector<double> none(context.design->names.size(), std::numeric_limits<double>::quiet_NaN());
  set_field_gradient(context, result, "omega2", number, gradient.value_or(none), trouble);
  if (gradient && !(report.omega[k] > 0)) {
    gradient.reset();
    trouble = fmt::format("omega of mode {} is zero, where it has a kink; omega2 has a derivative", number);
  }
  if (gradient) {
    const double factor = (report.omega2[k] < 0 ? -0.5 : 0.5) / report.omega[k];
    for (double& derivative : *gradient) derivative *= factor;
  }
  set_field_gradient(context, result, "omega", number, gradient.value_or(none), trouble);
}

/// Of one of a pair, (growth + i omega)^2 = -z with z = omega2 + i imaginary: d(growth + i omega) = -dz / (2 (growth +
/// i omega)).
void give_pair(const AnalysisContext& context, const ModesReport& report, std::size_t k,
               const std::optional<std::vector<std::complex<double>>>& gradient, const std::string& trouble,
               AnalysisResult& result) {
  const std::size_t parameters = context.design->names.size();
  std::array<std::vector<double>, 4> parts;
  for (std::vector<double>& part : parts) part.assign(parameters, std::numeric_limits<double>::quiet_NaN());
  const std::complex<double> rate(report.growth[k], report.omega[k]);
  for (std::size_t p = 0; gradient && p < parameters; ++p) {
    const std::complex<double> z = (*gradient)[p], turned = -z / (2.0 * rate);
    parts[0][p] = z.real();
    parts[1][p] = z.imag();
    parts[2][p] = turned.imag();
    parts[3][p] = turned.real();
  }
  const std::array<const char*, 4> names = {"omega2", "omega2_imaginary", "omega", "growth"};
  for (std::size_t n = 0; n < names.size(); ++n)
    set_field_gradient(context, result, names[n], static_cast<int>(k) + 1, parts[n], trouble);
}

/// `from_model`: the modes are those of the place that the model gives.
void differentiate(const AnalysisContext& context, Modes& analysis, const ModesReport& report, bool from_model,
                   AnalysisResult& result) {
  Evaluator& evaluator = analysis.evaluator();
  const auto lambda = balancing_multipliers(evaluator, analysis.time(), analysis.q());
  SpectrumDerivatives derivatives(evaluator, designs_of(context), static_cast<int>(context.design->names.size()),
                                  from_model);
  const bool found =
      lambda && derivatives.find({.evaluator = evaluator, .t = analysis.time(), .q = analysis.q(), .lambda = *lambda});
  for (std::size_t k = 0; k < report.omega2.size(); ++k) {
    const bool flutters = k < report.imaginary.size() && report.imaginary[k] != 0;
    const bool several = found && is_double(report, k);
    std::string trouble;
    if (several)
      trouble = fmt::format(
          "mode {} is one of two or more with the same frequency, within {:.0e} of omega2: none of them has a "
          "derivative",
          k + 1, frequencies_apart);
    const auto why = [&](bool has_gradient) {
      if (has_gradient || !trouble.empty()) return trouble;
      return lambda ? derivatives.why() : std::string("constraints are singular at this place");
    };
    if (flutters) {
      std::optional<std::vector<std::complex<double>>> gradient;
      if (found && !several)
        gradient = derivatives.gradient_of_pair({report.omega2[k], report.imaginary[k]}, report.shapes[k]);
      give_pair(context, report, k, gradient, why(gradient.has_value()), result);
      continue;
    }
    Gradient gradient;
    if (found && !several)
      gradient = evaluator.conservative() ? derivatives.gradient(report.omega2[k], report.shapes[k])
                                          : derivatives.gradient_without_energy(report.omega2[k], report.shapes[k]);
    std::string trouble_there = why(gradient.has_value());
    give_real(context, report, k, std::move(gradient), std::move(trouble_there), result);
  }
}

/// Of omega2 and omega; shapes claim nothing.
std::vector<double> digits_of(const ModesReport& report, std::size_t columns) {
  ColumnErrors errors(columns);
  for (std::size_t k = 0; k < report.omega2.size(); ++k) {
    std::vector<double> row(columns, 0.0);
    row[1] = report.omega2[k];
    row[2] = report.omega[k];
    errors.take_row(row);
    errors.take_error(1, report.errors[k]);
    errors.take_error(2, report.omega[k] > 0 ? report.errors[k] / (2 * report.omega[k]) : 0);
  }
  return errors.digits();
}

/// Ropes lie as they can at the place that was assembled: with those ways the modes are found again. False: derivatives
/// are asked for, and the ways are not those that were given.
bool find_with_ways(AnalysisContext& context, RopeWaysAt& ways, const SystemState& start, const ModesOptions& options,
                    std::optional<Modes>& analysis, ModesReport& report) {
  const auto go_on = [&] { return !(context.cancel && context.cancel->load()); };
  const auto find = [&] {
    analysis.emplace(context.model, plan_options(*context.model, {}, start), options);
    analysis->start_from(start);
    report = analysis->run(go_on);
  };
  find();
  if (!ways.any() || !report.ok()) return true;
  analysis->evaluator().set_configuration(analysis->q());
  if (ways.find(analysis->evaluator())) {
    context.model = ways.model();
    find();
  }
  return !context.design || ways.lie_as_given();
}

/// One row a mode, with its shape if `shapes` asks for it; the columns, and how many rows were given.
std::int64_t give_rows(AnalysisContext& context, Modes& analysis, ModesReport& report, double t,
                       std::vector<ColumnInfo>& info) {
  const AnalysisTask& task = context.task;
  info = {{"mode", UnitKind::none}, {"omega2", UnitKind::squared_frequency}, {"omega", UnitKind::angular_velocity}};
  const bool complex = report.flutter > 0;
  if (complex) {
    info.push_back({"omega2_imaginary", UnitKind::squared_frequency});
    info.push_back({"growth", UnitKind::angular_velocity});
  }
  const std::size_t values = info.size();
  std::optional<ShapeColumns> shapes;
  if (task.number("shapes", 0) != 0) {
    shapes.emplace(*context.model, analysis.plan(), task.output_names(), task.type());
    info.insert(info.end(), shapes->info().begin(), shapes->info().end());
    if (!shapes->note().empty()) report.warnings.push_back(shapes->note());
  }
  context.rows.begin(info);
  std::vector<double> row(info.size());
  analysis.evaluator().set_configuration(analysis.q());
  std::int64_t rows = 0;
  for (std::size_t k = 0; k < report.omega2.size(); ++k, ++rows) {
    row[0] = static_cast<double>(k + 1);
    row[1] = report.omega2[k];
    row[2] = report.omega[k];
    if (complex) {
      row[3] = report.imaginary[k];
      row[4] = report.growth[k];
    }
    if (shapes)
      shapes->evaluate(analysis.evaluator(), analysis.q(), report.shapes[k], std::span<double>(row).subspan(values));
    if (!context.rows.row(row)) break;
  }
  draw_shapes(context, analysis.evaluator(), t, analysis.q(), report.shapes);
  return rows;
}

std::vector<NamedField> fields_of(const ModesReport& report, bool one_sided) {
  std::vector<NamedField> fields{
      {"omega2", report.omega2}, {"omega", report.omega}, {"unstable", static_cast<std::int64_t>(report.unstable)}};
  if (report.flutter > 0) {
    fields.push_back({"flutter", static_cast<std::int64_t>(report.flutter)});
    fields.push_back({"omega2_imaginary", report.imaginary});
    fields.push_back({"growth", report.growth});
  }
  if (one_sided) fields.push_back({"active", report.active});
  if (report.free_motions > 0) {
    fields.push_back({"free_motions", static_cast<std::int64_t>(report.free_motions)});
    fields.push_back({"moving_freely", report.free_bodies});
  }
  return fields;
}

}  // namespace

void run_modes(AnalysisContext& context, AnalysisResult& result) {
  RopeWaysAt ways(context.model);
  ModesOptions options;
  options.count = static_cast<int>(context.task.number("count", 0));
  SystemState start = context.state;
  const bool from_model = start.q.empty();
  if (context.design && !context.model->gaps().empty())
    return refuse(result, "modes with one-sided elements have no derivatives: they jump where one opens or closes");
  start.t = frozen_time(context);
  if (!from_model && ways.begin(start)) context.model = ways.model();
  std::optional<Modes> made;
  ModesReport report;
  if (!find_with_ways(context, ways, start, options, made, report))
    return refuse(result,
                  "derivatives are those of ropes that lie as in the given configuration; here one has met or "
                  "left a pulley, or is wound further: give the bodies a place nearer to rest");
  Modes& analysis = *made;
  std::vector<ColumnInfo> info;
  const std::int64_t rows = give_rows(context, analysis, report, start.t, info);
  // Places alone change hands, if they had to be assembled: velocities and time stay those of the motion so far.
  if (report.ok()) {
    SystemState found = analysis.state();
    context.state.q = std::move(found.q);
    context.state.curves = std::move(found.curves);
    context.state.ropes = ways.turns(context.state);
  }
  result.fields = fields_of(report, !analysis.plan().gap_rows.empty());
  result.report = report;
  // Of unsymmetric stiffness errors are not known.
  const bool judged = context.digits && !context.design && report.ok() && report.errors.size() == report.omega2.size();
  if (judged && rows > 0) result.digits = digits_of(report, info.size());
  take_rows(result, std::move(info), rows);
  add_field_measures(context, result);
  if (context.design && report.ok()) differentiate(context, analysis, report, from_model, result);
}

}  // namespace catena
