#include "catena/scene/running/field_measures.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "catena/scene/models/design_events.hpp"
#include "catena/scene/running/analysis_run.hpp"

namespace catena {
namespace {

/// Numbers of the report, which are written beside the fields.
std::array<std::pair<std::string_view, std::optional<int>>, 6> reported_numbers(const AnalysisReport& report) {
  return {{{"bodies", report.bodies},
           {"rows", report.rows},
           {"islands", report.islands},
           {"rank", report.rank},
           {"dof", report.dof},
           {"mobility", report.mobility}}};
}

/// The number that a measure of the kind `field` names, if the result has it.
std::optional<double> reported(const AnalysisResult& result, const MeasureRequest& request) {
  for (const NamedField& field : result.fields) {
    if (field.name != request.field) continue;
    const auto place = static_cast<std::size_t>(request.number) - 1;
    if (const auto* number = std::get_if<double>(&field.value); number && request.number == 0) return *number;
    if (const auto* count = std::get_if<std::int64_t>(&field.value); count && request.number == 0)
      return static_cast<double>(*count);
    if (const auto* list = std::get_if<std::vector<double>>(&field.value); list && place < list->size())
      return (*list)[place];
    if (const auto* records = std::get_if<std::vector<FieldRecord>>(&field.value); records && place < records->size()) {
      for (const auto& [name, value] : (*records)[place]) {
        if (name != request.part) continue;
        if (const auto* number = std::get_if<double>(&value)) return *number;
        if (const auto* count = std::get_if<std::int64_t>(&value)) return static_cast<double>(*count);
      }
    }
  }
  for (const auto& [name, number] : reported_numbers(result.report)) {
    if (number && request.number == 0 && name == request.field) return *number;
  }
  return {};
}

}  // namespace

void add_field_measures(const AnalysisContext& context, AnalysisResult& result) {
  for (const PlacedMeasure& placed : context.task.measures) {
    const MeasureRequest& request = placed.request;
    if (request.kind != MeasureKind::field) continue;
    MeasureResult measure;
    measure.name = request.name;
    measure.value = reported(result, request);
    if (measure.value && !std::isfinite(*measure.value)) measure.value.reset();
    if (context.design) {
      measure.gradient.assign(context.design->names.size(), std::numeric_limits<double>::quiet_NaN());
      result.gradient_parameters = context.design->names;
    }
    if (!measure.value) {
      std::vector<std::string_view> has;
      for (const NamedField& field : result.fields) has.push_back(field.name);
      for (const auto& [name, number] : reported_numbers(result.report)) {
        if (number) has.push_back(name);
      }
      measure.trouble = fmt::format("{} reports no number {}{}{} (it has {})", context.task.type(), request.field,
                                    request.number > 0 ? fmt::format("[{}]", request.number) : "",
                                    request.part.empty() ? "" : "." + request.part, fmt::join(has, ", "));
      result.report.warnings.push_back(fmt::format("measure \"{}\": {}", request.name, measure.trouble));
    }
    measure.unit = request.field == "energy"                                          ? "J"
                   : request.field == "omega"                                         ? "rad/s"
                   : request.field == "growth"                                        ? "1/s"
                   : request.field == "omega2" || request.field == "omega2_imaginary" ? "rad^2/s^2"
                                                                                      : "";
    result.measures.push_back(std::move(measure));
  }
}

void set_field_gradient(const AnalysisContext& context, AnalysisResult& result, std::string_view field, int number,
                        const std::vector<double>& gradient, const std::string& trouble, std::string_view part) {
  for (const PlacedMeasure& placed : context.task.measures) {
    const MeasureRequest& request = placed.request;
    const bool meant = request.kind == MeasureKind::field && request.field == field && request.number == number;
    if (!meant || (number > 0 && !request.part.empty() && request.part != part)) continue;
    for (MeasureResult& measure : result.measures) {
      if (measure.name != request.name || !measure.value) continue;
      measure.gradient = gradient;
      measure.trouble = trouble;
      if (!trouble.empty()) result.report.warnings.push_back(fmt::format("measure \"{}\": {}", measure.name, trouble));
    }
  }
}

void set_event_gradients(const AnalysisContext& context, AnalysisResult& result,
                         const std::map<double, std::vector<double>>& instants) {
  for (const PlacedMeasure& placed : context.task.measures) {
    if (!reads_events(placed) || placed.request.part != "t") continue;
    for (const MeasureResult& measure : result.measures) {
      if (measure.name != placed.request.name || !measure.value) continue;
      const auto found = instants.find(*measure.value);
      std::vector<double> gradient(context.design->names.size(), std::numeric_limits<double>::quiet_NaN());
      std::string trouble;
      if (found == instants.end())
        trouble = fmt::format("the derivative of the instant t = {:.9g} s is not known", *measure.value);
      else
        gradient = found->second;
      set_field_gradient(context, result, placed.request.field, placed.request.number, gradient, trouble, "t");
      break;
    }
  }
}

}  // namespace catena
