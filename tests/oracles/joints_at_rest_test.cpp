// Joints with dry friction that hold one load together, some of them contacts: bodies in a row on guides and on a
// floor, wheels on pins that turn as one. A push that grows by P' t after a rest has to reach the sum of all limits:
//
//   stops at  t_0 = |v_0| M / K         K = sum mu_k N_k,  S = sum mu_static,k N_k
//   leaves at t_b = t_1 + S / P'        v = ((S - K) x + P' x^2 / 2) / M,  x = t - t_b
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

struct Row {
  std::string scene, rate;  // the column of the rate that all have
  double inertia = 0, moving = 0, resting = 0, start = 0, push = 0, begins = 0;
  std::vector<double> limit;  // of joints; 0: a contact
};

// `wheels`: on pins, tied by their angles; else slides and particles, tied along x.
Row random_row(unsigned seed, bool wheels) {
  RandomNumbers random(seed);
  constexpr double g = 9.81, radius = 0.025, of_a_wheel = 0.01;
  const int count = 2 + static_cast<int>(random(0, 3));
  Row row;
  std::vector<std::string> bodies, constraints, forces;
  row.start = random(0, 1) < 0.4 ? 0 : random(-3, 3);
  for (int k = 0; k < count; ++k) {
    const std::string n = std::to_string(k), body = "\"b" + n + "\"", place = "[" + text_of(0.3 * k) + ",0]";
    const double mass = random(0.5, 2), mu = random(0.05, 0.3);
    const double mu_static = random(0, 1) < 0.5 ? mu : 1.4 * mu;
    const bool contact = !wheels && random(0, 1) < 0.4;
    const double force = mass * g * (wheels ? radius : 1);
    row.inertia += wheels ? of_a_wheel : mass;
    row.moving += mu * force;
    row.resting += mu_static * force;
    row.limit.push_back(contact ? 0 : mu_static * force);
    bodies.push_back(body + R"(: {"mass": )" + text_of(mass) +
                     (contact ? R"(, "particle": true)" : R"(, "inertia": 0.01)") + R"(, "position": )" + place +
                     (wheels ? R"(, "angular_velocity": )" + text_of(row.start)
                             : R"(, "velocity": [)" + text_of(row.start) + ", 0]") +
                     "}");
    if (!contact)
      constraints.push_back(wheels ? R"({"type": "revolute", "name": "J)" + n + R"(", "i": ["ground", )" + place +
                                         R"(], "j": )" + body + "}"
                                   : R"({"type": "translational", "name": "J)" + n +
                                         R"(", "i": "ground", "axis_i": [1, 0], "j": )" + body + "}");
    if (k > 0)
      constraints.push_back(R"({"type": ")" + std::string(wheels ? "relative_angle" : "relative_x") + R"(", "i": "b)" +
                            std::to_string(k - 1) + R"(", "j": )" + body + R"(, "value": )" + (wheels ? "0" : "0.3") +
                            "}");
    const std::string coefficients = R"(, "mu": )" + text_of(mu) + R"(, "mu_static": )" + text_of(mu_static) + "}";
    forces.push_back((contact ? R"({"type": "contact", "name": "f)" + n + R"(", "i": "ground", "j": )" + body +
                                    R"(, "curve": {"line": {"point": [0, 0], "axis": [1, 0]}})"
                              : R"({"type": "friction", "name": "f)" + n + R"(", "joint": "J)" + n + "\"" +
                                    (wheels ? R"(, "radius": 0.025)" : "")) +
                     coefficients);
  }
  row.push = (random(0, 1) < 0.5 ? -1 : 1) * row.resting / random(1, 3);
  row.begins = std::abs(row.start) * row.inertia / row.moving + 0.2;
  const std::string law = "\"=" + text_of(row.push) + "*max(0,t-" + text_of(row.begins) + ")\"";
  forces.push_back(wheels ? R"({"type": "torque", "i": "b0", "torque": )" + law + "}"
                          : R"({"type": "point_force", "i": "b0", "force": [)" + law + ", 0]}");
  row.rate = wheels ? "b0.omega" : "b0.vx";
  std::string outputs = "\"" + row.rate + "\"";
  for (int k = 0; k < count; ++k) outputs += ",\"f" + std::to_string(k) + ".friction\"";
  const double until = row.begins + row.resting / std::abs(row.push) + 0.5;
  row.scene = R"({"catena": 1, "gravity": [0, -9.81], "bodies": {)" + list_of(bodies) + R"(}, "constraints": [)" +
              list_of(constraints) + R"(], "forces": [)" + list_of(forces) + R"(], "outputs": [)" + outputs +
              R"(], "analyses": [{"type": "dynamics", "until": )" + text_of(until) + R"(, "every": )" +
              text_of(until / 37) + "}]}";
  return row;
}

