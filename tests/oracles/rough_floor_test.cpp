// Rods that fall on a rough floor with any slip and spin, against rough_floor.hpp: bounces, slides, ends of slides,
// slips that reverse, and ends that leave. In all of them friction and what presses depend on each other strongly.
#include "oracles/rough_floor.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include "oracles/random_seeds.hpp"
#include "scene/run_text.hpp"
#include "stress/cases.hpp"

namespace catena::testing {
namespace {

std::string rod_text(const RodOnRoughFloor::Problem& p, double until) {
  const auto contact = [&](const char* end) {
    return fmt::format(
        R"({{"type": "contact", "i": "ground", "j": "rod.{}", "mu": {:.17g}, "mu_static": {:.17g},
 "restitution": {:.17g}, "rest_speed": {:.17g}, "curve": {{"line": {{"point": [0, 0], "axis": [1, 0]}}}}}})",
        end, p.mu, p.mu_static, p.restitution, p.rest_speed);
  };
  return fmt::format(
      R"({{"catena": 1, "gravity": [0, -9.81], "bodies": {{"rod": {{"mass": 1, "inertia": "=1/3",
 "position": [{:.17g}, {:.17g}], "angle": {:.17g}, "velocity": [{:.17g}, {:.17g}], "angular_velocity": {:.17g},
 "points": {{"a": [-1, 0], "b": [1, 0]}}}}}}, "forces": [{}, {}],
 "outputs": ["rod.x", "rod.y", "rod.angle", "rod.vx", "rod.vy", "rod.omega"],
 "analyses": [{{"type": "dynamics", "at": [{:.17g}], "tolerance": 1e-10}}]}})",
      p.start[0], p.start[1], p.start[2], p.start[3], p.start[4], p.start[5], contact("a"), contact("b"), until);
}

std::string rod_fault(unsigned seed) {
  const RodOnRoughFloor::Problem problem = RodOnRoughFloor::random(seed);
  const double end = RodOnRoughFloor(problem).run(problem.until);
  // Before the instant at which it gives up.
  const double until = end < problem.until - 1e-12 ? 0.98 * end - 1e-3 : end;
  if (until < 1e-3) return {};
  RodOnRoughFloor exact(problem);
  exact.run(until);
  const TextRun run = run_text(rod_text(problem, until));
  if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
  const char* columns[] = {"rod.x", "rod.y", "rod.angle", "rod.vx", "rod.vy", "rod.omega"};
  for (std::size_t k = 0; k < 6; ++k) {
    const double off = run.column(columns[k]).back() - exact.state()[k];
    // Ten times the tolerance, and ten times more at each change of rates of some 10 1/s.
    if (!(std::abs(off) <= (k < 3 ? 1e-8 : 1e-7))) return fmt::format("{} is off by {:.2g}", columns[k], off);
  }
  return {};
}

TEST(RodsOnARoughFloor, Random) {
  int changes = 0, other_laws = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    RodOnRoughFloor rod(RodOnRoughFloor::random(seed));
    rod.run(RodOnRoughFloor::random(seed).until);
    changes += rod.changes();
    other_laws += rod.other_laws();
  }
  EXPECT_GT(changes, 60) << "the oracle sees too little";
  EXPECT_GT(other_laws, 3) << "energy would never grow";
  expect_no_fault(first_case(), last_case(60), rod_fault);
}

// Friction of most of what presses, far from wedging: its equations are solved to their rounding, not beyond.
TEST(RodsOnARoughFloor, SlidesAgainstTheFallAreNotRefused) {
  const TextRun run = run_text(
      R"json({"catena": 1, "gravity": [0, -9.81], "bodies": {"rod": {"mass": 1, "inertia": "=1/3",
 "position": ["=cos(1.9)", "=sin(1.9)"], "angle": 1.9, "velocity": ["=-3-0.2*sin(1.9)", "=0.2*cos(1.9)"],
 "angular_velocity": 0.2, "points": {"tip": [-1, 0]}}}, "forces": [{"type": "contact", "i": "ground", "j": "rod.tip",
 "mu": 2, "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}], "outputs": ["rod.tip.vx"],
 "analyses": [{"type": "dynamics", "until": 0.7, "every": 0.01}]})json");
  EXPECT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
  EXPECT_NEAR(run.column("rod.tip.vx").back(), 0, 1e-12);
}

}  // namespace
}  // namespace catena::testing
