// A scissor lift of a hundred thousand bodies: its far end feels the rounding of every stage, its cost a body is that
// of a short one.
#include <gtest/gtest.h>

#include <cmath>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

std::string scissor(int stages) {
  const std::string top = "up" + std::to_string(stages - 1);
  return R"json({"catena": 1, "parameters": {"c": "=cos(0.4)", "s": "=sin(0.4)", "stages": )json" +
         std::to_string(stages) + R"json(},
      "replicate": [
        {"count": "stages", "first": 0,
         "bodies": {"up{k}": {"rod": {"from": [0, "=k*s"], "to": ["c", "=(k+1)*s"]}},
                    "down{k}": {"rod": {"from": [0, "=(k+1)*s"], "to": ["c", "=k*s"]}}},
         "constraints": [{"type": "revolute", "name": "middle{k}", "i": "up{k}", "j": "down{k}"}]},
        {"count": "=stages - 1", "first": 0,
         "constraints": [{"type": "revolute", "name": "right{k}", "i": "up{k}.to", "j": "down{k+1}.to"},
                         {"type": "revolute", "name": "left{k}", "i": "down{k}.from", "j": "up{k+1}.from"}]}],
      "constraints": [{"type": "revolute", "name": "foot", "i": "ground", "j": "up0.from"},
                      {"type": "absolute_y", "name": "floor", "i": "down0.to", "value": 0}],
      "drivers": [{"type": "absolute_angle", "name": "drive", "i": "up0",
                   "value": {"harmonic": {"amplitude": 0.3, "omega": 1.5, "offset": 0.4}}}],
      "analyses": [{"type": "kinematics", "until": 0.05, "every": 0.005}],
      "outputs": [")json" +
         top + ".to.y\", \"" + top + ".to.vy\", \"" + top + ".to.ay\"]}";
}

TEST(LongScissor, StepsLikeAShortOne) {
  std::int64_t factorizations = 0, steps = 0;
  for (const int stages : {500, 50000}) {
    const TextRun run = run_text(scissor(stages));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    const auto& rows = run.sink.rows.at(0);
    ASSERT_EQ(rows.rows(), 11u);
    for (std::size_t k = 0; k < rows.rows(); ++k) {
      const double t = rows.at(k, 0), angle = 0.4 + 0.3 * std::sin(1.5 * t), rate = 0.45 * std::cos(1.5 * t);
      const double second = -0.675 * std::sin(1.5 * t);
      EXPECT_NEAR(rows.at(k, 1) / stages, std::sin(angle), 1e-11) << t;
      EXPECT_NEAR(rows.at(k, 2) / stages, std::cos(angle) * rate, 1e-10) << t;
      EXPECT_NEAR(rows.at(k, 3) / stages, std::cos(angle) * second - std::sin(angle) * rate * rate, 1e-9) << t;
    }
    const Counters& counters = run.analysis().report.counters;
    if (stages == 500) {
      factorizations = counters.factorizations;
      steps = counters.steps;
    } else {
      EXPECT_LE(counters.factorizations, factorizations + 3);
      EXPECT_LE(counters.steps, steps);
    }
  }
}

}  // namespace
}  // namespace catena::testing
