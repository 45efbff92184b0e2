// Mechanisms side by side in one scene: each moves as it would alone, and columns of all of them come out right.
#include <gtest/gtest.h>

#include "scene/run_text.hpp"

namespace catena {
namespace {

using testing::run_text;
using testing::TextRun;

struct Mechanism {
  std::string bodies, constraints, drivers, forces, outputs;
};

/// A motor, a welded bracket, a fixed post and an unnamed joint.
const Mechanism crank{
    R"("bracket": {"mass": 1, "inertia": 1, "position": [-5, 0]}, "post": {"fixed": true, "position": [-3, 0], "angle": 0.5},
       "crank": {"rod": {"from": [-5, 0], "to": [-4, 0]}, "mass": 1},
       "rocker": {"rod": {"from": [-4, 0], "to": [-3, 0.5]}, "mass": 2})",
    R"({"type": "weld", "i": "ground", "j": "bracket"}, {"type": "revolute", "name": "A", "i": "bracket", "j": "crank.from"},
       {"type": "revolute", "i": "crank.to", "j": "rocker.from"})",
    R"({"type": "relative_angle", "name": "drive", "i": "bracket", "j": "crank",
        "value": {"step": {"t0": 0.2, "t1": 0.7, "from": 0, "to": 1, "order": 3}}})",
    R"({"type": "spring_damper", "name": "S", "i": "post", "j": "rocker.to", "k": 40, "c": 0.3, "length": 0.2})",
    R"("crank.angle", "rocker.omega", "rocker.alpha", "A.fx", "A.fy", "A.lambda2", "drive.load", "drive.power", "drive.work", "S.force")"};

/// Small, stiff and fast.
const Mechanism ball{
    R"("ball": {"mass": 0.01, "position": [0.02, 0], "particle": true})",
    R"({"type": "absolute_distance", "name": "link", "i": "ball", "ground": [0, 0], "value": 0.02})", "",
    R"({"type": "spring_damper", "i": ["ground", [0.03, 0.01]], "j": "ball", "k": 4000, "length": 0.005})",
    R"("ball.x", "ball.vy", "link.fx", "link.fy", "link.torque")"};

const std::string whole_outputs =
    R"("energy.kinetic", "energy.potential", "energy.total", "energy.dissipated", "energy.balance", "momentum.x",
       "momentum.angular")";

std::string scene(const std::vector<Mechanism>& mechanisms,
                  const std::string& keys = R"("every": 0.05, "tolerance": 1e-10)",
                  const std::string& outputs = whole_outputs) {
  Mechanism all;
  const auto join = [](std::string& list, const std::string& more) {
    if (!more.empty()) list += (list.empty() ? "" : ", ") + more;
  };
  for (const Mechanism& m : mechanisms) {
    join(all.bodies, m.bodies);
    join(all.constraints, m.constraints);
    join(all.drivers, m.drivers);
    join(all.forces, m.forces);
    join(all.outputs, m.outputs);
  }
  join(all.outputs, outputs);
  return R"({"catena": 1, "gravity": [0, -9.81], "bodies": {)" + all.bodies + R"(}, "constraints": [)" +
         all.constraints + R"(], "drivers": [)" + all.drivers + R"(], "forces": [)" + all.forces +
         R"(], "analyses": [{"type": "dynamics", "until": 1, )" + keys + R"(}], "outputs": [)" + all.outputs + "]}";
}

std::int64_t apart(const TextRun& run) {
  for (const NamedField& field : run.analysis().fields) {
    if (field.name == "integrated_apart") return std::get<std::int64_t>(field.value);
  }
  return 0;
}

TEST(DynamicsApart, EachMovesAsItWouldAlone) {
  const TextRun both = run_text(scene({ball, crank})), slow = run_text(scene({crank})), fast = run_text(scene({ball}));
  ASSERT_EQ(both.outcome.exit_code, 0) << both.outcome.error_text << both.analysis().report.message;
  EXPECT_EQ(apart(both), 2);
  EXPECT_EQ(apart(slow) + apart(fast), 0);
  for (const TextRun* alone : {&slow, &fast}) {
    for (const ColumnInfo& column : alone->analysis().columns) {
      if (column.name.find('.') == std::string::npos || column.name.starts_with("energy") ||
          column.name.starts_with("momentum")) {
        continue;
      }
      EXPECT_EQ(both.column(column.name), alone->column(column.name)) << column.name;
    }
  }
  for (const ColumnInfo& column : both.analysis().columns) {
    if (!column.name.starts_with("energy") && !column.name.starts_with("momentum")) continue;
    const std::vector<double> sum = both.column(column.name), a = slow.column(column.name),
                              b = fast.column(column.name);
    for (std::size_t k = 0; k < sum.size(); ++k)
      EXPECT_NEAR(sum[k], a[k] + b[k], 1e-12 * (1 + std::abs(sum[k]))) << column.name;
  }
  const AnalysisReport &all = both.analysis().report, &one = slow.analysis().report, &other = fast.analysis().report;
  EXPECT_EQ(all.dof, *one.dof + *other.dof);
  EXPECT_EQ(all.mobility, *one.mobility + *other.mobility);
  EXPECT_EQ(all.counters.steps, one.counters.steps + other.counters.steps);
  EXPECT_GT(other.counters.steps, 10 * one.counters.steps) << "the scene was not what this test is about";
}

