// The seeds of stress/random_invariance_test.cpp whose answer once depended on units: equilibria by a metric that mixed
// metres and radians, by Lanczos steps on compliances in m/N, and by a curvature in 1/m beside stiffnesses in N/m;
// motions by a length scale of 1 m and by rows in metres compared with rows in radians. And those that were refused a
// million sizes from the origin: partitioning and equilibria took the rounding of curves on the ground, and of
// equations without freedom there, for equations that are not met.
#include "analysis/sanitized.hpp"
#include "oracles/random_seeds.hpp"
#include "stress/random_analyses.hpp"
#include "stress/touching_scene.hpp"
#include "stress/winding_scene.hpp"

namespace catena::testing {
namespace {

class OtherUnits : public ::testing::TestWithParam<unsigned> {};

TEST_P(OtherUnits, DoNotMatter) {
  std::map<std::string, int> seen;
  EXPECT_EQ(fault_in_other_units(GetParam(), seen), "");
  EXPECT_EQ(seen["ok"], 1) << "without an answer nothing is compared";
}
INSTANTIATE_TEST_SUITE_P(Seeds, OtherUnits,
                         ::testing::Values(616u, 1916u, 2068u, 2416u, 2456u, 2976u, 1249u, 1495u, 1627u, 1771u, 2737u,
                                           1578u, 1612u, 2618u, 2642u));

class FarOrigin : public ::testing::TestWithParam<unsigned> {};

TEST_P(FarOrigin, DoesNotMatter) {
  std::map<std::string, int> seen;
  EXPECT_EQ(fault_far_away(GetParam(), seen), "");
  EXPECT_EQ(seen["ok"], 1) << "without an answer nothing is compared";
}
INSTANTIATE_TEST_SUITE_P(Seeds, FarOrigin, ::testing::Values(600025u, 600035u, 600044u, 45u, 392u));

TEST(OtherUnitsOfAnalyses, DoNotMatter) {
  std::map<std::string, int> seen;
  expect_no_fault(1, size_of_test(30u, 8u), [&](unsigned seed) { return fault_of_units(seed, seen); });
  // A dead point of a mechanism of nanometres, taken for a bifurcation.
  EXPECT_EQ(fault_of_units(600033, seen), "");
  // Velocities at the start, whose changes in m/s and in rad/s were compared with each other.
  for (const unsigned seed : {792u, 1074u}) EXPECT_EQ(fault_of_units(seed, seen), "") << seed;
}

// A load that bends nothing was raised until rounding of what bears it looked like a buckling load, in one unit.
TEST(OtherUnitsOfAnalyses, LoadsWithoutAnEffectBuckleNothing) {
  std::map<std::string, int> seen;
  EXPECT_EQ(fault_of_units(200, seen), "");
  EXPECT_EQ(seen["buckling ok"], 1);
}

TEST(OtherUnitsOfWinding, DoNotMatter) {
  std::map<std::string, int> seen;
  expect_no_fault(1, size_of_test(32u, 8u), [&](unsigned seed) { return fault_of_winding_in_other_units(seed, seen); });
  expect_no_fault(1, size_of_test(32u, 8u), [&](unsigned seed) { return fault_of_winding_elsewhere(seed, seen); });
  EXPECT_GE(seen["ok"], size_of_test(62, 14));
}

// Places where bodies touch, and events, once had lengths, speeds and forces of their own: 1e-14 m, 1e-14 m/s, 1e-14 N.
TEST(OtherUnitsOfContacts, DoNotMatter) {
  std::map<std::string, int> seen;
  expect_no_fault(1, size_of_test(48u, 12u),
                  [&](unsigned seed) { return fault_of_units_where_bodies_touch(seed, seen); });
  EXPECT_GE(seen["ok"], size_of_test(47, 11));
}

// A particle falls h, comes back with e of its speed, and is on its second flight when it is looked at.
TEST(OtherUnitsOfContacts, ABouncingParticleIsWhereItIsAtAnySize) {
  expect_no_fault(1, 19, [](unsigned seed) -> std::string {
    const double h = std::pow(10.0, static_cast<double>(seed) - 10), e = 0.3 + 0.02 * seed, g = 9.81 * h;
    const double fall = std::sqrt(2 * h / g), back = e * g * fall, t = fall + 0.6 * 2 * back / g;
    std::ostringstream text;
    text.precision(17);
    text << R"({"catena": 1, "gravity": [0, )" << -g << R"(], "bodies": {"b": {"mass": 1, "particle": true,
      "position": [0, )"
         << h << R"(]}}, "forces": [{"type": "contact", "i": "ground", "j": "b", "restitution": )" << e
         << R"(, "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}], "outputs": ["b.y", "b.vy"],
      "analyses": [{"type": "dynamics", "at": [)"
         << t << "]}]}";
    const TextRun run = run_text(text.str());
    if (run.outcome.exit_code > 0) return run.outcome.error_text + run.analysis().report.message;
    const double later = t - fall, y = back * later - g * later * later / 2, v = back - g * later;
    const double off = std::max(std::abs(run.last("b.y") - y) / h, std::abs(run.last("b.vy") - v) / back);
    return off <= 1e-8 ? "" : "off by " + std::to_string(off) + " of its size";
  });
}

}  // namespace
}  // namespace catena::testing