std::string fault(unsigned seed, bool wheels) {
  const Row row = random_row(seed, wheels);
  const TextRun run = run_text(row.scene);
  if (!run.analysis().report.ok()) return run.analysis().report.message;
  const auto t = run.column("t"), rate = run.column(row.rate);
  const double stops = std::abs(row.start) * row.inertia / row.moving,
               leaves = row.begins + row.resting / std::abs(row.push);
  for (std::size_t n = 0; n < t.size(); ++n) {
    double right = t[n] < stops ? row.start - std::copysign(row.moving / row.inertia * t[n], row.start) : 0;
    const double x = t[n] - leaves;
    if (x > 0)
      right = std::copysign(((row.resting - row.moving) * x + std::abs(row.push) * x * x / 2) / row.inertia, row.push);
    if (!(std::abs(rate[n] - right) < 1e-6))
      return row.rate + " at " + text_of(t[n]) + ": " + text_of(rate[n]) + ", right " + text_of(right) +
             "; leaves at " + text_of(leaves);
    bool alone = true;  // joints without a contact keep their limits one by one
    for (const double limit : row.limit) alone = alone && limit > 0;
    for (std::size_t k = 0; alone && k < row.limit.size(); ++k) {
      const double force = run.column("f" + std::to_string(k) + ".friction")[n];
      if (std::abs(force) > row.limit[k] * (1 + 1e-6))
        return "f" + std::to_string(k) + " beyond its limit: " + text_of(force);
    }
  }
  return {};
}

TEST(JointsAtRest, LeaveTogetherWhereAllFrictionIsUsedUp) {
  expect_no_fault(1, 25, [](unsigned seed) { return fault(seed, false); });
  expect_no_fault(1, 25, [](unsigned seed) { return fault(seed, true); });
}

// Two contacts and a guide hold 3 N, and are pushed by 4 t N.
TEST(JointsAtRest, BesideContactsHoldWhatAllCan) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10], "bodies": {"a": {"mass": 1, "particle": true},
    "b": {"mass": 1, "particle": true, "position": [1, 0]}, "c": {"mass": 1, "inertia": 0.1, "position": [2, 0]}},
    "constraints": [{"type": "translational", "name": "G", "i": "ground", "j": "c", "axis_i": [1, 0]},
      {"type": "relative_x", "i": "a", "j": "b", "value": 1}, {"type": "relative_x", "i": "b", "j": "c", "value": 1}],
    "forces": [{"type": "contact", "i": "ground", "j": "a", "mu": 0.1, "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}},
      {"type": "contact", "i": "ground", "j": "b", "mu": 0.1, "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}},
      {"type": "friction", "joint": "G", "mu": 0.1}, {"type": "point_force", "i": "a", "force": ["=4*t", 0]}],
    "outputs": ["a.x"], "analyses": [{"type": "dynamics", "until": 2}]})");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  EXPECT_NEAR(run.last("a.x"), 4 * std::pow(1.25, 3) / 18, 1e-8);
}

// A four-bar that swings until its four pins hold it, and all energy that it lost is accounted for; two gears that a
// driver turns from rest.
TEST(JointsAtRest, OfMechanismsHoldThem) {
  std::string friction;
  for (const char* joint : {"O", "A", "B", "C"})
    friction += (friction.empty() ? "" : ",") +
                std::string(R"({"type": "friction", "mu": 0.6, "radius": 0.04, "joint": ")") + joint + "\"}";
  const TextRun bar = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
    "a": {"rod": {"from": [0, 0], "to": [0.3, 0.4]}, "mass": 1, "angular_velocity": 2},
    "b": {"rod": {"from": [0.3, 0.4], "to": [1, 0.6]}, "mass": 1.5},
    "c": {"rod": {"from": [1, -0.1], "to": [1, 0.6]}, "mass": 0.8}},
    "constraints": [{"type": "revolute", "name": "O", "i": "ground", "j": "a.from"},
      {"type": "revolute", "name": "A", "i": "a.to", "j": "b.from"},
      {"type": "revolute", "name": "B", "i": "b.to", "j": "c.to"},
      {"type": "revolute", "name": "C", "i": ["ground", [1, -0.1]], "j": "c.from"}],
    "forces": [)" + friction + R"(], "outputs": ["a.angle", "a.omega", "energy.balance", "energy.dissipated"],
    "analyses": [{"type": "dynamics", "at": [12, 13]}]})");
  ASSERT_TRUE(bar.analysis().report.ok()) << bar.analysis().report.message;
  const auto angle = bar.column("a.angle");
  EXPECT_NEAR(angle[1], angle[0], 1e-12);
  EXPECT_NEAR(bar.last("a.omega"), 0, 1e-12);
  EXPECT_GT(bar.last("energy.dissipated"), 1);
  EXPECT_NEAR(bar.last("energy.balance"), 0, 1e-6);
  const TextRun gears = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"a": {"mass": 1, "inertia": 0.01},
    "b": {"mass": 1, "inertia": 0.01, "position": [0.3, 0]}}, "constraints": [{"type": "revolute", "name": "A", "i": "ground",
    "j": "a"}, {"type": "revolute", "name": "B", "i": ["ground", [0.3, 0]], "j": "b"},
    {"type": "gear", "i": "a", "j": "b", "radius_i": 0.1, "radius_j": 0.2}],
    "drivers": [{"type": "absolute_angle", "i": "a", "value": {"step": {"t0": 0.5, "t1": 1, "from": 0, "to": 2}}}],
    "forces": [{"type": "friction", "joint": "A", "mu": 0.1, "radius": 0.02},
      {"type": "friction", "joint": "B", "mu": 0.1, "radius": 0.02}],
    "outputs": ["b.angle"], "analyses": [{"type": "dynamics", "until": 2}]})");
  ASSERT_TRUE(gears.analysis().report.ok()) << gears.analysis().report.message;
  EXPECT_NEAR(gears.last("b.angle"), -1, 1e-9);
}

}  // namespace
}  // namespace catena::testing
