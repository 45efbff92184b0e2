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

double last_angle(const std::shared_ptr<Model>& model, const DynamicsOptions& options, double until,
                  AnalysisReport* report = nullptr) {
  double last = std::nan("");
  Dynamics dynamics(model, {}, options);
  const int body = static_cast<int>(model->bodies.size()) - 1;
  const AnalysisReport outcome =
      run_dynamics(dynamics, TimeGrid::instant(until), {}, [&](const Snapshot& s) { last = frame_of(s, body).phi; });
  if (report) *report = outcome;
  return last;
}

/// The state at the end of a fall of two rods.
std::vector<double> state_after_fall(const DynamicsOptions& options) {
  std::vector<double> state;
  Dynamics dynamics(rod_chain(2), {}, options);
  run_dynamics(dynamics, TimeGrid::instant(0.6), {.velocity = true}, [&](const Snapshot& s) {
    state.assign(s.q.begin(), s.q.end());
    state.insert(state.end(), s.qd.begin(), s.qd.end());
  });
  return state;
}

TEST(Integrators, OfOrderEightConvergeWithItAtFixedSteps) {
  const std::vector<double> exact = state_after_fall({.tolerance = 1e-13});
  for (const IntegrationMethod method :
       {IntegrationMethod::rk8, IntegrationMethod::baumgarte, IntegrationMethod::adams}) {
    const auto error = [&](double step) {
      const std::vector<double> state = state_after_fall({.method = method, .step = step});
      double largest = 0;
      for (std::size_t k = 0; k < state.size(); ++k) largest = std::max(largest, std::abs(state[k] - exact[k]));
      return largest;
    };
    // A step of Runge-Kutta is one of twelve evaluations.
    const double step = method == IntegrationMethod::adams ? 0.05 / 8 : 0.05, coarse = error(step);
    EXPECT_GT(coarse / error(step / 2), 100) << to_string(method);
    EXPECT_LT(coarse, 1e-6) << to_string(method);
    EXPECT_GT(coarse, 1e-8) << to_string(method) << " was not tested where it has an error";
  }
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

// At a flat position stabilised constraints would lead along any branch: it says that it projected there.
TEST(Baumgarte, SaysThatItProjectsAcrossSingularPositions) {
  Dynamics dynamics(four_bars(2), {}, {.method = IntegrationMethod::baumgarte});
  const AnalysisReport report = run_dynamics(dynamics, TimeGrid::instant(5), {}, [](const Snapshot&) {});
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("singular positions were projected"), std::string::npos) << report.warnings[0];
}

// What multistep methods are for: fewer evaluations than Runge-Kutta on a long chain, all errors within the tolerance.
TEST(Adams, NeedsFewEvaluations) {
  const auto model = rod_chain(40);
  const double exact = last_angle(model, {.tolerance = 1e-13}, 1);
  for (const double tolerance : {1e-6, 1e-8, 1e-10}) {
    AnalysisReport one_step, multistep;
    last_angle(model, {.method = IntegrationMethod::rk8, .tolerance = tolerance}, 1, &one_step);
    const double angle = last_angle(model, {.method = IntegrationMethod::adams, .tolerance = tolerance}, 1, &multistep);
    EXPECT_LT(multistep.counters.forces, 0.8 * static_cast<double>(one_step.counters.forces)) << tolerance;
    EXPECT_NEAR(angle, exact, tolerance);
    EXPECT_LE(multistep.counters.forces, 2 * (multistep.counters.steps + multistep.counters.rejected) + 1)
        << "two evaluations a step";
  }
}

TEST(Adams, LeavesSingularPositionsToRungeKutta) {
  Dynamics dynamics(four_bars(2), {}, {.method = IntegrationMethod::adams});
  const AnalysisReport report = run_dynamics(dynamics, TimeGrid::instant(5), {}, [](const Snapshot&) {});
  ASSERT_EQ(report.warnings.size(), 1u);
  EXPECT_NE(report.warnings[0].find("Runge-Kutta took"), std::string::npos) << report.warnings[0];
}

}  // namespace
}  // namespace catena
