#include "catena/results/terminal/report_text.hpp"

#include <algorithm>
#include <cmath>

#include "catena/results/number_format.hpp"

namespace catena {
namespace {

constexpr std::size_t longest_list = 10;

std::string count(std::int64_t n, const std::string& one, const std::string& many) {
  return std::to_string(n) + " " + (n == 1 ? one : many);
}

/// The first entries, separated by commas, and how many more there are; "none" where there are none.
template <class Range, class F>
std::string enumerate(const Range& range, F&& text_of) {
  if (range.empty()) return "none";
  std::string text;
  std::size_t shown = 0;
  for (const auto& entry : range) {
    if (shown == longest_list) return text + ", ... " + std::to_string(range.size() - shown) + " more";
    if (shown++ > 0) text += ", ";
    text += text_of(entry);
  }
  return text;
}

std::string names(const std::vector<std::string>& list) {
  return enumerate(list, [](const std::string& name) { return name; });
}

std::string values(const std::vector<std::pair<std::string, double>>& list) {
  return enumerate(list, [](const auto& entry) { return entry.first + " = " + format_number(entry.second); });
}

struct ScalarText {
  std::string operator()(bool value) const { return value ? "yes" : "no"; }
  std::string operator()(std::int64_t value) const { return std::to_string(value); }
  std::string operator()(double value) const { return format_number(value); }
  std::string operator()(const std::string& value) const { return value; }
  std::string operator()(const std::vector<std::string>& list) const { return names(list); }
};

/// All of a record on a line of its own.
std::string line_of(const FieldRecord& record) {
  std::string text;
  for (const auto& [name, value] : record)
    text += (text.empty() ? "\n    " : ", ") + name + " " + std::visit(ScalarText{}, value);
  return text;
}

struct ValueText : ScalarText {
  using ScalarText::operator();
  std::string operator()(const std::vector<double>& list) const { return enumerate(list, ScalarText{}); }
  std::string operator()(const std::vector<FieldRecord>& records) const {
    std::string text;
    for (const FieldRecord& record : records) text += line_of(record);
    return text.empty() ? "none" : text;
  }
  std::string operator()(const std::shared_ptr<const LongList>& list) const {
    constexpr std::int64_t shown = 5;
    std::string text;
    list->for_each([&, k = std::int64_t{0}](const FieldRecord& record) mutable {
      text += line_of(record);
      return ++k < shown;
    });
    if (list->size() > shown)
      text += "\n    and " + std::to_string(list->size() - shown) + " more: -o DIR and --json have all of them";
    return text.empty() ? "none" : text;
  }
  std::string operator()(const FieldRecord& record) const {
    return enumerate(record,
                     [](const auto& entry) { return entry.first + " " + std::visit(ScalarText{}, entry.second); });
  }
};

std::string with_unit(double value, const std::string& unit) {
  return format_number(value) + (unit.empty() || unit == "1" ? "" : " " + unit);
}

/// Name, value, unit, instant; the gradient below.
std::string measures_text(const AnalysisResult& result) {
  std::string text;
  for (const MeasureResult& measure : result.measures) {
    text += "  " + measure.name + ": ";
    text += measure.value ? with_unit(*measure.value, measure.unit) : "none";
    if (measure.t) text += " at t = " + format_number(*measure.t) + " s";
    if (!measure.trouble.empty()) text += " (" + measure.trouble + ")";
    text += "\n";
    for (std::size_t p = 0; p < result.gradient_parameters.size() && p < measure.gradient.size(); ++p)
      text += "    d/d(" + result.gradient_parameters[p] + ") " + format_number(measure.gradient[p]) + "\n";
  }
  return text;
}

/// Least and largest value of every column, under its table.
std::string extremes_text(const AnalysisResult& result) {
  std::string text;
  std::size_t shown = 0;
  const char* const instant = result.extremes_have_time ? " at t = " : " in row ";
  for (const ColumnExtreme& column : result.extremes) {
    if (shown++ == longest_list) {
      text += "    ... " + std::to_string(result.extremes.size() - longest_list) + " more columns\n";
      break;
    }
    text += "    " + column.name + ": " + with_unit(column.least, column.unit) + instant +
            format_number(column.least_t) + " ... " + with_unit(column.largest, column.unit) + instant +
            format_number(column.largest_t) + "\n";
  }
  return text.empty() ? text : "  least and largest:\n" + text;
}

/// How many digits are right, from the worst column to the best; columns of which none is known apart: most are
/// zero but for rounding.
std::string digits_text(const AnalysisResult& result) {
  std::size_t least = result.digits.size();
  double most = 0;
  std::int64_t zeros = 0;
  for (std::size_t k = 0; k < result.digits.size(); ++k) {
    const double digits = result.digits[k];
    zeros += digits == 0;
    if (!(digits > 0) || result.columns[k].unit == UnitKind::time) continue;
    if (least == result.digits.size() || digits < result.digits[least]) least = k;
    most = std::max(most, digits);
  }
  const std::string of_zeros =
      zeros == 0 ? "" : count(zeros, "column has", "columns have") + " no digit that is known, and is shown as 0\n";
  if (least == result.digits.size()) return of_zeros.empty() ? of_zeros : "  " + of_zeros;
  const auto whole = [](double digits) { return std::to_string(static_cast<int>(digits)); };
  std::string text = "  digits right: " + whole(result.digits[least]);
  if (whole(most) != whole(result.digits[least])) text += " ... " + whole(most);
  return text + " (least: " + result.columns[least].name + ")" + (of_zeros.empty() ? "\n" : "; " + of_zeros);
}

/// Rows, rank and freedoms as sentences.
std::string structure_text(const AnalysisReport& report) {
  std::string text = "  " + count(report.bodies, "body", "bodies") + ", " +
                     count(report.rows, "constraint equation", "constraint equations");
  if (report.rank) {
    text += ", " + std::to_string(*report.rank) + " of them independent";
    if (report.dof) text += ", on " + count(*report.dof + *report.rank, "coordinate", "coordinates");
  }
  text += "\n";
  if (report.dof) {
    text += "  " + count(*report.dof, "degree of freedom", "degrees of freedom");
    text += *report.dof == 0 ? ": constraints and drivers fix every position" : " left with all drivers at work";
    text += "\n";
  }
  if (report.mobility) {
    text += "  mobility " + std::to_string(*report.mobility) + ": ";
    text += count(*report.mobility, "degree of freedom", "degrees of freedom") + " if the drivers are taken away\n";
  }
  if (report.islands > 1) text += "  " + std::to_string(report.islands) + " groups of bodies move independently\n";
  return text;
}

std::string redundancy_text(const AnalysisReport& report) {
  if (report.redundant.empty()) return {};
  return "  redundant: " + names(report.redundant) +
         " (these equations follow from the others; reactions are not unique)\n";
}

}  // namespace

std::string header_text(const RunHeader& header) {
  std::string text = header.scene + ": " + count(header.bodies, "body", "bodies") + ", " +
                     count(header.elements, "element", "elements") + ", gravity [" + format_number(header.gravity[0]) +
                     ", " + format_number(header.gravity[1]) + "] m/s^2" +
                     (header.version.empty() ? "" : " (catena " + header.version + ")") + "\n";
  if (!header.parameters.empty()) text += "  parameters: " + values(header.parameters) + "\n";
  if (!header.set.empty()) {
    text +=
        "  set: " + enumerate(header.set, [](const auto& entry) { return entry.first + " = " + entry.second; }) + "\n";
  }
  if (!header.description.empty()) text += "  " + header.description + "\n";
  if (header.analyses == 0)
    text += "  the scene lists no \"analyses\"; catena check SCENE, catena kinematics SCENE ... run one\n";
  return text;
}

std::string outcome_text(const AnalysisResult& result) {
  std::string text = result.type + ": " + std::string(to_string(result.report.status));
  if (result.has_rows) text += ", " + count(result.rows, "row", "rows");
  return text + "\n";
}

std::string report_text(const AnalysisResult& result) {
  const AnalysisReport& report = result.report;
  std::string text;
  if (!result.set.empty()) text += "  set: " + values(result.set) + "\n";
  if (!report.message.empty()) text += "  " + report.message + "\n";
  for (const std::string& warning : report.warnings) text += "  note: " + warning + "\n";
  // Analyses with rows report the structure only where it is unusual; analyses that were refused before it was counted
  // do not.
  const bool counted = report.bodies > 0 || result.type == "check";
  if ((!result.has_rows && counted) || report.status == Status::under_driven) text += structure_text(report);
  if (!result.has_rows && report.rank && report.redundant.empty()) text += "  no redundant constraints\n";
  text += redundancy_text(report);
  text += digits_text(result);
  text += extremes_text(result);
  text += measures_text(result);
  for (const NamedField& field : result.fields)
    text += "  " + field.name + ": " + std::visit(ValueText{}, field.value) + "\n";
  return text;
}

std::string counters_text(const AnalysisResult& result) {
  const Counters& c = result.report.counters;
  std::string text = result.type + ": " + format_number(result.report.seconds) + " s\n";
  const auto add = [&](const char* name, std::int64_t n) {
    if (n == 0) return;
    const std::string number = std::to_string(n);
    text += "  " + std::string(12 - std::min<std::size_t>(12, number.size()), ' ') + number + "  " + name + "\n";
  };
  add("symbolic analyses", c.symbolic);
  add("factorizations", c.factorizations);
  add("of these with the pivots of the one before", c.refactorizations);
  add("solves", c.solves);
  add("Newton iterations", c.iterations);
  add("configurations (trigonometry)", c.configurations);
  add("constraint evaluations", c.phis);
  add("Jacobians", c.jacobians);
  add("velocity right-hand sides", c.nus);
  add("acceleration right-hand sides", c.gammas);
  add("force evaluations", c.forces);
  add("second derivatives", c.hessians);
  add("fallbacks to a safer kernel", c.fallbacks);
  add("time steps", c.steps);
  add("rejected time steps", c.rejected);
  return text;
}

}  // namespace catena