// The same with steps in common.
TEST(DynamicsApart, AgreesWithARunInCommon) {
  const TextRun split = run_text(scene({crank, ball}));
  const std::string watched = R"("every": 0.05, "tolerance": 1e-10, "events": [{"when": "ball.y", "value": 5}])";
  const TextRun common = run_text(scene({crank, ball}, watched));
  ASSERT_EQ(common.outcome.exit_code, 0) << common.outcome.error_text;
  EXPECT_EQ(apart(split), 2);
  EXPECT_EQ(apart(common), 0) << "events need all of them at once";
  for (const ColumnInfo& column : split.analysis().columns) {
    const std::vector<double> a = split.column(column.name), b = common.column(column.name);
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-6 * (1 + std::abs(b[k]))) << column.name << k;
  }
}

TEST(DynamicsApart, GoesOnFromWhereTheAnalysisBeforeEnded) {
  const std::string two = R"("every": 0.25}, {"type": "dynamics", "until": 2, "every": 0.25)";
  const TextRun both = run_text(scene({crank, ball}, two)), slow = run_text(scene({crank}, two));
  ASSERT_EQ(both.outcome.exit_code, 0) << both.outcome.error_text;
  EXPECT_EQ(both.column("rocker.omega", 1).size(), 5u);
  EXPECT_NEAR(both.last("rocker.omega", 1), slow.last("rocker.omega", 1), 1e-12);
}

TEST(DynamicsApart, EndsWhereOneOfThemCannotGoOn) {
  const Mechanism runaway{R"("mad": {"mass": 1, "particle": true, "position": [1, 7]})", "", "",
                          R"({"type": "spring_damper", "i": "ground", "j": "mad", "k": 0, "c": -1e4, "length": 1})",
                          R"("mad.y")"};
  const TextRun run = run_text(scene({crank, runaway}));
  EXPECT_EQ(run.outcome.exit_code, 1);
  EXPECT_EQ(run.analysis().report.status, Status::step_too_small);
  EXPECT_NE(run.analysis().report.message.find("mad"), std::string::npos) << run.analysis().report.message;
  EXPECT_GT(run.analysis().rows, 0);
  EXPECT_LT(run.analysis().rows, 21);
}

TEST(DynamicsApart, CanBeCancelled) {
  const std::atomic<bool> cancel = true;
  RunOptions options;
  options.cancel = &cancel;
  const TextRun run = run_text(scene({crank, ball}), options);
  EXPECT_EQ(run.analysis().report.status, Status::cancelled);
}

// Mechanisms of one pace share their steps; a fixed step is the same for all.
TEST(DynamicsApart, OnlyWhereItPays) {
  EXPECT_EQ(apart(run_text(scene({crank, ball}, R"("step": 0.001)"))), 0);
  const std::string many = R"({"catena": 1, "gravity": [0, -9.81],
    "replicate": [{"count": 40, "bodies": {"b{k}": {"mass": 1, "particle": true, "position": ["=k", 0]}}}],
    "analyses": [{"type": "dynamics", "until": 1}]})";
  const TextRun run = run_text(many);
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_EQ(apart(run), 0);
  EXPECT_NEAR(run.last("b40.y"), -9.81 / 2, 1e-9);
}

TEST(DynamicsApart, ByPaceNotByNumber) {
  const auto pendulum = [](const std::string& name) {
    return Mechanism{"\"" + name + R"(": {"rod": {"from": [0, 0], "to": [1, 0]}, "mass": 1})",
                     R"({"type": "revolute", "i": "ground", "j": ")" + name + R"(.from"})", "", "",
                     "\"" + name + ".angle\""};
  };
  const TextRun run = run_text(scene({pendulum("a"), ball, pendulum("b")})), alone = run_text(scene({pendulum("a")}));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
  EXPECT_EQ(apart(run), 2) << "two pendulums alike, and a faster ball";
  EXPECT_EQ(run.column("a.angle"), run.column("b.angle"));
  EXPECT_EQ(run.column("a.angle").size(), alone.column("a.angle").size());
  EXPECT_NEAR(run.last("a.angle"), alone.last("a.angle"), 1e-9);
}

// Where joints are redundant or parts massless, work is summed up for a check of its own though no column shows it.
TEST(DynamicsApart, WorkThatIsSummedUpUnasked) {
  const Mechanism door{R"("door": {"rod": {"from": [0, 0], "to": [1, 0]}, "mass": 1})",
                       R"({"type": "revolute", "i": "ground", "j": "door.from"},
                          {"type": "revolute", "i": "ground", "j": "door.from"})",
                       "", R"({"type": "torsion_spring", "i": "ground", "j": "door", "k": 1, "c": 0.5})",
                       R"("door.angle")"};
  const std::string keys = R"("every": 0.5)";
  const TextRun run = run_text(scene({door, ball}, keys, R"("ball.x")")),
                alone = run_text(scene({door}, keys, R"("door.x")"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_EQ(apart(run), 2);
  EXPECT_NEAR(run.last("door.angle"), alone.last("door.angle"), 1e-7);
}

}  // namespace
}  // namespace catena
