// Misspelt keys of the scene itself: told first, with what was meant, and nothing that only follows from them; and what
// explain and the schema offer.
#include <gtest/gtest.h>

#include "results/temporary_folder.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

const std::string good = R"({
  "catena": 1, "gravity": [0, -9.81],
  "parameters": {"l": 1},
  "bodies": {"a": {"mass": 1, "inertia": 1, "points": {"p": ["l", 0]}}, "b": {"mass": 1, "inertia": 1}},
  "constraints": [{"type": "revolute", "name": "A", "i": "ground", "j": "a"},
                  {"type": "revolute", "name": "B", "i": "a.p", "j": "b"}],
  "drivers": [{"type": "relative_angle", "name": "d", "i": "a", "j": "b", "value": {"polynomial": [0, 1]}}],
  "forces": [{"type": "torque", "name": "T", "i": "a", "torque": 1}],
  "outputs": ["a.angle", "d.load", "T.torque"],
  "analyses": [{"type": "check"}]
})";

TEST(MisspeltKeys, OfTheSceneAreToldAlone) {
  ASSERT_LT(run_text(good).outcome.exit_code, 2) << run_text(good).outcome.error_text;
  const std::pair<const char*, const char*> misspelt[] = {
      {"catena", "catenna"}, {"gravity", "gravty"},         {"parameters", "paramters"}, {"bodies", "bodis"},
      {"bodies", "Bodies"},  {"constraints", "constrains"}, {"drivers", "driver"},       {"forces", "froces"},
      {"outputs", "output"}, {"analyses", "analysis"}};
  for (const auto& [key, word] : misspelt) {
    std::string text = good;
    text.replace(text.find("\"" + std::string(key) + "\"") + 1, std::string(key).size(), word);
    const SceneOutcome outcome = run_text(text).outcome;
    EXPECT_EQ(outcome.exit_code, 3);
    ASSERT_EQ(outcome.errors.size(), 1u) << outcome.error_text;
    EXPECT_EQ(outcome.errors[0].message,
              "unknown key \"" + std::string(word) + "\" in the scene; did you mean \"" + key + "\"?");
  }
}

TEST(MisspeltKeys, ComeBeforeOtherErrors) {
  std::string text = good;
  text.replace(text.find("[0, -9.81]"), 10, "7");
  text.replace(text.find("\"forces\""), 8, "\"forcs\"");
  const SceneOutcome outcome = run_text(text).outcome;
  ASSERT_EQ(outcome.errors.size(), 2u) << outcome.error_text;
  EXPECT_NE(outcome.errors[0].message.find("did you mean \"forces\"?"), std::string::npos);
  EXPECT_LT(outcome.error_text.find("forcs"), outcome.error_text.find("gravity"));
}

// What such a part has in it is not known: names that are missing may be there.
TEST(MisspeltKeys, ThatAreNearToNothingHideUnknownNames) {
  std::string text = good;
  text.replace(text.find("\"bodies\""), 8, "\"things\"");
  const SceneOutcome outcome = run_text(text).outcome;
  ASSERT_EQ(outcome.errors.size(), 1u) << outcome.error_text;
  EXPECT_NE(outcome.errors[0].message.find("\"things\""), std::string::npos);
}

TEST(Offers, AreWhatIsBuilt) {
  const std::string schema = schema_json();
  EXPECT_EQ(schema.find("for dynamics; equilibrium needs none"), std::string::npos);
  for (const char* built : {"\"rope\"", "\"sweep\"", "\"optimise\"", "\"sensitivity\"", "\"friction\""}) {
    EXPECT_NE(schema.find(built), std::string::npos) << built;
  }
  for (const std::string& name : explained_names()) {
    EXPECT_TRUE(explain(name)) << name;
  }
  for (const char* element : {"contact", "stop"}) {
    const std::string text = explain(element).value_or("");
    EXPECT_NE(text.find("  k "), std::string::npos) << text;
    EXPECT_NE(text.find("restitution"), std::string::npos) << text;
  }
  EXPECT_NE(explain("spline")->find("beyond"), std::string::npos);
  EXPECT_NE(explain("spring_damper")->find("beyond"), std::string::npos);
}

}  // namespace
}  // namespace catena::testing
