// Equilibria beyond one minimum of an energy: several in one scene, forces that follow their body, the choice of the
// solver.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "catena/analysis/statics/solvers/static_ipopt.hpp"
#include "catena/analysis/statics/solvers/static_nlopt.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

// The inverted bar on a torsion spring of 1 N m/rad, m g l = 2 N m: upright unstable, tilted by theta stable.
std::string inverted_bar(const std::string& keys) {
  return R"({"catena": 1, "gravity": [0, -10], "bodies": {"bar": {"mass": 0.2, "inertia": 0, "position": [0, 1]}},
    "constraints": [{"type": "revolute", "i": "ground", "j": ["bar", [0, -1]]}],
    "forces": [{"type": "torsion_spring", "i": "ground", "j": "bar", "k": 1, "angle": 0}],
    "analyses": [{"type": "equilibrium", )" +
         keys + R"(}], "outputs": ["bar.angle"]})";
}
constexpr double tilt = 1.89549426703398;

TEST(SeveralEquilibria, BothBranchesOfThePitchforkAndTheUprightBetween) {
  const TextRun stable = run_text(inverted_bar(R"("find": 2)"));
  ASSERT_EQ(stable.outcome.exit_code, 0) << stable.outcome.error_text << stable.analysis().report.message;
  const std::vector<double> angles = stable.column("bar.angle");
  ASSERT_EQ(angles.size(), 2u);
  EXPECT_NEAR(std::abs(angles[0]), tilt, 1e-10);
  EXPECT_NEAR(angles[0] + angles[1], 0, 1e-10);
  EXPECT_TRUE(field<bool>(stable, "stable"));

  const TextRun all = run_text(inverted_bar(R"("find": 3, "accept": "stationary")"));
  ASSERT_EQ(all.outcome.exit_code, 0) << all.analysis().report.message;
  const auto list = field<std::vector<FieldRecord>>(all, "equilibria");
  ASSERT_EQ(list.size(), 3u);
  // The highest energy comes last: upright.
  EXPECT_NEAR(all.last("bar.angle"), 0, 1e-10);
  EXPECT_FALSE(std::get<bool>(list[2][2].second));
  EXPECT_TRUE(std::get<bool>(list[0][2].second));
  EXPECT_LT(std::get<double>(list[0][1].second), std::get<double>(list[2][1].second) - 0.1);
}

TEST(SeveralEquilibria, SaysHowManyThereWere) {
  const TextRun run = run_text(inverted_bar(R"("find": 5)"));
  ASSERT_EQ(run.outcome.exit_code, 0);
  EXPECT_EQ(run.column("bar.angle").size(), 2u);
  ASSERT_FALSE(run.analysis().report.warnings.empty());
  EXPECT_NE(run.analysis().report.warnings.back().find("2 different equilibria"), std::string::npos);
  EXPECT_NE(run.analysis().report.warnings.back().find("5 wanted"), std::string::npos);
}

// Two springs of 1.2 m across a gap of 2 m: the point rests at y = +-sqrt(1.2^2 - 1), and nothing in it can turn.
TEST(SeveralEquilibria, FindsBothWellsWhereNothingTurns) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"a": {"mass": 1, "particle": true, "position": [0, 0.4]}},
    "constraints": [{"type": "absolute_x", "i": "a", "value": 0}],
    "forces": [{"type": "spring_damper", "i": ["ground", [-1, 0]], "j": "a", "k": 100, "length": 1.2},
               {"type": "spring_damper", "i": ["ground", [1, 0]], "j": "a", "k": 100, "length": 1.2}],
    "analyses": [{"type": "equilibrium", "find": 2, "outputs": ["a.y"]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  std::vector<double> y = run.column("a.y");
  ASSERT_EQ(y.size(), 2u);
  std::sort(y.begin(), y.end());
  EXPECT_NEAR(y[0], -std::sqrt(0.44), 1e-12);
  EXPECT_NEAR(y[1], std::sqrt(0.44), 1e-12);
}

// A shallow truss whose apex may not turn: the angle that is held sets nothing apart, the height does.
TEST(SeveralEquilibria, FindsBothWellsWhereAnglesAreHeld) {
  const TextRun run = run_text(R"({"catena": 1, "bodies": {"a": {"mass": 1, "inertia": 1, "position": [0, 0.28]}},
    "constraints": [{"type": "absolute_x", "i": "a", "value": 0}, {"type": "absolute_angle", "i": "a", "value": 0}],
    "forces": [{"type": "spring_damper", "i": ["ground", [-1, 0]], "j": "a", "k": 1000, "length": "=1.09^0.5"},
               {"type": "spring_damper", "i": ["ground", [1, 0]], "j": "a", "k": 1000, "length": "=1.09^0.5"}],
    "analyses": [{"type": "equilibrium", "find": 2, "outputs": ["a.y"]}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  std::vector<double> y = run.column("a.y");
  ASSERT_EQ(y.size(), 2u);
  std::sort(y.begin(), y.end());
  EXPECT_NEAR(y[0], -0.3, 1e-12);
  EXPECT_NEAR(y[1], 0.3, 1e-12);
}

TEST(FollowerForces, BalanceAndAreJudgedByTheirSmallMotions) {
  // A bar on a pin and a torsion spring of 4 N m/rad; 3 N across its end, always across: the moment is 6 N m whatever
  // the angle, so that it turns by 1.5 rad. A dead load would stop earlier.
  const std::string scene = R"({"catena": 1, "bodies": {"bar": {"mass": 1, "rod": {"from": [0, 0], "to": [2, 0]}}},
    "constraints": [{"type": "revolute", "name": "A", "i": "ground", "j": "bar.from"}],
    "forces": [{"type": "torsion_spring", "i": "ground", "j": "bar", "k": 4, "angle": 0},
      {"type": "point_force", "i": "bar.to", "force": [0, 3], "frame": "body"}],
    "analyses": [{"type": "equilibrium")";
  const TextRun run = run_text(scene + R"(}], "outputs": ["bar.angle", "A.fx", "A.fy"]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message << run.outcome.error_text;
  EXPECT_NEAR(run.last("bar.angle"), 1.5, 1e-10);
  EXPECT_NEAR(run.last("A.fx"), 3 * std::sin(1.5), 1e-9);
  EXPECT_NEAR(run.last("A.fy"), -3 * std::cos(1.5), 1e-9);
  EXPECT_TRUE(field<bool>(run, "stable"));
  EXPECT_EQ(field<std::int64_t>(run, "negative_modes"), 0);
  for (const NamedField& f : run.analysis().fields) EXPECT_NE(f.name, "energy");
  if (!ipopt_is_built_in()) return;
  const TextRun refused = run_text(scene + R"(, "solver": "ipopt"}]})");
  EXPECT_EQ(refused.analysis().report.status, Status::refused);
}

TEST(FollowerForces, BendTheTipOfAChainByTheirMoments) {
  // Six links of 1 m on torsion springs of 10 N m/rad, 2 N across the last one's end: the moment in the spring before
  // link k, counted from the tip in that link's axes, gives one angle after the other.
  const TextRun run = run_text(R"({"catena": 1, "replicate": [
    {"count": 6, "bodies": {"l{k}": {"mass": 0, "inertia": 0, "position": ["=k-0.5", 0]}}},
    {"count": 5, "first": 2, "constraints": [{"type": "revolute", "i": ["l{k-1}", [0.5, 0]], "j": ["l{k}", [-0.5, 0]]}],
      "forces": [{"type": "torsion_spring", "i": "l{k-1}", "j": "l{k}", "k": 10, "angle": 0}]}],
    "constraints": [{"type": "revolute", "i": "ground", "j": ["l1", [-0.5, 0]]}],
    "forces": [{"type": "torsion_spring", "i": "ground", "j": "l1", "k": 10, "angle": 0},
      {"type": "point_force", "i": ["l6", [0.5, 0]], "force": [0, 2], "frame": "body"}],
    "analyses": [{"type": "equilibrium"}], "outputs": ["l1.angle", "l6.angle"]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message << run.outcome.error_text;
  // In the axes of the last link: its root at (-1, 0) from the tip, the next ones turned back by the springs' angles.
  double direction = 0, x = 0, total = 0, first = 0;
  for (int k = 0; k < 6; ++k) {
    x += std::cos(direction);
    const double twist = 2 * x / 10;
    direction -= twist;
    total += twist;
    first = twist;
  }
  EXPECT_NEAR(run.last("l6.angle"), total, 1e-10);
  EXPECT_NEAR(run.last("l1.angle"), first, 1e-10);
}

TEST(Solvers, AreChosenByName) {
  for (const char* solver : {"auto", "newton", "ipopt", "nlopt"}) {
    const std::string name = solver;
    if (name == "ipopt" && !ipopt_is_built_in()) continue;
    if (name == "nlopt" && !nlopt_is_built_in()) continue;
    const TextRun run = run_text(inverted_bar(R"("solver": ")" + name + "\""));
    ASSERT_EQ(run.outcome.exit_code, 0) << name << run.analysis().report.message;
    EXPECT_EQ(field<std::string>(run, "solver"), name == "auto" ? "newton" : name);
    EXPECT_NEAR(std::abs(run.last("bar.angle")), tilt, 1e-10) << name;
    EXPECT_TRUE(field<bool>(run, "stable"));
  }
  const TextRun large = run_text(R"({"catena": 1, "gravity": [0, -10], "replicate": [{"count": 50,
      "bodies": {"b{k}": {"mass": 1, "inertia": 1, "position": ["=k", 0]}},
      "constraints": [{"type": "revolute", "i": ["ground", ["=k", 1]], "j": ["b{k}", [0, 1]]}]}],
    "analyses": [{"type": "equilibrium", "solver": "nlopt"}]})");
  EXPECT_EQ(large.analysis().report.status, Status::refused);
  EXPECT_NE(large.analysis().report.message.find("150"), std::string::npos) << large.analysis().report.message;
}

// Two rods of 1 m that lean against each other, drawn flat: the linear equations of the first step contradict each
// other, and the search begins where the sketch is assembled. H h = m g c / 2 with the crown at h, c^2 = 1 - h^2.
TEST(Equilibrium, ByNloptFromASketchThatIsDrawnFlat) {
  if (!nlopt_is_built_in()) GTEST_SKIP() << "built without NLopt";
  for (const double height : {0.3, 0.03}) {
    const double half = std::sqrt(1 - height * height);
    const TextRun run = run_text(fmt::format(R"({{"catena": 1, "gravity": [0, -10],
  "bodies": {{"a": {{"mass": 2, "inertia": 0.2, "position": [{0}, 0], "points": {{"l": [-0.5, 0], "r": [0.5, 0]}}}},
             "b": {{"mass": 2, "inertia": 0.2, "position": [{1}, 0], "points": {{"l": [-0.5, 0], "r": [0.5, 0]}}}}}},
  "constraints": [{{"type": "revolute", "name": "left", "i": "ground", "j": "a.l"}},
                  {{"type": "revolute", "i": "a.r", "j": "b.l"}},
                  {{"type": "revolute", "i": ["ground", [{2}, 0]], "j": "b.r"}}],
  "outputs": ["a.r.y", "left.fx", "left.fy"], "analyses": [{{"type": "equilibrium", "solver": "nlopt"}}]}})",
                                             half / 2, 1.5 * half, 2 * half));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    EXPECT_NEAR(std::abs(run.last("a.r.y")), height, 1e-9);
    EXPECT_NEAR(std::abs(run.last("left.fx")), 10 * half / height, 1e-6 * half / height);
    EXPECT_NEAR(run.last("left.fy"), 20, 1e-6);
  }
}

}  // namespace
}  // namespace catena::testing
