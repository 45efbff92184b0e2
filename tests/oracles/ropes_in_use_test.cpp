// Ropes over pulleys in what scenes do with them: derivatives of motions, drivers that wind them up, laws that read
// them.
#include <gtest/gtest.h>

#include <string>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

// Derivatives of a motion by a mass, a radius and a place against differences; an elastic rope is a force.
TEST(Ropes, Derivatives) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "parameters": {"m": 2, "r": 0.2, "x": 0.3},
      "bodies": {"a": {"particle": true, "mass": "=m", "position": [-0.5, -1]},
                 "b": {"particle": true, "mass": 1.5, "position": ["=0.4+x", -1.2]}},
      "forces": [{"type": "rope", "name": "rope", "i": "a", "over": [{"at": ["ground", ["=x-0.3", 0]], "radius": "=r"}],
        "j": "b", "k": 300}],
      "analyses": [{"type": "sensitivity", "of": {"type": "dynamics", "until": 0.4, "every": 0.2, "tolerance": 1e-10,
        "outputs": ["a.x", "b.y", "rope.force", "rope.length", "energy.total"]}, "parameters": ["m", "r", "x"],
        "verify": true}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_LT(field<double>(run, "deviation"), 1e-5);
}

// A body that winds the rope up over a circle, more than a whole turn: m.y = -2 + 0.1 t.
TEST(Ropes, WoundFurtherThanATurn) {
  for (const char* stiffness : {"", R"(, "k": 1e5)"}) {
    const TextRun run = run_text(std::string(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
      "m": {"mass": 1, "particle": true, "position": [-0.1, -2]}, "b": {"mass": 1, "inertia": 1, "points": {"p": [1, 0]}}},
      "constraints": [{"type": "revolute", "i": "ground", "j": "b"}],
      "drivers": [{"type": "absolute_angle", "i": "b", "value": {"polynomial": [0, -1]}}],
      "forces": [{"type": "rope", "name": "A", "i": "b.p",
                  "over": [{"at": ["ground", [0, 0]], "radius": 0.1, "side": 1}], "j": "m")") +
                                 stiffness + R"(}], "outputs": ["m.y"],
      "analyses": [{"type": "dynamics", "until": 8, "every": 0.25}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
    EXPECT_NEAR(run.last("m.y"), -2 + 0.1 * 8, *stiffness ? 1e-3 : 1e-9);
  }
}

TEST(Ropes, ElasticOnesAreNoInputOfLaws) {
  const auto with = [](const std::string& force, const std::string& analysis) {
    return run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
      "a": {"mass": 3, "particle": true, "position": [-0.1, -1]}, "b": {"mass": 2, "particle": true, "position": [0.1, -1]}},
      "forces": [{"type": "rope", "name": "A", "i": "a", "over": [{"at": ["ground", [0, 0]], "radius": 0.1}], "j": "b",
                  "k": 500}, {"type": "point_force", "name": "F", "i": "a", "force": [0, )" +
                    force + R"(]}], "analyses": [)" + analysis + "]}");
  };
  const TextRun law = with(R"("=-A.force")", R"({"type": "dynamics", "until": 0.5})");
  EXPECT_EQ(law.outcome.exit_code, 3);
  EXPECT_NE(law.outcome.error_text.find("a force cannot read A.force"), std::string::npos) << law.outcome.error_text;
}

}  // namespace
}  // namespace catena::testing
