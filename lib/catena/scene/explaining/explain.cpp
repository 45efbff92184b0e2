#include <fmt/format.h>

#include <algorithm>

#include "catena/base/si_unit.hpp"
#include "catena/columns/element_columns.hpp"
#include "catena/scene/building/build_model.hpp"
#include "catena/scene/explaining/example.hpp"
#include "catena/scene/explaining/explain_topics.hpp"
#include "catena/scene/numbers/number_domain.hpp"
#include "catena/scene/reading/scene_reader.hpp"
#include "catena/scene/running/scene_runner.hpp"

namespace catena {
namespace {

struct Line {
  std::string key, text;
};

/// Keys and what they are, in two columns.
std::string table(const std::vector<Line>& lines) {
  std::size_t width = 0;
  for (const Line& line : lines) width = std::max(width, line.key.size());
  std::string out;
  for (const Line& line : lines) out += fmt::format("  {:<{}}  {}\n", line.key, width, line.text);
  return out;
}

/// Names and units one after the other, in lines of at most 100 characters.
std::string flow(const std::vector<Line>& entries) {
  std::string out, line;
  for (const Line& entry : entries) {
    const std::string text = fmt::format("  {} [{}]", entry.key, entry.text);
    if (line.size() + text.size() > 100) {
      out += line + "\n";
      line.clear();
    }
    line += text;
  }
  return out + line + "\n";
}

std::string unit_text(UnitKind unit) { return unit == UnitKind::none ? "a pure number" : std::string(si_unit(unit)); }

/// What may be written for a field: kind, unit, domain.
std::string form(const FieldDescription& field, bool force) {
  const std::string_view varying =
      force ? "a function of time or an expression over columns (catena explain state_law)" : "a function of time";
  switch (field.kind) {
    case FieldKind::point:
      return "\"body\", \"body.point\" or [\"body\", [x', y']]";
    case FieldKind::axis:
      return "[vx', vy'], of any length";
    case FieldKind::place:
      return "[x, y], m";
    case FieldKind::number:
      return unit_text(field.unit) + (field.domain == Domain::any ? "" : fmt::format(", {}", wanted(field.domain)));
    case FieldKind::bound:
      return fmt::format("{}, {} for an angle{}", unit_text(field.unit), unit_text(field.second_unit),
                         field.domain == Domain::any ? "" : fmt::format("; {}", wanted(field.domain)));
    case FieldKind::column:
      return field.key == "joint" ? "its name" : "\"A.angle\", \"A.slide\", \"A.length\", \"body.x\", ...";
    case FieldKind::flag:
      return "true or false";
    case FieldKind::side:
      return "1 (default) or -1";
    case FieldKind::choice:
      return fmt::format("\"{}\" (default) or \"{}\"", field.first_word, field.second_word);
    case FieldKind::curve:
      return "a curve (catena explain circle, polar, line, spline)";
    case FieldKind::table:
      return fmt::format(
          "pairs [{}, {}], or {{\"points\": pairs, \"beyond\": \"error\" (default), \"hold\" or \"line\"}}",
          si_unit(field.unit), si_unit(field.second_unit));
    case FieldKind::pulleys:
      return "a list of {\"at\": body point, \"radius\": m (default 0), \"side\": 1 where it lies on the left of the "
             "rope from i to j, or -1 (default: where the way bends to), \"pulley\": \"slides\" (default) or "
             "\"rolls\", \"mu\": 0, of the friction in motion where the rope slides: tensions differ by exp(mu angle) "
             "at most}";
    case FieldKind::function:
      return fmt::format("{}, {}{}", unit_text(field.unit), force ? "" : "or ", varying);
    case FieldKind::function_pair:
      return fmt::format("[f_x, f_y], each {}{} {}", unit_text(field.unit), force ? "," : " or", varying);
  }
  return {};
}

/// The columns of the element in its own example.
std::vector<Line> example_columns(const ElementDescription& type) {
  Diagnostics diagnostics;
  const auto scene = read_scene(SourceText("example", example_scene(type)), diagnostics);
  std::vector<Line> lines;
  if (!scene) return lines;
  const Model model = build_model<double>(*scene, std::span<const double>(), {}, diagnostics);
  const int element = model.find_element("A");
  if (element < 0) return lines;
  for (const ElementColumn& column : columns_of_element(model, element))
    lines.push_back({"A." + column.suffix, std::string(si_unit(column.unit))});
  return lines;
}

std::string explain_element(const ElementDescription& type) {
  std::string out = fmt::format(
      "{}: a {}\n  {}\n\n  {}\n\nKeys\n", type.type,
      type.force ? "force"
                 : fmt::format("constraint with {} equation{}{}", type.rows, type.rows == 1 ? "" : "s",
                               type.can_be_driven() ? "; in \"drivers\" its value is a function of time" : ""),
      type.summary, type.equation);
  std::vector<Line> lines{{"type", fmt::format("\"{}\"", type.type)}, {"name", "its name (default: type#n)"}};
  for (const FieldDescription& field : type.fields) {
    if (field.reserved()) continue;
    std::string omitted;
    if (!field.required && field.doc.find("default") == std::string_view::npos &&
        form(field, type.force).find("default") == std::string::npos)
      omitted = field.omitted == Omitted::given ? "; default: as in the given configuration" : "; optional";
    if (!field.synonym.empty()) omitted += fmt::format("; also called {}", field.synonym);
    lines.push_back({std::string(field.key), fmt::format("{}: {}{}", field.doc, form(field, type.force), omitted)});
  }
  if (type.bodies > 0)
    lines.push_back(
        {"at", "[x, y], m: the place of the points in the given configuration, where i and j name bodies alone"});
  out += table(lines);
  const std::vector<Line> columns = example_columns(type);
  if (!columns.empty()) {
    out += "\nColumns, for the name A\n";
    out += flow(columns);
    if (type.can_be_driven()) out += "  as a driver also A.load, A.power [W], A.work [J]\n";
  }
  return out + "\nExample\n  " + example_of(type) + "\n";
}

std::string form(const AnalysisKey& key) {
  std::string words;
  switch (key.kind) {
    case KeyKind::number:
    case KeyKind::whole:
      return key.required ? ", required" : "";
    case KeyKind::word:
      for (const std::string_view word : key.words) words += fmt::format("{} \"{}\"", words.empty() ? ":" : ",", word);
      return words;
    default:
      return key.required ? ", required" : "";
  }
}

std::string explain_analysis(const AnalysisDescription& type) {
  std::string out = fmt::format("{}: an analysis\n  {}\n\nKeys\n", type.type, type.summary);
  std::vector<Line> lines;
  for (const AnalysisKey& key : type.keys) lines.push_back({std::string(key.name), std::string(key.doc) + form(key)});
  out += table(lines);
  if (!type.results.empty()) out += fmt::format("\nResults besides its rows\n  {}\n", type.results);
  return out + "\nExample\n  " + example_of(type) + "\n";
}

}  // namespace

std::optional<std::string> explain(std::string_view name) {
  if (const ElementDescription* type = find_element_type(name)) return explain_element(*type);
  if (const AnalysisDescription* type = find_analysis_type(name)) return explain_analysis(*type);
  for (const ExplainedTopic& topic : explained_topics()) {
    for (const std::string_view known : topic.names) {
      if (known == name) return std::string(topic.text);
    }
  }
  return {};
}

std::vector<std::string> explained_names() {
  std::vector<std::string> names;
  for (const ElementDescription& type : element_descriptions()) names.emplace_back(type.type);
  for (const AnalysisDescription& type : analysis_descriptions()) {
    names.emplace_back(type.type);
  }
  for (const ExplainedTopic& topic : explained_topics())
    names.insert(names.end(), topic.names.begin(), topic.names.end());
  return names;
}

}  // namespace catena
