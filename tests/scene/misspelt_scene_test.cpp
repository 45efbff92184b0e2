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

/// The only error of a text with a mark must stand there and hold these words.
void expect_the_error(const std::string& text, const std::string& words) {
  const MarkedText marked = take_mark(text);
  const SceneOutcome outcome = run_text(marked.text).outcome;
  ASSERT_EQ(outcome.errors.size(), 1u) << text << outcome.error_text;
  EXPECT_NE(outcome.errors[0].message.find(words), std::string::npos) << outcome.error_text;
  EXPECT_EQ(outcome.errors[0].line, marked.line) << outcome.error_text;
  EXPECT_EQ(outcome.errors[0].column, marked.column) << outcome.error_text;
}

// A parameter that is given as a plain number is of the kind that the fields which name it ask for.
TEST(UnitsOfPlainParameters, AreThoseOfTheFieldsThatNameThem) {
  const auto scene = [](const std::string& analysis) {
    return R"({"catena": 1, "parameters": {"d": 0.1, "free": 1}, "bodies": {"a": {"mass": 1, "particle": true,
      "position": ["d", 0]}}, "analyses": [)" +
           analysis + "]}";
  };
  const std::string sweep = R"({"type": "sweep", "of": {"type": "assemble"}, "over": {"d": )";
  expect_the_error(scene(R"({"type": "check", "set": {"d": §"3 kg"}})"), "must be a length");
  expect_the_error(scene(sweep + R"([0.1, §"3 kg"]}})"), "must be a length");
  expect_the_error(scene(sweep + R"({"from": "1 mm", "to": §"3 deg", "count": 2}}})"), "must be a length");
  for (const char* fine : {R"({"type": "check", "set": {"d": "3 mm", "free": "3 kg"}})", R"({"type": "check"})"})
    EXPECT_EQ(run_text(scene(fine)).outcome.exit_code, 0) << fine;
}

TEST(Measures, NameTheKindThatThereIsNone) {
  expect_the_error(R"({"catena": 1, "bodies": {"a": {"mass": 1, "particle": true, "fixed": true}}, "analyses": [
    {"type": "check", "measures": {"x": §{"maximum": "a.x"}}}]})",
                   "path, field; \"maximum\" is none");
}

// What has an error already is no shorter curve besides.
TEST(CurvesOfSprings, ThatCannotBeReadHaveOneError) {
  const std::string spring = R"({"catena": 1, "bodies": {"a": {"mass": 1, "particle": true, "position": [1, 0]}},
    "forces": [{"type": "spring_damper", "i": "ground", "j": "a", "curve": )";
  expect_the_error(spring + R"(§5}], "analyses": [{"type": "check"}]})", "must be a list of pairs");
  expect_the_error(spring + R"({"file": §"lost.csv"}}], "analyses": [{"type": "check"}]})", "lost.csv");
  expect_the_error(spring + R"(§[]}], "analyses": [{"type": "check"}]})", "needs at least 2 points");
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
