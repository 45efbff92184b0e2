#include "catena/scene/explaining/example.hpp"

#include "catena/scene/numbers/unit.hpp"

namespace catena {
namespace {

/// A quantity of this kind, in quotes.
std::string quantity(UnitKind kind) {
  const std::string all = example(dimension_of(kind));
  return all.substr(0, all.find(" or "));
}

/// What an analysis needs for this key.
std::string value_of_key(const AnalysisKey& key) {
  switch (key.kind) {
    case KeyKind::parameter:
      return "\"P\"";
    case KeyKind::analysis:
      return R"({"type": "kinematics", "until": 2, "measures": {"reach": {"max": "rod.from.x"}}})";
    case KeyKind::names:
      return R"(["P"])";
    case KeyKind::variables:
      return R"({"P": {"min": 1, "max": 10}}, "minimise": "reach")";
    case KeyKind::over:
      return R"({"P": {"from": 1, "to": 10, "count": 4}})";
    default:
      return "10";
  }
}

std::string value_of_field(const FieldDescription& field) {
  switch (field.kind) {
    case FieldKind::point:
      return field.body == 0 ? "\"crank.tip\"" : "\"rod.from\"";
    case FieldKind::axis:
      return "[1, 0]";
    case FieldKind::place:
      return "[0.5, 0.2]";
    case FieldKind::number:
    case FieldKind::function:
      return quantity(field.unit);
    case FieldKind::bound:
      return quantity(field.second_unit);
    case FieldKind::column:
      return field.key == "joint" ? "\"guide\"" : "\"crank.angle\"";
    case FieldKind::flag:
      return "true";
    case FieldKind::side:
      return "1";
    case FieldKind::choice:
      return "\"" + std::string(field.second_word) + "\"";
    case FieldKind::curve:
      return R"({"circle": {"centre": [0, 0], "radius": 0.05}})";
    case FieldKind::table:
      return "[[0, 0], [0.1, 20]]";
    case FieldKind::pulleys:
      return R"([{"at": ["ground", [0.15, 0.3]], "radius": 0.05}])";
    case FieldKind::function_pair:
      return "[0, " + quantity(field.unit) + "]";
  }
  return "0";
}

void add_member(std::string& out, std::string_view key, const std::string& value) {
  out += out.size() > 1 ? ", \"" : "\"";
  out.append(key).append("\": ").append(value);
}

}  // namespace

std::string example_of(const ElementDescription& type) {
  std::string out = "{";
  add_member(out, "type", "\"" + std::string(type.type) + "\"");
  add_member(out, "name", "\"A\"");
  // An elastic element shows its stiffnesses, be they optional one by one.
  const auto elastic = [&](const FieldDescription& field) {
    return type.force && field.kind == FieldKind::number &&
           (field.unit == UnitKind::stiffness || field.unit == UnitKind::torsion_stiffness);
  };
  for (const FieldDescription& field : type.fields) {
    const bool limit = field.kind == FieldKind::bound && field.key == "max";
    if (field.required || elastic(field) || limit || (field.kind == FieldKind::function && !type.force))
      add_member(out, field.key, value_of_field(field));
  }
  return out + "}";
}

std::string example_of(const AnalysisDescription& type) {
  std::string out = "{";
  add_member(out, "type", "\"" + std::string(type.type) + "\"");
  if (type.timed) {
    add_member(out, "until", "2");
    add_member(out, "every", "0.01");
  }
  for (const AnalysisKey& key : type.keys) {
    if (key.required) add_member(out, key.name, value_of_key(key));
  }
  return out + "}";
}

std::string example_scene(const ElementDescription& type) {
  // What acts in a joint wants one.
  const bool in_joint = type.find("joint") != nullptr;
  const std::string joint =
      in_joint
          ? R"("constraints": [{"type": "translational", "name": "guide", "i": "ground", "j": "crank", "axis_i": [1, 0]}],
 )"
          : "";
  return std::string(R"({"catena": 1,
 "bodies": {"crank": {"points": {"tip": [0.1, 0]}}, "rod": {"position": [0.4, 0], "points": {"from": [-0.2, 0]}}},
 )") + joint +
         "\"" + (type.force ? "forces" : "constraints") + "\": [" + example_of(type) + "]}\n";
}

}  // namespace catena
