#include "catena/scene/reading/scene_reader.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "catena/scene/numbers/name_rules.hpp"
#include "catena/scene/reading/own_column_reader.hpp"
#include "catena/scene/reading/scene_reading.hpp"

namespace catena {
namespace {

constexpr int deepest_block = 8;

bool is_section(std::string_view key) {
  return key == "bodies" || key == "constraints" || key == "drivers" || key == "forces" || key == "replicate";
}

void read_version(const JsonValue& root, const JsonValue& value, Diagnostics& diagnostics) {
  if (!value) {
    report(root, "a scene needs its format version: \"catena\": 1", diagnostics);
  } else if (!value.is(JsonKind::number) || value.number() != 1) {
    const std::string given =
        value.is(JsonKind::number) ? fmt::format("version {}", value.number()) : std::string(describe(value.kind()));
    report(value, fmt::format("\"catena\" is the format version, which must be 1; this is {}", given), diagnostics);
  }
}

}  // namespace

void SceneReading::section(std::string_view key, const JsonValue& value, BlockTemplate& block, int depth) {
  using Section = BlockTemplate::Section;
  if (key == "bodies") {
    if (!value.is(JsonKind::object)) {
      error(value, fmt::format("\"bodies\" must be an object of names and bodies; this is {}", describe(value.kind())));
      return;
    }
    const auto first = static_cast<std::uint32_t>(block.bodies.size());
    block.bodies.reserve(first + value.size());
    for (const JsonMember body_member : value.members()) body(body_member, block);
    block.sections.push_back({Section::Kind::bodies, first, static_cast<std::uint32_t>(block.bodies.size())});
    return;
  }
  if (!value.is(JsonKind::array)) {
    error(value, fmt::format("{} must be a list [...]; this is {}", in_quotes(key), describe(value.kind())));
    return;
  }
  if (key == "replicate") {
    const auto first = static_cast<std::uint32_t>(block.blocks.size());
    for (const JsonValue& object : value.elements()) this->block(object, block, depth + 1);
    block.sections.push_back({Section::Kind::blocks, first, static_cast<std::uint32_t>(block.blocks.size())});
    return;
  }
  const auto first = static_cast<std::uint32_t>(block.elements.size());
  block.elements.reserve(first + value.size());
  for (const JsonValue& object : value.elements()) element(object, key, block);
  block.sections.push_back({Section::Kind::elements, first, static_cast<std::uint32_t>(block.elements.size())});
}

void SceneReading::block(const JsonValue& object, BlockTemplate& parent, int depth) {
  std::array<JsonValue, block_keys.size()> v;
  if (depth > deepest_block) {
    error(object, "replicate blocks are nested too deeply");
    return;
  }
  if (!read_members(object, block_keys, "a replicate block", v, diagnostics)) return;
  BlockTemplate block;
  block.offset = static_cast<std::uint32_t>(object.offset());
  // A block's count may depend on the variables of the blocks around it, not on its own.
  if (v[0]) {
    block.count = numbers.read(v[0], UnitKind::none, {"count", "a replicate block"});
  } else {
    error(object, "a replicate block needs \"count\"");
  }
  block.first = v[1] ? numbers.read(v[1], UnitKind::none, {"first", "a replicate block"})
                     : NumberValue::constant(1, object.offset());
  block.variable = block_variable;
  if (v[2]) {
    block.variable = read_string(v[2], {"variable", "a replicate block"}, diagnostics);
    if (const std::string problem = parameter_name_problem(block.variable); !problem.empty()) error(v[2], problem);
  }
  numbers.enter_block(block.variable);
  for (const JsonMember member : object.members()) {
    if (is_section(member.name())) section(member.name(), member.value, block, depth);
  }
  numbers.leave_block();
  parent.blocks.push_back(std::move(block));
}

namespace {

/// Units in which results are shown.
void read_units(const JsonValue& object, SceneTemplate& scene, Diagnostics& diagnostics) {
  if (!object.is(JsonKind::object)) {
    report(object,
           fmt::format("\"units\" must be an object of kinds and units, as {{\"angle\": \"deg\"}}; this is {}",
                       describe(object.kind())),
           diagnostics);
    return;
  }
  for (const JsonMember member : object.members()) {
    const std::string_view unit = read_string(member.value, {member.name(), "\"units\""}, diagnostics);
    if (!member.value.is(JsonKind::string)) continue;
    if (const auto problem = OutputUnits::problem(member.name(), unit)) {
      const bool unknown =
          std::find(OutputUnits::kinds.begin(), OutputUnits::kinds.end(), member.name()) == OutputUnits::kinds.end();
      report(unknown ? member.key : member.value, *problem, diagnostics);
    } else {
      scene.units.emplace_back(member.name(), unit);
    }
  }
}

/// The names of the tables; expressions may use them wherever they stand.
std::vector<std::string> table_names(const JsonValue& object, const JsonValue& parameters, Diagnostics& diagnostics) {
  std::vector<std::string> names;
  if (object && !object.is(JsonKind::object)) {
    report(object, fmt::format("\"tables\" must be an object of names and tables; this is {}", describe(object.kind())),
           diagnostics);
  }
  if (!object || !object.is(JsonKind::object)) return names;
  for (const JsonMember member : object.members()) {
    std::string problem = parameter_name_problem(member.name());
    if (problem.empty() && parameters && parameters.is(JsonKind::object) && parameters.find(member.name()))
      problem = fmt::format("a parameter is called {} already; choose another name", in_quotes(member.name()));
    if (!problem.empty()) report(member.key, problem, diagnostics);
    names.emplace_back(member.name());
  }
  return names;
}

}  // namespace

std::unique_ptr<SceneTemplate> read_scene(SourceText source, Diagnostics& diagnostics) {
  auto scene = std::make_unique<SceneTemplate>();
  scene->source = std::make_unique<SourceText>(std::move(source));
  std::optional<JsonDocument> document = JsonDocument::parse(*scene->source, diagnostics);
  if (!document) return nullptr;
  scene->document = std::make_unique<JsonDocument>(std::move(*document));
  const JsonValue root = scene->document->root();
  std::array<JsonValue, scene_keys.size()> v;
  if (!read_members(root, scene_keys, "the scene", v, diagnostics, Misspelt::as_meant)) return nullptr;
  for (const JsonMember member : root.members())
    scene->may_lack_parts = scene->may_lack_parts || meant_key(root, member, scene_keys).empty();
  read_version(root, v[0], diagnostics);
  if (v[1]) scene->name = read_string(v[1], {"name"}, diagnostics);
  if (v[2]) scene->description = read_string(v[2], {"description"}, diagnostics);
  const std::vector<std::string> tables = table_names(v[15], v[4], diagnostics);
  scene->parameters = ParameterTable::read(v[4], scene->expressions, diagnostics, tables);
  scene->analyses = v[10];
  scene->outputs = v[11];

  if (v[13]) read_own_columns(v[13], *scene, diagnostics);
  if (v[14]) read_units(v[14], *scene, diagnostics);
  SceneReading reading(*scene, diagnostics);
  if (!tables.empty()) reading.table_functions(v[15], tables);
  scene->gravity[0] = scene->gravity[1] = NumberValue::constant(0);
  if (v[3]) {
    const auto gravity = reading.numbers.read_pair(v[3], dimension_of(UnitKind::acceleration), {"gravity"});
    scene->gravity[0] = gravity[0];
    scene->gravity[1] = gravity[1];
  }
  scene->root.count = NumberValue::constant(1);
  scene->root.first = NumberValue::constant(1);
  for (const JsonMember member : root.members()) {
    const std::string_view key = meant_key(root, member, scene_keys);
    if (is_section(key)) reading.section(key, member.value, scene->root, 0);
  }
  return scene;
}

}  // namespace catena
