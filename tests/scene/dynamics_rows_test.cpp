// Rows of dynamics: at which instants there are any, and what is in them where something happened before.
#include <gtest/gtest.h>

#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

std::string spinning(const std::string& at) {
  return R"({"catena": 1, "bodies": {"b": {"mass": 1, "inertia": 2}},
    "forces": [{"type": "torque", "i": "b", "torque": 3}],
    "analyses": [{"type": "dynamics", "at": )" +
         at + R"(, "outputs": ["b.omega"]}]})";
}

TEST(DynamicsRows, InstantsAreListedInTheOrderOfTime) {
  const TextRun right = run_text(spinning("[0.5, 0.5, 1, 3]"));
  ASSERT_EQ(right.outcome.exit_code, 0) << right.outcome.error_text;
  EXPECT_EQ(right.column("t"), (std::vector<double>{0.5, 0.5, 1, 3}));
  EXPECT_NEAR(right.last("b.omega"), 4.5, 1e-12);

  const TextRun wrong = run_text(spinning("[0.5, 3, 1]"));
  EXPECT_EQ(wrong.outcome.exit_code, 1);
  EXPECT_EQ(wrong.analysis().report.status, Status::refused);
  EXPECT_NE(wrong.analysis().report.message.find("\"at\" must list its instants in the order of time"),
            std::string::npos)
      << wrong.analysis().report.message;
  EXPECT_NE(wrong.analysis().report.message.find("1 s comes after 3 s"), std::string::npos);

  const TextRun before = run_text(spinning("[-1, 1]"));
  EXPECT_EQ(before.outcome.exit_code, 1);
  EXPECT_NE(before.analysis().report.message.find("asked for at t = -1 s, but the motion starts at 0 s"),
            std::string::npos)
      << before.analysis().report.message;
}

// x = 2 t^2: the driver pushes 2 kg with 8 N until t = 1.5 s, 4.5 m: 36 J. Released, it does no more work.
TEST(DynamicsRows, TheWorkOfAReleasedDriverStaysWhatItWas) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"b": {"mass": 2, "inertia": 1}},
    "constraints": [{"type": "absolute_y", "i": "b", "value": 0}, {"type": "absolute_angle", "i": "b", "value": 0}],
    "drivers": [{"type": "absolute_x", "name": "D", "i": "b", "value": {"polynomial": [0, 0, 2]}}],
    "analyses": [{"type": "dynamics", "until": 3, "every": 0.5, "tolerance": 1e-11,
      "outputs": ["D.work", "D.power", "energy.balance"],
      "events": [{"when": "t", "value": 1.5, "action": "release", "element": "D"}]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  const std::vector<double> t = run.column("t"), work = run.column("D.work"), balance = run.column("energy.balance");
  ASSERT_EQ(t.size(), 7u);
  for (std::size_t k = 0; k < t.size(); ++k) {
    EXPECT_NEAR(work[k], t[k] < 1.5 ? 16 * t[k] * t[k] : 36, 1e-9) << t[k];
    EXPECT_NEAR(balance[k], 0, 1e-9) << t[k];
  }
  EXPECT_EQ(run.last("D.power"), 0);
}

}  // namespace
}  // namespace catena::testing
