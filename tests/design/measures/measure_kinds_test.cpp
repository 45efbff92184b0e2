// Every kind of measure in every analysis that takes measures: a value, or null with a reason, or an error that names
// it; the same for every derivative. Never silence.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "design/measured.hpp"

namespace catena::testing {
namespace {

/// A rod on a pin and a torsion spring under a load from above and from the side, driven where the analysis asks for
/// it.
std::string scene_of(const std::string& analysis, bool driven) {
  return std::string(R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"P": 0.5, "k": 9},
  "bodies": {"rod": {"rod": {"from": [0, 0], "to": [0, 0.8]}, "mass": 0.1}},
  "constraints": [{"type": "revolute", "name": "pin", "i": "ground", "j": "rod.from"}],)") +
         (driven ? R"("drivers": [{"type": "relative_angle", "name": "drive", "i": "ground", "j": "rod",
                      "value": {"polynomial": [1.6, "=k/10"]}}],)"
                 : "") +
         R"("forces": [{"type": "torsion_spring", "i": "ground", "j": "rod", "k": "k"},
             {"type": "point_force", "i": "rod.to", "force": ["P", "=-P"]}],
  "outputs": ["rod.angle"], "analyses": [)" +
         analysis + "]}";
}

struct Kind {
  const char *name, *text;
};
const Kind kinds[] = {{"max", R"({"max": "rod.angle"})"},
                      {"min", R"({"min": "rod.angle"})"},
                      {"range", R"({"range": "rod.angle"})"},
                      {"first", R"({"first": "rod.angle"})"},
                      {"final", R"({"final": "rod.angle"})"},
                      {"mean", R"({"mean": "rod.angle"})"},
                      {"rms", R"({"rms": "rod.angle"})"},
                      {"integral", R"({"integral": "rod.angle"})"},
                      {"at", R"({"at": 0.1, "of": "rod.angle"})"},
                      {"path", R"({"path": ["rod.to.x", "rod.to.y"], "to": [[0.1, 0.8], [0.2, 0.7]]})"},
                      {"known field", R"({"field": "FIELD"})"},
                      {"unknown field", R"({"field": "energy_of_nothing"})"},
                      {"unknown entry", R"({"field": "events[7].t"})"}};

struct Analysis {
  const char *name, *text, *field;
};
const Analysis analyses[] = {
    {"kinematics", R"("type": "kinematics", "until": 0.3, "every": 0.1)", "events[1].t"},
    {"inverse_dynamics", R"("type": "inverse_dynamics", "until": 0.3, "every": 0.1)", "events[1].t"},
    {"dynamics", R"("type": "dynamics", "until": 0.3, "every": 0.1)", "events[1].t"},
    {"equilibrium", R"("type": "equilibrium")", "energy"},
    {"path", R"("type": "path", "parameter": "P", "to": 1)", "steps"},
    {"modes", R"("type": "modes")", "omega2[1]"},
    {"buckling", R"("type": "buckling", "parameter": "P")", "loads[1]"}};

class MeasureKinds : public ::testing::TestWithParam<Analysis> {};

TEST_P(MeasureKinds, GiveAValueOrAReason) {
  const Analysis& analysis = GetParam();
  const std::string name = analysis.name;
  const bool driven = name == "kinematics" || name == "inverse_dynamics", timed = driven || name == "dynamics";
  for (const Kind& kind : kinds) {
    for (const bool differentiated : {false, true}) {
      SCOPED_TRACE(fmt::format("{} in {}, derivatives {}", kind.name, name, differentiated));
      std::string text = kind.text;
      if (const std::size_t place = text.find("FIELD"); place != std::string::npos)
        text.replace(place, 5, analysis.field);
      const std::string events = timed ? R"(, "events": [{"name": "mark", "when": "t", "value": 0.15}])" : "";
      const std::string inner = fmt::format(R"({{{}{}, "measures": {{"m": {}}}}})", analysis.text, events, text);
      const TextRun run = run_text(scene_of(
          differentiated ? R"({"type": "sensitivity", "parameters": ["k"], "of": )" + inner + "}" : inner, driven));
      if (run.outcome.analyses.empty()) {
        // An error of the text says which of its words is wrong.
        EXPECT_NE(run.outcome.error_text.find("scene.json:"), std::string::npos) << run.outcome.error_text;
        continue;
      }
      const AnalysisResult& result = run.analysis();
      const bool named = warns(run, "measure \"m\"") || result.report.message.find("\"m\"") != std::string::npos;
      if (result.measures.empty()) {
        EXPECT_TRUE(named) << result.report.message;
        continue;
      }
      ASSERT_EQ(result.measures.size(), 1u);
      const MeasureResult& m = result.measures.front();
      if (std::string(kind.name) == "known field") {
        EXPECT_TRUE(m.value.has_value());
      }
      if (!m.value) {
        EXPECT_TRUE(named) << result.report.message;
      }
      if (!differentiated || !result.report.ok()) continue;
      ASSERT_EQ(m.gradient.size(), 1u);
      if (!std::isfinite(m.gradient.front())) {
        EXPECT_TRUE(named) << result.report.message;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Analyses, MeasureKinds, ::testing::ValuesIn(analyses),
                         [](const auto& one) { return std::string(one.param.name); });

}  // namespace
}  // namespace catena::testing
