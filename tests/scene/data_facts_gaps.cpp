// Contacts, stops, cables and ropes.
#include <cmath>

#include "scene/data_facts.hpp"

namespace catena::testing {
namespace {

constexpr std::size_t statics = 1;

std::vector<std::string> active(const TextRun& run) {
  for (const NamedField& f : run.analysis(statics).fields) {
    if (f.name == "active") return std::get<std::vector<std::string>>(f.value);
  }
  ADD_FAILURE() << "no field active";
  return {};
}

// Loads spread evenly over a chain that nothing else touches: tan of the angles is linear along it.
void expect_catenary(const TextRun& run, int links, double weight, double pull, double sign) {
  const auto slope = [&](int k) { return std::tan(run.last("link" + std::to_string(k) + ".angle", statics)); };
  for (int k = 2; k <= links; ++k) EXPECT_NEAR(slope(k) - slope(k - 1), sign * weight / pull, 1e-9) << k;
}

void check_floor(const TextRun& run) {
  const double weight = 0.1 * 9.81, pull = -run.last("left.fx", statics);
  EXPECT_GT(pull, 0);
  EXPECT_NEAR(run.last("right.fx", statics), pull, 1e-9);
  EXPECT_NEAR(run.last("left.fy", statics), run.last("right.fy", statics), 1e-9);
  expect_catenary(run, 3, weight, pull, 1);
  // In the middle a joint carries half of each of its links.
  EXPECT_NEAR(run.last("floor12.force", statics), weight, 1e-9);
  EXPECT_NEAR(run.last("link12.to.y", statics), 0, 1e-12);
  EXPECT_GE(active(run).size(), 5u);
}

void check_drum(const TextRun& run) {
  const double weight = 0.1 * 9.81, pull = -run.last("left.fx", statics);
  EXPECT_NEAR(run.last("right.fx", statics), pull, 1e-9);
  EXPECT_NEAR(run.last("left.fy", statics), run.last("right.fy", statics), 1e-9);
  expect_catenary(run, 4, weight, pull, 1);
  EXPECT_GT(run.last("drum13.force", statics), 0.1);
  EXPECT_NEAR(run.last("drum13.gap", statics), 0, 1e-12);
  EXPECT_EQ(run.last("drum1.force", statics), 0);
}

// Left and right at 45 degrees carry 30 N each: sqrt(2) 30 N along them, 30 N across, which the middle one holds.
void check_net(const TextRun& run) {
  EXPECT_NEAR(run.last("a.x", statics), 1, 1e-11);
  EXPECT_NEAR(run.last("b.y", statics), -1, 1e-11);
  EXPECT_NEAR(run.last("left.force", statics), 30 * std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(run.last("right.force", statics), 30 * std::sqrt(2.0), 1e-9);
  EXPECT_NEAR(run.last("middle.force", statics), 30, 1e-9);
  EXPECT_EQ(run.last("long.force", statics), 0);
  EXPECT_EQ(run.last("spare.force", statics), 0);
  EXPECT_NEAR(run.last("long.gap", statics), 3.5 - std::sqrt(10.0), 1e-11);
  EXPECT_NEAR(run.last("spare.gap", statics), 3.2 - std::sqrt(10.0), 1e-11);
  EXPECT_EQ(active(run).size(), 3u);
}

// One freedom: the weight sinks by R for a radian of the drum, the load rises by r / 2.
void check_tackle(const TextRun& run) {
  constexpr double g = 9.81, R = 0.3, r = 0.1, weight = 4, load = 10, inertia = 0.05, t = 0.5;
  const double a = (weight * g * R - load * g * r / 2) / (inertia + weight * R * R + load * r * r / 4);
  EXPECT_NEAR(run.last("drum.angle", 1), a * t * t / 2, 1e-8);
  EXPECT_NEAR(run.last("weight.y", 1), -1 - R * a * t * t / 2, 1e-8);
  EXPECT_NEAR(run.last("load.y", 1), -2 + r / 2 * a * t * t / 2, 1e-8);
  EXPECT_NEAR(run.last("pull.force", 1), weight * (g - R * a), 1e-7);
  EXPECT_NEAR(run.last("lift.force", 1), load * (g + r * a / 2) / 2, 1e-7);
}

}  // namespace

SceneFacts gap_facts() {
  return {{"chain_on_floor.json", check_floor},
          {"chain_over_drum.json", check_drum},
          {"slack_net.json", check_net},
          {"tackle.json", check_tackle}};
}

}  // namespace catena::testing
