// The measures of an analysis.
#include <fmt/format.h>

#include <cctype>
#include <charconv>

#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/numbers/evaluation.hpp"
#include "catena/scene/reading/analysis_reader.hpp"
#include "catena/scene/reading/data_file.hpp"
#include "catena/scene/reading/own_column_reader.hpp"

namespace catena {
namespace {

/// In the order of MeasureKind.
constexpr std::array<std::string_view, 11> kinds{"max", "min",      "range", "first", "final", "mean",
                                                 "rms", "integral", "at",    "path",  "field"};

/// Whether an analysis names a field among its results.
bool reports(const AnalysisDescription& analysis, std::string_view field) {
  const std::string_view results = analysis.results;
  const auto is_word = [&](std::size_t place) {
    return place < results.size() &&
           (std::isalnum(static_cast<unsigned char>(results[place])) || results[place] == '_');
  };
  for (std::size_t at = results.find(field); at != std::string_view::npos; at = results.find(field, at + 1)) {
    if ((at == 0 || !is_word(at - 1)) && !is_word(at + field.size())) return true;
  }
  return false;
}

}  // namespace

void AnalysisReader::read_measures(const JsonValue& object, AnalysisTask& task) {
  if (!object.is(JsonKind::object)) {
    error(object,
          fmt::format("\"measures\" must be an object of names and measures; this is {}", describe(object.kind())));
    return;
  }
  for (const JsonMember member : object.members()) read_measure(member, task);
}

bool AnalysisReader::read_measured_column(const JsonValue& value, PlacedMeasure& measure) {
  const std::string name = column_name(value, scene_, diagnostics_);
  if (name.empty()) return false;
  measure.columns.push_back({name, value});
  measure.request.columns.push_back(name);
  return true;
}

// The name of a reported number: omega2, loads[1], critical[1].value.
void AnalysisReader::read_field_name(const JsonValue& value, PlacedMeasure& measure) {
  const std::string_view text = read_string(value, {"field", "a measure"}, diagnostics_);
  if (!value.is(JsonKind::string)) return;
  const std::size_t bracket = text.find('[');
  MeasureRequest& request = measure.request;
  request.field = text.substr(0, std::min(bracket, text.find('.')));
  if (bracket == std::string_view::npos) {
    if (request.field.size() < text.size()) error(value, "only numbers of a list have parts: write critical[1].value");
    return;
  }
  const std::size_t close = text.find(']', bracket);
  const char* const from = text.data() + bracket + 1;
  const char* const to = text.data() + (close == std::string_view::npos ? text.size() : close);
  const auto [end, code] = std::from_chars(from, to, request.number);
  if (code != std::errc() || end != to || close == std::string_view::npos || request.number < 1) {
    error(value, fmt::format("{} names no number of a list: they count from 1, as in omega2[1]", in_quotes(text)));
    request.number = 0;
    return;
  }
  const std::string_view rest = text.substr(close + 1);
  if (rest.starts_with('.')) request.part = rest.substr(1);
  if (!rest.empty() && request.part.empty())
    error(value, fmt::format("{} is no field: after ] may follow a dot and the name of a part", in_quotes(text)));
}

void AnalysisReader::read_path(const JsonValue& object, std::size_t number, PlacedMeasure& measure) {
  constexpr std::array<std::string_view, 3> keys{"path", "to", "timed"};
  std::array<JsonValue, keys.size()> v;
  read_members(object, keys, "a measure of a path", v, diagnostics_);
  if (!v[0].is(JsonKind::array) || v[0].size() != 2) {
    error(v[0], "\"path\" must be a list of two columns, x and y");
    return;
  }
  for (const JsonValue& column : v[0].elements()) read_measured_column(column, measure);
  if (!v[1] || !(is_data_file(v[1]) || (v[1].is(JsonKind::array) && v[1].size() > 0))) {
    error(v[1] ? v[1] : object,
          "a measure of a path needs \"to\", a list of points [x, y] or two columns of a {\"file\": ...}");
    return;
  }
  TaskNumber place{.place = TaskNumber::Place::path_point, .item = number};
  const std::vector<NumberValue> coordinates =
      reading_.pair_list(v[1], {}, {}, {"to", "a measure of a path"}, {.places = true});
  for (std::size_t k = 0; k + 1 < coordinates.size(); k += 2) {
    Vec2<double>& read = measure.request.points.emplace_back();
    read.x = evaluated(coordinates[k], object, place);
    ++place.part;
    read.y = evaluated(coordinates[k + 1], object, place);
    ++place.part;
  }
  if (v[2]) measure.request.timed = read_flag(v[2], {"timed", "a measure of a path"}, diagnostics_);
}

// A number that other analyses report, and this one does not. What none of them names is left to the run.
void AnalysisReader::check_field(const JsonValue& value, std::string_view field, const AnalysisDescription& own) {
  if (field.empty() || reports(own, field)) return;
  std::string others;
  for (const AnalysisDescription& other : analysis_descriptions()) {
    if (reports(other, field)) others += (others.empty() ? "" : ", ") + std::string(other.type);
  }
  if (!others.empty())
    error(value, fmt::format("{} reports no {}: that is a result of {}", own.type, in_quotes(field), others));
}

// Of an object; nothing, with a report, where it has none or several.
std::optional<std::size_t> AnalysisReader::measure_kind(const JsonMember& member) {
  const JsonValue& object = member.value;
  std::optional<std::size_t> kind;
  for (std::size_t k = 0; k < kinds.size(); ++k) {
    const JsonValue found = object.find(kinds[k]);
    if (!found) continue;
    if (kind) {
      error(found, fmt::format("measure {} has \"{}\" and \"{}\": a measure is of one kind", in_quotes(member.name()),
                               kinds[*kind], kinds[k]));
      return {};
    }
    kind = k;
  }
  if (kind) return kind;
  const std::string_view given = object.size() > 0 ? (*object.members().begin()).name() : std::string_view();
  error(object,
        fmt::format("measure {} needs one of max, min, range, first, final, mean, rms, integral, at, path, "
                    "field{}{}",
                    in_quotes(member.name()), given.empty() ? "" : fmt::format("; {} is none", in_quotes(given)),
                    NearMiss(given).consider_all(kinds).hint()));
  return {};
}

void AnalysisReader::read_measure(const JsonMember& member, AnalysisTask& task) {
  PlacedMeasure measure;
  measure.request.name = member.name();
  measure.place = member.value;
  if (!is_identifier(member.name()))
    error(member.key, fmt::format("the measure's name {} cannot stand in an expression; use letters, digits and _",
                                  in_quotes(member.name())));
  if (scene_.parameters.names().find(member.name()) >= 0)
    error(member.key, fmt::format("a parameter is called {} already; choose another name", in_quotes(member.name())));
  const JsonValue& object = member.value;
  if (!object.is(JsonKind::object)) {
    error(object,
          fmt::format("a measure must be an object such as {{\"max\": column}}; this is {}", describe(object.kind())));
    return;
  }
  const std::optional<std::size_t> kind = measure_kind(member);
  if (!kind) return;
  measure.request.kind = static_cast<MeasureKind>(*kind);
  const JsonValue value = object.find(kinds[*kind]);
  if (measure.request.kind == MeasureKind::path) {
    read_path(object, task.measures.size(), measure);
  } else if (measure.request.kind == MeasureKind::at) {
    constexpr std::array<std::string_view, 2> keys{"at", "of"};
    std::array<JsonValue, keys.size()> v;
    read_members(object, keys, "a measure at an instant", v, diagnostics_);
    static const AnalysisKey instant{"at", KeyKind::time, "", UnitKind::time, Domain::any};
    measure.request.at = number(instant, value, {"at", "measure " + in_quotes(member.name())},
                                {.place = TaskNumber::Place::measured_instant, .item = task.measures.size()});
    if (v[1])
      read_measured_column(v[1], measure);
    else
      error(object, "a measure at an instant needs \"of\", its column");
  } else {
    const std::string_view key = kinds[*kind];
    JsonValue only;
    read_members(object, std::span(&key, 1), "measure " + in_quotes(member.name()), std::span(&only, 1), diagnostics_);
    if (measure.request.kind == MeasureKind::field)
      read_field_name(value, measure), check_field(value, measure.request.field, *task.description);
    else
      read_measured_column(value, measure);
  }
  if (needs_time(measure.request.kind) && !task.description->timed)
    error(value, fmt::format("{} is measured over time, which {} has not", in_quotes(kinds[*kind]), task.type()));
  const bool of_shapes = task.type() == "modes" || task.type() == "buckling";
  if (measure.request.kind != MeasureKind::field && of_shapes) {
    error(value, fmt::format("{} is taken of columns along a motion or at a state; the rows of {} are shapes: measure "
                             "what it reports, as {{\"field\": \"{}[1]\"}}",
                             in_quotes(kinds[*kind]), task.type(), task.type() == "modes" ? "omega2" : "loads"));
  }
  task.measures.push_back(std::move(measure));
}

}  // namespace catena
