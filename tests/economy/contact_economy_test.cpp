// Motion with contacts: a change costs no new plan and no symbolic analysis where its set of equations held before, and
// a mechanism nothing of what happens to others.
#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <string>

#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

const std::string floor_line = R"("curve": {"line": {"point": [0, 0], "axis": [1, 0]}})";

struct Changes {
  int all = 0, impacts = 0;
  std::size_t sets = 1;  ///< of closed places, different ones
};

Changes changes_of(const TextRun& run) {
  Changes changes;
  std::set<std::string> closed;
  std::set<std::set<std::string>> sets{closed};
  for (const FieldRecord& record : field<std::vector<FieldRecord>>(run, "events")) {
    std::string name, kind;
    for (const auto& [key, value] : record) {
      if (key == "name") name = std::get<std::string>(value);
      if (key == "kind") kind = std::get<std::string>(value);
    }
    ++changes.all;
    if (kind == "impact") ++changes.impacts;
    if (kind == "contact") closed.insert(name);
    if (kind == "release") closed.erase(name);
    if (kind == "stick") closed.insert(name + " sticks");
    if (kind == "slip") closed.erase(name + " sticks");
    sets.insert(closed);
  }
  changes.sets = sets.size();
  return changes;
}

/// A chain of rods from a pin above the floor, which its links hit and leave: all of one mechanism.
std::string chain_over_floor(int links, double restitution) {
  std::string bodies, constraints, forces;
  const auto number = [](int k) { return std::to_string(k); };
  for (int k = 0; k < links; ++k) {
    const double length = 0.2;
    bodies += (k ? ", " : "") + ("\"rod" + number(k)) + R"(": {"mass": 1, "rod": {"from": )" +
              pair_of(k * length, 0.5) + R"(, "to": )" + pair_of((k + 1) * length, 0.5) + "}}";
    constraints += (k ? ", " : "") + std::string(R"({"type": "revolute", "i": )") +
                   (k ? "\"rod" + number(k - 1) + ".to\"" : R"(["ground", [0, 0.5]])") + R"(, "j": "rod)" + number(k) +
                   R"(.from"})";
    forces += (k ? ", " : "") + (R"({"type": "contact", "name": "c)" + number(k)) + R"(", "i": "ground", "j": "rod)" +
              number(k) + R"(.to", "restitution": )" + text_of(restitution) + ", " + floor_line + "}";
  }
  return R"({"catena": 1, "gravity": [0, -9.81], "bodies": {)" + bodies + R"(}, "constraints": [)" + constraints +
         R"(], "forces": [)" + forces + R"(], "outputs": ["energy.total"], "analyses": [{"type": "dynamics", )";
}

TEST(ContactEconomy, BouncesOfAChainCostNoPlan) {
  const std::string chain = chain_over_floor(6, 0.9);
  const TextRun before = run_text(chain + R"("until": 0.2, "tolerance": 1e-8}]})");
  const TextRun run = run_text(chain + R"("until": 3, "every": 0.02, "tolerance": 1e-8}]})");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const Changes changes = changes_of(run);
  EXPECT_EQ(changes_of(before).all, 0);
  EXPECT_GT(changes.impacts, 20);
  ASSERT_EQ(changes.sets, 1u) << "places that stay closed: not what this test is about";
  // The structure of factors is found once; velocities after a bounce meet the equations to rounding.
  EXPECT_EQ(run.analysis().report.counters.symbolic, before.analysis().report.counters.symbolic);
  // Energy is never gained.
  const std::vector<double> energy = run.column("energy.total");
  for (std::size_t row = 1; row < energy.size(); ++row) EXPECT_LE(energy[row], energy[row - 1] + 1e-7) << row;
}

TEST(ContactEconomy, PlacesThatStickAndSlipCostTwoPlans) {
  const auto run_until = [](const std::string& until) {
    return run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
      "belt": {"mass": 1, "inertia": 1, "velocity": [0.2, 0]}, "block": {"particle": true, "mass": 1, "velocity": [0.2, 0]}},
      "constraints": [{"type": "absolute_y", "i": "belt", "value": 0}, {"type": "absolute_angle", "i": "belt", "value": 0}],
      "drivers": [{"type": "absolute_x", "i": "belt", "value": {"polynomial": [0, 0.2]}}],
      "forces": [{"type": "contact", "name": "rub", "i": "belt", "j": "block", "mu": 0.2, "mu_static": 0.35, )" +
                    floor_line + R"(},
        {"type": "spring_damper", "i": ["ground", [-1, 0]], "j": "block", "k": 50, "length": 1}],
      "outputs": ["block.x"], "analyses": [{"type": "dynamics", "until": )" +
                    until + "}]}");
  };
  const TextRun brief = run_until("1.8"), run = run_until("20");
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_GE(changes_of(brief).all, 2);
  EXPECT_GT(changes_of(run).all, 25);
  EXPECT_EQ(run.analysis().report.counters.symbolic, brief.analysis().report.counters.symbolic);
}

// Rods that come to rest on their ends: plans and structures for the sets there are, not for every change.
TEST(ContactEconomy, SetsThatComeAgainCostNothing) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double angle = random(-1, 1), c = 0.3 * std::cos(angle), s = 0.3 * std::sin(angle);
    std::string contacts;
    for (const std::string end : {"from", "to"}) {
      contacts += (contacts.empty() ? "" : ", ") + (R"({"type": "contact", "name": ")" + end) +
                  R"(", "i": "ground", "j": "rod.)" + end + R"(", "restitution": 0.5, )" + floor_line + "}";
    }
    const TextRun run =
        run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"rod": {"mass": 1, "rod": {"from": )" +
                 pair_of(-c, 0.6 - s) + R"(, "to": )" + pair_of(c, 0.6 + s) + R"(}}}, "forces": [)" + contacts +
                 R"(], "outputs": ["rod.y"], "analyses": [{"type": "dynamics", "until": 2}]})");
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const Changes changes = changes_of(run);
    EXPECT_GT(changes.all, 10);
    // The set of no equations has no structure; where it comes to rest velocities are rounding, and found anew.
    EXPECT_LE(run.analysis().report.counters.symbolic, static_cast<std::int64_t>(changes.sets));
    EXPECT_NEAR(run.last("rod.y"), 0, 1e-12);
  }
}

}  // namespace
}  // namespace catena::testing
