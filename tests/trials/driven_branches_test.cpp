// The slider-crank of near_branches.hpp with a motor on its crank: where it is follows from the constraints, and what
// the motor does from the energy.
#include <cmath>

#include "trials/near_branches.hpp"

namespace catena::testing {
namespace {

using namespace near_branches;

// With the crank driven as well: branches meet where the other constraints lose rank, driven or not.
using Driven = std::tuple<double, double, bool>;
class DrivenNarrowPassages : public ::testing::TestWithParam<Driven> {};

Json driven(double d, double tolerance, const std::string& method, bool doubled) {
  Json scene = slider_crank(d, tolerance, method, doubled);
  Json driver = {{"type", "absolute_angle"}, {"name", "motor"}, {"i", "crank"}};
  driver["value"]["polynomial"] = {start, rate};
  scene["drivers"] = Json::array();
  scene["drivers"].push_back(driver);
  return scene;
}

TextRun run_driven(double d, double tolerance, bool doubled) {
  return run_text(driven(d, tolerance, "auto", doubled).dump());
}

TEST_P(DrivenNarrowPassages, AreNotMistakenInSilence) {
  const auto [d, tolerance, doubled] = GetParam();
  const TextRun run = run_driven(d, tolerance, doubled);
  if (run.outcome.exit_code != 0) {
    const Report& report = run.analysis().report;
    EXPECT_LT(d, 1e-9) << report.message;
    EXPECT_NE(report.message.find("two branches"), std::string::npos) << report.message;
    return;
  }
  const double z = start + rate * until, rod = 1 + d;
  const double turned = std::cos(z) + std::sqrt((rod - std::sin(z)) * (rod + std::sin(z)));
  if (tells_straight_passage(run)) {
    EXPECT_LT(d, 1e-9);
  } else {
    EXPECT_NEAR(run.last("slider.x"), turned, 1e-9);
  }
}
INSTANTIATE_TEST_SUITE_P(All, DrivenNarrowPassages,
                         ::testing::Combine(::testing::Values(1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-6, 1e-4),
                                            ::testing::Values(1e-4, 1e-6, 1e-8, 1e-10), ::testing::Bool()));

// What the driver does is what the energy M rate^2 / 2 has changed by, in rows within steps as well: a pulse as sharp
// as the turn, of which integrals of its power see little, and rounding of places takes eps / (2 d) of the energy.
using Worked = std::tuple<const char*, double, double>;
class DrivenWork : public ::testing::TestWithParam<Worked> {};

TEST_P(DrivenWork, IsThatOfTheEnergy) {
  const auto [method, d, tolerance] = GetParam();
  for (const bool doubled : {false, true}) {
    Json scene = driven(d, tolerance, method, doubled);
    scene["analyses"][0]["every"] = until / 240;
    scene["outputs"] = {"motor.work", "energy.balance"};
    const TextRun run = run_text(scene.dump());
    ASSERT_EQ(run.outcome.exit_code, 0) << run.analysis().report.message;
    const std::vector<double> t = run.column("t"), work = run.column("motor.work"),
                              missing = run.column("energy.balance");
    ASSERT_EQ(t.size(), 241u);
    for (std::size_t k = 0; k < t.size(); ++k) {
      const double energy = rate * rate / 2 * (mass_at(start + rate * t[k], d) - mass_at(start, d));
      // Of 53 J; rounding of places is magnified beside the corner, by 1 / sqrt(2 d) in the energy itself.
      const double permitted = 500 * tolerance + 1e-8;
      EXPECT_NEAR(work[k], energy, permitted) << t[k];
      EXPECT_NEAR(missing[k], 0, permitted) << t[k];
    }
  }
}
INSTANTIATE_TEST_SUITE_P(All, DrivenWork,
                         ::testing::Combine(::testing::Values("rk8", "rk5", "adams", "baumgarte"),
                                            ::testing::Values(1e-9, 1e-8, 1e-6, 1e-4, 1e-2),
                                            ::testing::Values(1e-4, 1e-6, 1e-8, 1e-10)));

// Today 31 of 32, whether joints are doubled or not: rounding decides some, which compilers make differently.
TEST(DrivenNearBranches, EndWellInMostCases) {
  int well = 0, well_doubled = 0;
  for (const double d : {1e-13, 1e-12, 1e-11, 1e-10, 1e-9, 1e-8, 1e-6, 1e-4}) {
    for (const double tolerance : {1e-4, 1e-6, 1e-8, 1e-10}) {
      well += run_driven(d, tolerance, false).outcome.exit_code == 0;
      well_doubled += run_driven(d, tolerance, true).outcome.exit_code == 0;
    }
  }
  EXPECT_GE(well, 30);
  EXPECT_GE(well_doubled, 30);
}

}  // namespace
}  // namespace catena::testing
