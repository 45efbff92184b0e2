// What methods of integration have of their own, beside the correct motion that all of them give.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "catena/analysis/motion/stage_sums.hpp"
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

// Sums of vectors are those of plain loops to the last bit, whatever the length and the instructions in use.
TEST(Integrators, SumsOverStagesAreRoundedAsPlainLoopsRoundThem) {
  const std::array<StageTerm, 3> terms{StageTerm{0, 0.3}, StageTerm{2, -1.7}, StageTerm{1, 0.9}};
  for (std::size_t size = 0; size <= 40; ++size) {
    std::array<std::vector<double>, 3> slope;
    for (std::size_t k = 0; k < slope.size(); ++k) {
      for (std::size_t i = 0; i < size; ++i) slope[k].push_back(std::sin(1.0 + static_cast<double>(7 * i + k)));
    }
    for (const bool begins : {false, true}) {
      std::vector<double> found(size, 0.5), expected(size, begins ? 0.5 : 0.0);
      for (std::size_t i = 0; i < size; ++i) {
        for (const StageTerm& term : terms)
          expected[i] += 0.01 * term.weight * slope[static_cast<std::size_t>(term.stage)][i];
      }
      std::vector<double> by_baseline = found;
      const auto from = [&](const std::vector<double>& begin) {
        return begins ? std::span<const double>(begin) : std::span<const double>();
      };
      const auto slope_of = [&](int stage) { return slope[static_cast<std::size_t>(stage)].data(); };
      add_stages(from(found), 0.01, terms, slope_of, found);
      EXPECT_EQ(found, expected);
      // The form of processors without wide registers, whatever this one has.
      detail::add_weighted_baseline(detail::weighted_stages(from(by_baseline), 0.01, terms, slope_of), size,
                                    by_baseline.data());
      EXPECT_EQ(by_baseline, expected);
    }
  }
}

// Without the velocities of stages: as with them, in the rows that are asked for alone.
TEST(Integrators, StagesOfSecondOrderAreThoseOfTheFirst) {
  constexpr std::size_t width = 4, rows = 5, size = width * rows;
  constexpr double h = 0.3;
  const Tableau& table = dormand_prince_8();
  const auto stages = static_cast<std::size_t>(table.stages);
  const auto some = [](double phase) {
    std::vector<double> x;
    for (std::size_t i = 0; i < size; ++i) x.push_back(std::sin(phase + static_cast<double>(3 * i)));
    return x;
  };
  const std::vector<double> q0 = some(0.1), v0 = some(0.2);
  std::vector<std::vector<double>> slope, velocity(stages, std::vector<double>(size));
  for (std::size_t s = 0; s < stages; ++s) slope.push_back(some(1.0 + static_cast<double>(s)));
  const std::vector<int> which{0, 3};
  for (std::size_t s = 0; s <= stages; ++s) {
    const StageSum& sum = s < stages ? table.a[s] : table.b;
    std::vector<double> q(size), v(size), found_q(size, 7.0), found_v(size, 7.0);
    add_stages(
        q0, h, sum, [&](int k) { return velocity[static_cast<std::size_t>(k)].data(); }, q);
    add_stages(
        v0, h, sum, [&](int k) { return slope[static_cast<std::size_t>(k)].data(); }, v);
    if (s < stages) velocity[s] = v;
    const StageWeights& weights = second_order_weights()[s];
    SecondOrderSum second{.q = q0.data(), .v = v0.data(), .way = h * weights.way, .terms = weights.terms};
    for (std::size_t k = 0; k < weights.terms; ++k) {
      second.slope[k] = slope[static_cast<std::size_t>(weights.stage[k])].data();
      second.of_q[k] = h * h * weights.of_q[k];
      second.of_v[k] = h * weights.of_v[k];
    }
    add_weighted_rows(second, which, width, found_q.data(), found_v.data());
    for (std::size_t i = 0; i < size; ++i) {
      const bool asked = i / width == 0 || i / width == 3;
      EXPECT_NEAR(found_q[i], asked ? q[i] : 7.0, 1e-13) << s;
      EXPECT_NEAR(found_v[i], asked ? v[i] : 7.0, 1e-13) << s;
    }
  }
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
  ASSERT_EQ(report.warnings.size(), 2u);
  EXPECT_NE(report.warnings[0].find("singular positions were projected"), std::string::npos) << report.warnings[0];
  EXPECT_NE(report.warnings[1].find("branch"), std::string::npos) << report.warnings[1];
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
  ASSERT_EQ(report.warnings.size(), 2u);
  EXPECT_NE(report.warnings[0].find("Runge-Kutta took"), std::string::npos) << report.warnings[0];
  EXPECT_NE(report.warnings[1].find("branch"), std::string::npos) << report.warnings[1];
}

