// What `tolerance` promises: on motions that are not chaotic the error, in lengths of the scene or rad, is at most ten
// times what was asked for, however short or long they are. References are runs of the same code at 2e-13, whose errors
// other tests compare with independent solutions.
#include "analysis/sanitized.hpp"
#include "catena/elements/constraints/absolute_distance.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/dynamics_mechanisms.hpp"

namespace catena {
namespace {

using testing::four_bars;
using testing::rod_chain;
using testing::run_dynamics;
using testing::squeezer;

/// Configurations at 20 instants of a run of so many seconds.
std::vector<std::vector<double>> configurations(const std::shared_ptr<Model>& model, double until,
                                                const DynamicsOptions& options, double* length) {
  std::vector<std::vector<double>> rows;
  Dynamics dynamics(model, {}, options);
  *length = dynamics.evaluator().length_scale();
  run_dynamics(dynamics, TimeGrid::range(0, until, until / 20), {},
               [&](const Snapshot& s) { rows.emplace_back(s.q.begin(), s.q.end()); });
  return rows;
}

/// Largest error divided by the tolerance, for tolerances down to `smallest`.
void check(const std::shared_ptr<Model>& model, double until, IntegrationMethod method, double smallest) {
  double length = 1;
  const auto exact = configurations(model, until, {.tolerance = 2e-13}, &length);
  for (double tolerance = 1e-3; tolerance > 0.5 * smallest; tolerance /= 10) {
    const auto rows = configurations(model, until, {.method = method, .tolerance = tolerance}, &length);
    double error = 0;
    for (std::size_t k = 0; k < exact.size(); ++k) {
      for (std::size_t c = 0; c < exact[k].size(); ++c) {
        error = std::max(error, std::abs(rows.at(k)[c] - exact[k][c]) / (c % 3 == 2 ? 1 : length));
      }
    }
    EXPECT_LE(error, 10 * tolerance) << tolerance;
    EXPECT_GT(error, 0) << "two runs at different tolerances cannot agree to the last digit";
  }
}

std::shared_ptr<Model> ball_on_spring(double damping) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int ball = model->add_body("ball", {.mass = 1, .position = {1, 0}, .particle = true});
  SpringDamper<> spring;
  spring.k = 50;
  spring.c = damping;
  spring.length = 1;
  model->add_force("spring", spring, ground, ball);
  return model;
}

class DynamicsCalibration : public ::testing::TestWithParam<IntegrationMethod> {};

TEST_P(DynamicsCalibration, PendulumFromABriefRunToManySwings) {
  for (const double until : {1.0, 10.0, 100.0}) check(rod_chain(1), until, GetParam(), 1e-9);
}
TEST_P(DynamicsCalibration, Chains) {
  check(rod_chain(2), 1, GetParam(), 1e-10);
  // Matrices of implicit steps take minutes beside sanitizers.
  if (testing::is_sanitized && GetParam() == IntegrationMethod::radau) return;
  check(rod_chain(10), 1, GetParam(), 1e-10);
  check(rod_chain(40), 0.5, GetParam(), 1e-9);
  check(rod_chain(40, 0.025, 0.025), 0.2, GetParam(), 1e-9);
}
TEST_P(DynamicsCalibration, Springs) {
  check(ball_on_spring(0), 5, GetParam(), 1e-10);
  check(ball_on_spring(2), 5, GetParam(), 1e-10);
}
TEST_P(DynamicsCalibration, Squeezer) { check(squeezer(), 0.03, GetParam(), 1e-10); }
TEST_P(DynamicsCalibration, FourBarsThroughTheFlatPosition) { check(four_bars(2), 5, GetParam(), 1e-8); }

std::string method_name(const ::testing::TestParamInfo<IntegrationMethod>& info) {
  return std::string(to_string(info.param));
}
INSTANTIATE_TEST_SUITE_P(Methods, DynamicsCalibration, ::testing::ValuesIn(testing::all_methods), method_name);

// A thousand swings: errors of energy would turn into errors of phase.
TEST(DynamicsLongRun, PendulumOverTwoThousandSeconds) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int ball = model->add_body("ball", {.mass = 1, .position = {1, 0}, .particle = true});
  model->add("link", AbsoluteDistance<>{{0, 0}, {0, 0}}, ball, ground, 1.0);
  const auto want = testing::reference_values("A01_udc_2000s").at("t=2000");
  for (const double tolerance : {1e-3, 1e-6, 1e-8}) {
    Dynamics dynamics(model, {}, {.tolerance = tolerance});
    run_dynamics(dynamics, TimeGrid::instant(2000), {}, [&](const Snapshot& s) {
      EXPECT_NEAR(testing::frame_of(s, ball).x, want.at("x").get<double>(), 10 * tolerance);
      EXPECT_NEAR(testing::frame_of(s, ball).y, want.at("y").get<double>(), 10 * tolerance);
    });
  }
}

}  // namespace
}  // namespace catena
