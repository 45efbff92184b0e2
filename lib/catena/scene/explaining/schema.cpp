#include <fmt/format.h>

#include <nlohmann/json.hpp>

#include "catena/scene/describing/analysis_description.hpp"
#include "catena/scene/describing/body_keys.hpp"
#include "catena/scene/describing/element_description.hpp"
#include "catena/scene/explaining/schema_fixed.hpp"
#include "catena/scene/numbers/output_units.hpp"
#include "catena/scene/numbers/unit.hpp"
#include "catena/scene/running/scene_runner.hpp"

namespace catena {
namespace {

using json = nlohmann::ordered_json;

json reference(std::string_view definition) { return {{"$ref", "#/$defs/" + std::string(definition)}}; }

json described(json schema, std::string_view doc) {
  if (!doc.empty()) schema["description"] = doc;
  return schema;
}

json list_of(json items) { return {{"type", "array"}, {"items", std::move(items)}}; }

json pair_of(json item) { return {{"type", "array"}, {"items", std::move(item)}, {"minItems", 2}, {"maxItems", 2}}; }

/// An object with these members and no others.
json object_of(json properties, const std::vector<std::string>& required = {}) {
  json schema{{"type", "object"}, {"properties", std::move(properties)}, {"additionalProperties", false}};
  if (!required.empty()) schema["required"] = required;
  return schema;
}

/// Any names, all of the same schema.
json map_of(json values) { return {{"type", "object"}, {"additionalProperties", std::move(values)}}; }

std::string in_unit(std::string_view doc, UnitKind unit) {
  return unit == UnitKind::none || unit == UnitKind::own ? std::string(doc)
                                                         : fmt::format("{} [{}]", doc, si_unit(dimension_of(unit)));
}

json number(std::string_view doc, UnitKind unit, Domain domain = Domain::any) {
  json schema = domain == Domain::positive       ? reference("positive")
                : domain == Domain::not_negative ? reference("notNegative")
                                                 : reference("number");
  return described(std::move(schema), in_unit(doc, unit));
}

/// A number in JSON, or text whose value only a reader knows.
json number_schema(json limits) {
  json plain{{"type", "number"}};
  plain.update(limits);
  return {{"anyOf", json::array({plain, {{"type", "string"}, {"minLength", 1}}})}};
}

constexpr std::string_view side_of_pulley =
    "1: it lies on the left of the rope as that runs from i to j, -1: on the right (default: where the way bends to)";
constexpr std::string_view way_of_pulley =
    "slides (default): the rope slides over it, with friction mu in motion; rolls: it turns the pulley's body";

json field_schema(const FieldDescription& field) {
  switch (field.kind) {
    case FieldKind::point:
      return described(reference("attachment"), field.doc);
    case FieldKind::axis:
    case FieldKind::place:
      return described(reference("pair"),
                       in_unit(field.doc, field.kind == FieldKind::place ? UnitKind::length : UnitKind::none));
    case FieldKind::number:
      return number(field.doc, field.unit, field.domain);
    case FieldKind::bound:
      return number(fmt::format("{}; of an angle [{}]", field.doc, si_unit(dimension_of(field.second_unit))),
                    field.unit, field.domain);
    case FieldKind::column:
      return {{"type", "string"}, {"description", field.doc}};
    case FieldKind::flag:
      return {{"type", "boolean"}, {"description", field.doc}};
    case FieldKind::side:
      return {{"enum", {1, -1}}, {"description", field.doc}};
    case FieldKind::choice:
      return {{"enum", {field.first_word, field.second_word}}, {"description", field.doc}};
    case FieldKind::curve:
      return described(reference("curve"), field.doc);
    case FieldKind::table:
      return described(reference("table"), field.doc);
    case FieldKind::pulleys: {
      json pulley = object_of(
          {{"at", described(reference("attachment"), "its centre")},
           {"radius", number("radius (default 0: a point)", UnitKind::length, Domain::not_negative)},
           {"side", {{"enum", {1, -1}}, {"description", side_of_pulley}}},
           {"pulley", {{"enum", {"slides", "rolls"}}, {"description", way_of_pulley}}},
           {"mu",
            number("friction where the rope slides, in motion: tensions differ by exp(mu angle of contact) at most "
                   "(default 0)",
                   UnitKind::none, Domain::not_negative)}},
          {"at"});
      json list = list_of(std::move(pulley));
      list["minItems"] = 1;
      return described(std::move(list), field.doc);
    }
    case FieldKind::function:
      return described(reference("function"), in_unit(field.doc, field.unit));
    case FieldKind::function_pair:
      return described(pair_of(reference("function")), in_unit(field.doc, field.unit));
  }
  return {};
}

json element_schema(const ElementDescription& type, bool driver) {
  json properties{{"type", {{"const", type.type}, {"description", type.summary}}},
                  {"name", {{"type", "string"}, {"description", "its name (default: type#n)"}}}};
  std::vector<std::string> required{"type"};
  for (const FieldDescription& field : type.fields) {
    if (field.reserved()) continue;
    properties[std::string(field.key)] = field_schema(field);
    if (!field.synonym.empty()) properties[std::string(field.synonym)] = field_schema(field);
    if ((field.required && field.unless.empty()) || (driver && field.kind == FieldKind::function))
      required.emplace_back(field.key);
  }
  // Bodies are named even where an element has no point there.
  for (int body = 0; body < type.bodies; ++body) {
    const std::string key = body == 0 ? "i" : "j";
    if (!properties.contains(key)) properties[key] = reference("attachment");
  }
  if (type.bodies > 0)
    properties["at"] = described(reference("pair"), "place of its points in the given configuration [m]");
  return object_of(std::move(properties), required);
}

json event_schema();
json event_block_schema();

json key_schema(const AnalysisKey& key) {
  switch (key.kind) {
    case KeyKind::number:
      return number(key.doc, key.unit, key.domain);
    case KeyKind::whole:
      return described(number_schema({{"minimum", 1}}), key.doc);
    case KeyKind::flag:
      return {{"type", "boolean"}, {"description", key.doc}};
    case KeyKind::word:
      if (key.words.empty()) return {{"type", "string"}, {"description", key.doc}};
      return {{"enum", key.words}, {"description", key.doc}};
    case KeyKind::time:
      return number(key.doc, key.unit);
    case KeyKind::times:
      return {{"anyOf", json::array({reference("number"), list_of(reference("number"))})}, {"description", key.doc}};
    case KeyKind::columns:
      return described(reference("outputs"), key.doc);
    case KeyKind::parameter:
      return {{"type", "string"}, {"description", key.doc}};
    case KeyKind::set:
      return described(map_of(reference("number")), key.doc);
    case KeyKind::events:
      return described(list_of(event_schema()), key.doc);
    case KeyKind::event_blocks:
      return described(list_of(reference("eventBlock")), key.doc);
    case KeyKind::impulse:
      return described(object_of({{"i", reference("attachment")}, {"value", reference("pair")}}, {"i", "value"}),
                       key.doc);
    case KeyKind::measures:
      return described(map_of(reference("measure")), key.doc);
    case KeyKind::analysis:
      return {{"anyOf", json::array({reference("analysis"), list_of(reference("analysis"))})},
              {"description", key.doc}};
    case KeyKind::names:
      return described(list_of({{"type", "string"}}), key.doc);
    case KeyKind::variables:
      return described(
          map_of(
              object_of({{"min", reference("number")}, {"max", reference("number")}, {"start", reference("number")}})),
          key.doc);
    case KeyKind::over: {
      const json pair{{"type", "array"}, {"items", reference("number")}, {"minItems", 2}, {"maxItems", 2}};
      const json range = object_of({{"from", reference("number")},
                                    {"to", reference("number")},
                                    {"count", {{"type", "integer"}, {"minimum", 1}}},
                                    {"normal", pair},
                                    {"uniform", pair}});
      return described(map_of({{"anyOf", json::array({reference("number"), list_of(reference("number")), range})}}),
                       key.doc);
    }
    case KeyKind::objective:
      return {{"type", "string"}, {"minLength", 1}, {"description", key.doc}};
    case KeyKind::relations:
      return described(list_of({{"type", "string"}, {"pattern", "^="}}), key.doc);
  }
  return {};
}

json event_schema() {
  json properties = json::object();
  std::vector<std::string> required;
  for (const AnalysisKey& key : event_keys()) {
    properties[std::string(key.name)] =
        key.kind == KeyKind::columns ? json{{"type", "string"}, {"description", key.doc}} : key_schema(key);
    if (key.required) required.emplace_back(key.name);
  }
  return object_of(std::move(properties), required);
}

json event_block_schema() {
  json properties = json::object();
  for (const AnalysisKey& key : event_block_keys()) properties[std::string(key.name)] = key_schema(key);
  return object_of(std::move(properties), {"count"});
}

json analysis_schema(const AnalysisDescription& type) {
  json properties = json::object();
  std::vector<std::string> required{"type"};
  for (const AnalysisKey& key : type.keys) {
    const bool is_type = key.name == "type";
    properties[std::string(key.name)] =
        is_type ? json{{"const", type.type}, {"description", type.summary}} : key_schema(key);
    if (key.required) required.emplace_back(key.name);
  }
  return object_of(std::move(properties), required);
}

json body_schema() {
  const json pair = reference("pair");
  const auto length = [&](std::string_view doc) { return described(pair, in_unit(doc, UnitKind::length)); };
  json rectangle = object_of({{"centre", length("centre")},
                              {"width", number("width", UnitKind::length, Domain::positive)},
                              {"height", number("height", UnitKind::length, Domain::positive)},
                              {"angle", number("angle", UnitKind::angle)}},
                             {"width", "height"});
  json disc = object_of(
      {{"centre", length("centre")}, {"radius", number("radius", UnitKind::length, Domain::positive)}}, {"radius"});
  json polygon{{"type", "array"}, {"items", pair}, {"minItems", 3}};
  json drawn = object_of({{"rectangle", rectangle},
                          {"disc", disc},
                          {"polygon", polygon},
                          {"line", {{"type", "array"}, {"items", pair}, {"minItems", 2}}}},
                         {});
  json part = object_of({{"mass", number("mass; negative for a hole", UnitKind::mass)},
                         {"centroid", length("its centroid")},
                         {"inertia", number("about its centroid", UnitKind::inertia)},
                         {"rectangle", std::move(rectangle)},
                         {"disc", std::move(disc)},
                         {"polygon", std::move(polygon)}},
                        {"mass"});
  json hold{
      {"type", "array"}, {"items", {{"enum", hold_columns}}}, {"description", "columns that assembly may not change"}};
  return object_of(
      {{"mass", number("mass", UnitKind::mass, Domain::not_negative)},
       {"inertia", number("about the centroid", UnitKind::inertia, Domain::not_negative)},
       {"position", length("place of its origin in the given configuration")},
       {"angle", number("angle in the given configuration", UnitKind::angle)},
       {"velocity", described(pair, in_unit("velocity of its origin at the start", UnitKind::velocity))},
       {"angular_velocity", number("angular velocity at the start", UnitKind::angular_velocity)},
       {"points", described(map_of(pair), "names and places in the body frame [m]")},
       {"centroid", length("its centroid in the body frame (default: the frame's origin)")},
       {"parts", described(list_of(std::move(part)), "masses and shapes it is made of")},
       {"rod", described(object_of({{"from", pair}, {"to", pair}}, {"from", "to"}),
                         "the ends of a rod in the ground frame [m], in place of position and angle")},
       {"fixed", {{"type", "boolean"}, {"description", "stays where it is given"}}},
       {"particle", {{"type", "boolean"}, {"description", "its angle stays as given, and it needs no inertia"}}},
       {"hold", std::move(hold)},
       {"draw", described(list_of(std::move(drawn)), "shapes that the body is drawn with, in its frame")}});
}

/// The lists of bodies and elements, which a scene and its blocks both have.
json sections() {
  return {{"bodies", described(map_of(reference("body")), "name -> body")},
          {"constraints", list_of(reference("constraint"))},
          {"drivers", list_of(reference("driver"))},
          {"forces", list_of(reference("force"))},
          {"replicate", list_of(reference("block"))}};
}

json definitions() {
  json constraints = json::array(), drivers = json::array(), forces = json::array(), analyses = json::array();
  for (const ElementDescription& type : element_descriptions()) {
    (type.force ? forces : constraints).push_back(element_schema(type, false));
    if (type.can_be_driven()) drivers.push_back(element_schema(type, true));
  }
  for (const AnalysisDescription& type : analysis_descriptions()) {
    analyses.push_back(analysis_schema(type));
  }
  json block = sections();
  block["count"] = described(reference("number"), "how often the block is repeated");
  block["first"] = described(reference("number"), "first value of k (default 1)");
  block["variable"] = {{"type", "string"}, {"description", "a name to use in place of k"}};
  json all = json::parse(fixed_definitions());
  all["positive"] = number_schema({{"exclusiveMinimum", 0}});
  all["notNegative"] = number_schema({{"minimum", 0}});
  all["body"] = body_schema();
  all["eventBlock"] = event_block_schema();
  all["constraint"] = {{"anyOf", std::move(constraints)}};
  all["driver"] = {{"anyOf", std::move(drivers)}};
  all["force"] = {{"anyOf", std::move(forces)}};
  all["block"] = object_of(std::move(block), {"count"});
  all["analysis"] = {{"anyOf", std::move(analyses)}};
  return all;
}

}  // namespace

std::string schema_json() {
  json properties{{"$schema", {{"type", "string"}}},
                  {"catena", {{"const", 1}, {"description", "version of the format"}}},
                  {"name", {{"type", "string"}}},
                  {"description", {{"type", "string"}}},
                  {"gravity", described(reference("pair"), "[gx, gy], default [0, 0] [m/s^2]")},
                  {"parameters", described(map_of(reference("parameter")), "name -> value")}};
  properties.update(sections());
  properties["analyses"] = described(list_of(reference("analysis")), "run in order by catena run");
  properties["outputs"] = described(reference("outputs"), "columns of results (default: x, y, angle of every body)");
  const json expression{{"type", "string"}, {"pattern", "^="}};
  properties["columns"] = described(
      map_of({{"anyOf", json::array({expression,
                                     object_of({{"value", expression}, {"unit", {{"type", "string"}}}}, {"value"})})}}),
      "name -> expression over columns, parameters and t");
  const json table = object_of({{"file", reference("fileName")},
                                {"columns", reference("fileColumns")},
                                {"unit", reference("fileUnit")},
                                {"smooth", reference("fileSmooth")},
                                {"x", reference("numbersOrFile")},
                                {"y", reference("numbersOrFile")},
                                {"points", reference("pairsOrFile")},
                                {"end", {{"enum", {"natural", "clamped", "periodic"}}}},
                                {"beyond", reference("beyond")}});
  properties["tables"] = described(map_of(table), "name -> spline, a function in expressions: \"=p(crank.angle)\"");
  json units = json::object();
  for (const std::string_view kind : OutputUnits::kinds) units[std::string(kind)] = {{"type", "string"}};
  properties["units"] =
      described(object_of(std::move(units), {}), "units of the table, of --csv and of files, in place of SI");
  json schema{{"$schema", "https://json-schema.org/draft/2020-12/schema"},
              {"title", "catena scene, version 1"},
              {"description", "Planar multibody systems: SI units, radians."}};
  schema.update(object_of(std::move(properties), {"catena"}));
  schema["$defs"] = definitions();
  return schema.dump(2) + "\n";
}

}  // namespace catena