// A pendulum that turns over and over: neither x nor y of its middle serves all the way round.
TEST(Partitioning, ChoosesAnewWhereTheChoiceTurnsBad) {
  const auto model = rod_chain(1);
  BasicBody<double>& rod = model->bodies[0];
  rod.velocity = {0, 5};
  rod.angular_velocity = 10;
  rod.inertia = 1e-6;  // beside m L^2 / 4
  rod.velocity_given = rod.angular_velocity_given = true;
  const double exact = last_angle(model, {.tolerance = 1e-12}, 5);
  AnalysisReport report;
  const double angle = last_angle(model, {.method = IntegrationMethod::partitioning, .tolerance = 1e-8}, 5, &report);
  EXPECT_GT(exact, 4 * std::numbers::pi) << "it was meant to turn over";
  EXPECT_NEAR(angle, exact, 1e-7);
}

// Redundant rows: as many dependent coordinates as the rank, not as rows.
TEST(Partitioning, CountsFreedomsByRank) {
  Dynamics partitioned(four_bars(3), {}, {.method = IntegrationMethod::partitioning}), projected(four_bars(3));
  std::vector<double> a, b;
  run_dynamics(partitioned, TimeGrid::instant(0.4), {}, [&](const Snapshot& s) { a.assign(s.q.begin(), s.q.end()); });
  run_dynamics(projected, TimeGrid::instant(0.4), {}, [&](const Snapshot& s) { b.assign(s.q.begin(), s.q.end()); });
  for (std::size_t k = 0; k < a.size(); ++k) EXPECT_NEAR(a[k], b[k], 1e-7) << k;
}

TEST(Partitioning, RefusesMoreFreedomsThanADenseBasisHolds) {
  Dynamics dynamics(rod_chain(600), {}, {.method = IntegrationMethod::partitioning});
  RowFunction none([](const Snapshot&) { return true; });
  const AnalysisReport report = dynamics.run(TimeGrid::instant(0.01), {}, none);
  EXPECT_EQ(report.status, Status::refused);
  EXPECT_NE(report.message.find("600 degrees of freedom"), std::string::npos) << report.message;
}

/// A rod that carries one that is 1 / factor times as heavy.
std::shared_ptr<Model> light_link(double factor) {
  auto model = rod_chain(2);
  model->bodies[0].mass *= factor;
  model->bodies[0].inertia *= factor;
  return model;
}

// Accelerations are as exact as if the light link had no mass: no method needs shorter steps for it.
TEST(Integrators, PassOverALightLinkThatCarriesAHeavyRod) {
  for (const IntegrationMethod method : testing::all_methods) {
    const DynamicsOptions options{.method = method, .tolerance = 1e-10};
    AnalysisReport massless;
    const double exact = last_angle(light_link(0), options, 1, &massless);
    for (const double factor : {1e-6, 1e-8, 1e-9}) {
      AnalysisReport report;
      EXPECT_NEAR(last_angle(light_link(factor), options, 1, &report), exact, 0.2 * factor + 1e-9)
          << to_string(method) << " " << factor;
      EXPECT_LT(report.counters.steps, 2 * massless.counters.steps) << to_string(method) << " " << factor;
    }
  }
}

// A stiff spring on a light ball: the run would take some 10^8 steps, and says so after some 10^4.
TEST(Integrators, EndWhereStepsWillNotDo) {
  auto model = std::make_shared<Model>();
  const int ball = model->add_body("ball", {.mass = 1e-6, .position = {1.1, 0}, .particle = true});
  SpringDamper<> spring;
  spring.k = 1e6;
  spring.length = 1;
  model->add_force("spring", spring, ground, ball);
  RowFunction none([](const Snapshot&) { return true; });
  for (const IntegrationMethod method : {IntegrationMethod::rk8, IntegrationMethod::adams}) {
    Dynamics long_run(model, {}, {.method = method}), bounded(model, {}, {.method = method, .max_steps = 500});
    const AnalysisReport hopeless = long_run.run(TimeGrid::instant(1000), {}, none);
    EXPECT_EQ(hopeless.status, Status::step_too_small);
    EXPECT_NE(hopeless.message.find("many more than max_steps"), std::string::npos) << hopeless.message;
    EXPECT_NE(hopeless.message.find("\"ball\""), std::string::npos) << hopeless.message;
    EXPECT_LT(hopeless.counters.steps, 100'000);
    const AnalysisReport used_up = bounded.run(TimeGrid::instant(0.01), {}, none);
    EXPECT_EQ(used_up.status, Status::not_converged);
    EXPECT_NEAR(static_cast<double>(used_up.counters.steps + used_up.counters.rejected), 500, 5);
  }
}

TEST(AutomaticMethod, IsMultistepForLongOpenChainsOnly) {
  EXPECT_EQ(Dynamics(rod_chain(40)).method(), IntegrationMethod::adams);
  EXPECT_EQ(Dynamics(rod_chain(40), {}, {.tolerance = 1e-13}).method(), IntegrationMethod::rk8);
  EXPECT_EQ(Dynamics(rod_chain(40), {}, {.step = 0.01}).method(), IntegrationMethod::rk8);
  EXPECT_EQ(Dynamics(rod_chain(2)).method(), IntegrationMethod::rk8);
  EXPECT_EQ(Dynamics(four_bars(20)).method(), IntegrationMethod::rk8);
  EXPECT_EQ(Dynamics(rod_chain(40), {}, {.method = IntegrationMethod::rk5}).method(), IntegrationMethod::rk5);
}

}  // namespace
}  // namespace catena
