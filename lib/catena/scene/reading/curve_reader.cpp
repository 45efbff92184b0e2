// Curves in body frames, and tables: from JSON to templates.
#include <fmt/format.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "catena/scene/reading/data_file.hpp"
#include "catena/scene/reading/scene_reading.hpp"
#include "catena/scene/reading/smoothing.hpp"

namespace catena {
namespace {

constexpr std::array<std::string_view, 4> curve_keys{"circle", "spline", "polar", "line"};

}  // namespace

std::vector<NumberValue> SceneReading::number_list(const JsonValue& value, const ExpectedDimension& dimension,
                                                   const FieldName& field) {
  if (!is_data_file(value)) return numbers.read_list(value, dimension, field);
  std::vector<NumberValue> result;
  const ExpectedDimension dimensions[] = {dimension};
  const DataColumns columns = read_data_file(value, dimensions, field, scene, diagnostics);
  if (columns.smooth > 0)
    error(columns.smooth_place, fmt::format("{}: values are smoothed along their places: give both columns of the file "
                                            "as \"points\"",
                                            field.text()));
  for (const std::vector<double>& column : columns.values) {
    for (const double number : column) result.push_back(NumberValue::constant(number, value.offset()));
  }
  return result;
}

std::vector<NumberValue> SceneReading::pair_list(const JsonValue& value, const ExpectedDimension& first,
                                                 const ExpectedDimension& second, const FieldName& field,
                                                 const PairUse& use) {
  std::vector<NumberValue> result;
  // What was reported counts as known.
  const auto any_pair = [&] { result.insert(result.end(), 2, NumberValue()); };
  if (is_data_file(value)) {
    const ExpectedDimension dimensions[] = {first, second};
    DataColumns columns = read_data_file(value, dimensions, field, scene, diagnostics, use.beside);
    if (columns.empty()) any_pair();
    if (columns.smooth > 0 && !columns.empty()) smooth(columns, use, field);
    for (std::size_t row = 0; !columns.empty() && row < columns.values[0].size(); ++row) {
      for (std::size_t c = 0; c < 2; ++c)
        result.push_back(NumberValue::constant(columns.values[c][row], value.offset()));
    }
    return result;
  }
  if (!value.is(JsonKind::array)) {
    error(value, fmt::format("{} must be a list of pairs; this is {}", field.text(), describe(value.kind())));
    any_pair();
    return result;
  }
  for (const JsonValue& pair : value.elements()) {
    if (!pair.is(JsonKind::array) || pair.size() != 2) {
      error(pair, fmt::format("{} must be a list of pairs [a, b]", field.text()));
      any_pair();
      continue;
    }
    auto element = pair.elements().begin();
    result.push_back(numbers.read(*element, first, field));
    ++element;
    result.push_back(numbers.read(*element, second, field));
  }
  return result;
}

void SceneReading::smooth(DataColumns& columns, const PairUse& use, const FieldName& field) {
  std::vector<double> knots = columns.values[0];
  if (use.places) {
    knots.assign(1, 0.0);
    for (std::size_t k = 1; k < columns.values[0].size(); ++k) {
      knots.push_back(knots.back() + std::hypot(columns.values[0][k] - columns.values[0][k - 1],
                                                columns.values[1][k] - columns.values[1][k - 1]));
    }
  }
  try {
    const std::span<std::vector<double>> moved = std::span(columns.values).subspan(use.places ? 0 : 1);
    const Smoothed smoothed = smooth_values(knots, moved, columns.smooth, use.repeats);
    std::copy(smoothed.values.begin(), smoothed.values.end(), moved.begin());
    scene.notes.push_back(fmt::format(
        "{}: the values of {} are smoothed by {:.6g} (root mean square), at most {:.6g} in number {} of {}, "
        "in SI",
        field.text(), in_quotes(scene.data_files.back()->name()), smoothed.rms, smoothed.largest, smoothed.worst + 1,
        knots.size()));
  } catch (const std::invalid_argument& wrong) {
    error(columns.smooth_place, fmt::format("{}: {}", field.text(), wrong.what()));
  }
}

int SceneReading::curve(const JsonValue& value, const FieldName& field) {
  CurveTemplate result;
  result.offset = static_cast<std::uint32_t>(value.offset());
  if (!value.is(JsonKind::object)) {
    error(value, fmt::format("{} must be a curve such as {{\"circle\": {{\"centre\": [0, 0], \"radius\": 0.1}}}}; this "
                             "is {}",
                             field.text(), describe(value.kind())));
  } else if (const auto member = read_only_member(value, curve_keys, field, "curve", diagnostics)) {
    curve_of_kind(*member, field, result);
  }
  scene.indirect.curves.push_back(std::move(result));
  return static_cast<int>(scene.indirect.curves.size()) - 1;
}

void SceneReading::curve_of_kind(const JsonMember& member, const FieldName& field, CurveTemplate& result) {
  static constexpr std::array<std::array<std::string_view, 3>, 4> keys{
      {{"centre", "radius", ""}, {"points", "end", "beyond"}, {"angle", "radius", "points"}, {"point", "axis", ""}}};
  const auto key = std::find(curve_keys.begin(), curve_keys.end(), member.name());
  result.kind = static_cast<CurveTemplate::Kind>(key - curve_keys.begin());
  const std::string owner = fmt::format("{} in {}", *key, field.text());
  const bool spline = result.kind == CurveTemplate::Kind::spline, polar = result.kind == CurveTemplate::Kind::polar;
  const auto names = std::span(keys[static_cast<std::size_t>(result.kind)]).first(spline || polar ? 3 : 2);
  std::array<JsonValue, 3> v;
  const bool read = spline || polar ? read_members_or_file(member.value, names, spline ? 0 : 2, owner, v, diagnostics)
                                    : read_members(member.value, names, owner, v, diagnostics);
  if (!read) return;
  if (polar && v[2]) return polar_pairs(v, names, owner, result);
  for (std::size_t k = 0; k < 2; ++k) {
    if (!v[k] && !(spline && k == 1)) error(member.value, fmt::format("{} needs {}", owner, in_quotes(names[k])));
  }
  if (!v[0] || (!v[1] && !spline)) return;
  const Dimension metre = dimension_of(UnitKind::length);
  const auto pair = [&](std::size_t k, const ExpectedDimension& dimension) {
    const auto numbers_read = numbers.read_pair(v[k], dimension, {names[k], owner});
    result.numbers.insert(result.numbers.end(), numbers_read.begin(), numbers_read.end());
  };
  switch (result.kind) {
    case CurveTemplate::Kind::circle:
      pair(0, metre);
      result.numbers.push_back(numbers.read(v[1], metre, {names[1], owner}));
      break;
    case CurveTemplate::Kind::spline:
      if (v[1]) {
        static constexpr std::array<std::string_view, 2> words{"natural", "periodic"};
        if (read_word(v[1], words, {names[1], owner}, diagnostics) == 1) result.end = SplineEnd::periodic;
      }
      result.numbers = pair_list(v[0], metre, metre, {names[0], owner},
                                 {.places = true, .repeats = result.end == SplineEnd::periodic, .beside = names});
      result.beyond = beyond(v[2], result.end, owner);
      break;
    case CurveTemplate::Kind::polar: {
      const auto angles = number_list(v[0], dimension_of(UnitKind::angle), {names[0], owner});
      const auto radii = number_list(v[1], metre, {names[1], owner});
      if (angles.size() != radii.size()) {
        error(v[1], fmt::format("{}: {} angles, but {} radii", owner, angles.size(), radii.size()));
        break;
      }
      result.numbers = angles;
      result.numbers.insert(result.numbers.end(), radii.begin(), radii.end());
      break;
    }
    case CurveTemplate::Kind::line:
      pair(0, metre);
      pair(1, ExpectedDimension());
      break;
  }
}

void SceneReading::polar_pairs(std::span<const JsonValue> v, std::span<const std::string_view> names,
                               const std::string& owner, CurveTemplate& result) {
  if (v[0] || v[1]) error(v[2], fmt::format("{} has pairs, or \"angle\" and \"radius\", not both", owner));
  const std::vector<NumberValue> pairs = pair_list(v[2], dimension_of(UnitKind::angle), dimension_of(UnitKind::length),
                                                   {names[2], owner}, {.repeats = true, .beside = names});
  for (std::size_t c = 0; c < 2; ++c) {
    for (std::size_t k = c; k < pairs.size(); k += 2) result.numbers.push_back(pairs[k]);
  }
}

int SceneReading::table(const JsonValue& value, UnitKind first, UnitKind second, const FieldName& field) {
  TableTemplate result;
  result.offset = static_cast<std::uint32_t>(value.offset());
  static constexpr std::array<std::string_view, 2> keys{"points", "beyond"};
  JsonValue pairs = value;
  if (value.is(JsonKind::object)) {
    const std::string owner = field.text();
    std::array<JsonValue, 2> v;
    read_members_or_file(value, keys, 0, owner, v, diagnostics);
    if (!v[0]) error(value, fmt::format("{} needs \"points\", a list of pairs", owner));
    result.beyond = beyond(v[1], SplineEnd::natural, owner);
    pairs = v[0];
  }
  if (pairs) result.numbers = pair_list(pairs, dimension_of(first), dimension_of(second), field, {.beside = keys});
  scene.indirect.tables.push_back(std::move(result));
  return static_cast<int>(scene.indirect.tables.size()) - 1;
}

}  // namespace catena
