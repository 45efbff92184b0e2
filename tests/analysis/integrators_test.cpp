// What methods of integration have of their own, beside the correct motion that all of them give.
#include <gtest/gtest.h>

#include "oracles/dynamics_mechanisms.hpp"

namespace catena {
namespace {

using testing::four_bars;
using testing::frame_of;
using testing::rod_chain;
using testing::run_dynamics;

double largest_residual(const std::shared_ptr<Model>& model, const DynamicsOptions& options, double until) {
  double largest = 0;
  Dynamics dynamics(model, {}, options);
  run_dynamics(dynamics, TimeGrid::range(0, until, until / 100), {},
               [&](const Snapshot& s) { largest = std::max(largest, s.residual); });
  return largest;
}

// Constraints that are only stabilised drift, but never more than the tolerance allows, however long a run is.
TEST(Baumgarte, DriftIsBoundedByTheTolerance) {
  for (const double tolerance : {1e-4, 1e-6, 1e-8}) {
    const DynamicsOptions options{.method = IntegrationMethod::baumgarte, .tolerance = tolerance};
    const double brief = largest_residual(rod_chain(2), options, 2), much = largest_residual(rod_chain(2), options, 20);
    EXPECT_GT(brief, 1e-14) << "rows show what the method does, not its projection";
    EXPECT_LT(much, tolerance);
  }
}

// What a fixed step leaves of the constraints decays; without stabilisation it would grow with the square of time.
TEST(Baumgarte, DriftOfAFixedStepStaysSmallOverAThousandSteps) {
  const DynamicsOptions options{.method = IntegrationMethod::baumgarte, .step = 0.02};
  const double brief = largest_residual(rod_chain(1), options, 2), much = largest_residual(rod_chain(1), options, 20);
  EXPECT_GT(brief, 1e-14);
  EXPECT_LT(much, 2 * brief);
}

TEST(Baumgarte, FixedStepConvergesWithOrderEight) {
  const auto angle = [](const DynamicsOptions& options) {
    double last = std::nan("");
    Dynamics dynamics(rod_chain(2), {}, options);
    run_dynamics(dynamics, TimeGrid::instant(0.5), {}, [&](const Snapshot& s) { last = frame_of(s, 1).phi; });
    return last;
  };
  const double exact = angle({.tolerance = 1e-13});
  const auto error = [&](double step) {
    return std::abs(angle({.method = IntegrationMethod::baumgarte, .step = step}) - exact);
  };
  const double coarse = error(0.05), fine = error(0.025);
  EXPECT_GT(coarse / fine, 128);
  EXPECT_LT(coarse, 1e-5);
}

// At a flat position stabilised constraints would lead along any branch: it says that it projected there.
TEST(Baumgarte, SaysThatItProjectsAcrossSingularPositions) {
  Dynamics dynamics(four_bars(2), {}, {.method = IntegrationMethod::baumgarte});
  const AnalysisReport report = run_dynamics(dynamics, TimeGrid::instant(5), {}, [](const Snapshot&) {});
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("singular positions were projected"), std::string::npos) << report.warnings[0];
}

}  // namespace
}  // namespace catena
