// What explain and the schema say: complete, and true.
#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "catena/scene/building/build_model.hpp"
#include "catena/scene/explaining/example.hpp"
#include "catena/scene/reading/scene_reader.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

using nlohmann::json;

TEST(Explain, KnowsEveryNameItListsAndNoOther) {
  const std::vector<std::string> names = explained_names();
  EXPECT_GT(names.size(), 40u);
  for (const std::string& name : names) {
    const std::optional<std::string> text = explain(name);
    ASSERT_TRUE(text) << name;
    EXPECT_TRUE(text->ends_with("\n")) << name;
  }
  EXPECT_FALSE(explain("revolut"));
  EXPECT_FALSE(explain(""));
}

TEST(Explain, SaysEquationFieldsUnitsColumnsAndAnExample) {
  for (const ElementDescription& type : element_descriptions()) {
    const std::string text = explain(type.type).value_or("");
    EXPECT_NE(text.find(type.equation), std::string::npos) << type.type;
    for (const FieldDescription& field : type.fields) {
      EXPECT_NE(text.find(field.doc), std::string::npos) << type.type << " " << field.key;
    }
    EXPECT_NE(text.find(example_of(type)), std::string::npos) << type.type;
    if (!type.force) {
      EXPECT_NE(text.find("A.lambda1 ["), std::string::npos) << text;
    }
  }
  EXPECT_NE(explain("spring_damper").value_or("").find("N s/m"), std::string::npos);
  // Of the friction itself, which stands behind its joint.
  EXPECT_NE(explain("friction").value_or("").find("A.friction ["), std::string::npos);
}

TEST(Explain, EveryExampleOfAnElementIsASoundScene) {
  for (const ElementDescription& type : element_descriptions()) {
    Diagnostics diagnostics;
    const auto scene = read_scene(SourceText("example", example_scene(type)), diagnostics);
    ASSERT_TRUE(scene) << type.type;
    const Model model = build_model<double>(*scene, std::span<const double>(), {}, diagnostics);
    EXPECT_TRUE(diagnostics.ok()) << diagnostics.text();
    // Friction stands behind the joint in which it acts; further stretches of a rope are elements too, behind it.
    const int own = type.find("joint") ? 1 : 0;
    ASSERT_GT(static_cast<int>(model.elements.size()), own) << type.type;
    EXPECT_EQ(model.element_type(own), type.type);
    if (!type.find("over")) {
      EXPECT_EQ(static_cast<int>(model.elements.size()), own + 1) << type.type;
    }
  }
}

TEST(Explain, EveryExampleOfAnAnalysisIsASoundOne) {
  for (const AnalysisDescription& type : analysis_descriptions()) {
    EXPECT_NE(explain(type.type).value_or("").find(example_of(type)), std::string::npos) << type.type;
    Diagnostics diagnostics;
    const std::string text = R"({"catena": 1, "parameters": {"P": 2}, "bodies": {"rod": {"points": {"from": [0, 0]}}},
      "analyses": [)" + example_of(type) +
                             "]}";
    EXPECT_TRUE(read_scene(SourceText("example", text), diagnostics)) << type.type;
    EXPECT_TRUE(diagnostics.ok()) << diagnostics.text();
  }
}

TEST(Schema, IsTheFileInData) {
  std::ifstream in(CATENA_DATA_DIR "/schema/catena-1.schema.json", std::ios::binary);
  const std::string file{std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
  EXPECT_EQ(file, schema_json()) << "made anew by: catena schema > data/schema/catena-1.schema.json";
}

TEST(Schema, RefersToDefinitionsThatExist) {
  const json schema = json::parse(schema_json());
  const std::string prefix = "#/$defs/";
  int references = 0;
  const auto visit = [&](const auto& self, const json& node) -> void {
    if (node.is_object() && node.contains("$ref") && node["$ref"].is_string()) {
      const std::string target = node["$ref"];
      ++references;
      EXPECT_TRUE(target.starts_with(prefix) && schema["$defs"].contains(target.substr(prefix.size()))) << target;
    }
    if (node.is_structured()) {
      for (const json& child : node) self(self, child);
    }
  };
  visit(visit, schema);
  EXPECT_GT(references, 100);
}

TEST(Schema, HasEveryElementWithEveryField) {
  const json schema = json::parse(schema_json());
  for (const ElementDescription& type : element_descriptions()) {
    const json& list = schema["$defs"][type.force ? "force" : "constraint"]["anyOf"];
    const auto found = std::find_if(
        list.begin(), list.end(), [&](const json& entry) { return entry["properties"]["type"]["const"] == type.type; });
    ASSERT_NE(found, list.end()) << type.type;
    for (const FieldDescription& field : type.fields) {
      EXPECT_EQ((*found)["properties"].contains(field.key), !field.reserved()) << type.type << " " << field.key;
    }
  }
}

}  // namespace
}  // namespace catena::testing
