// What --estimate-error promises: beside independent solutions the estimate is the error of the run that was asked for,
// within a factor, and the rows that are given are not worse than it says.
#include "catena/analysis/dynamics/error_estimate.hpp"

#include <map>

#include "catena/elements/forces/spring_damper.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/dynamics_mechanisms.hpp"

namespace catena {
namespace {

using testing::four_bars;
using testing::frame_of;
using testing::reference_values;
using testing::rod_chain;

/// Error of a row against the known answer at its instant.
using ErrorOfRow = std::function<double(const Snapshot&)>;

struct Problem {
  std::shared_ptr<Model> model;
  std::vector<double> times;
  ErrorOfRow error;
  bool angle = false;  ///< whether `error` is one of angles, else of positions
};

struct Errors {
  double asked = 0, given = 0, estimated = 0;
};

Errors errors_of(const Problem& problem, const DynamicsOptions& options) {
  Errors errors;
  const TimeGrid grid = TimeGrid::list(problem.times);
  RowFunction asked([&](const Snapshot& s) {
    errors.asked = std::max(errors.asked, problem.error(s));
    return true;
  });
  RowFunction given([&](const Snapshot& s) {
    errors.given = std::max(errors.given, problem.error(s));
    return true;
  });
  Dynamics plain(problem.model, {}, options);
  EXPECT_TRUE(plain.run(grid, {}, asked).ok());
  Dynamics finer(problem.model, {}, finer_options(options));
  WithErrorEstimate both(finer, problem.model, {}, options);
  EXPECT_TRUE(both.run(grid, {}, given).ok());
  errors.estimated = problem.angle ? both.error().angle.error : both.error().position.error;
  EXPECT_EQ(both.error().until, problem.times.back());
  return errors;
}

Problem double_pendulum() {
  const auto values = reference_values("double_pendulum_rods");
  return {.model = rod_chain(2),
          .times = {0.5, 1, 2},
          .error =
              [values](const Snapshot& s) {
                char name[16];
                std::snprintf(name, sizeof name, "t=%.1f", s.t);
                double error = 0;
                for (const int k : {0, 1}) {
                  const double want = values.at(name).at("theta" + std::to_string(k + 1)).get<double>();
                  error = std::max(error, std::abs(frame_of(s, k).phi + std::numbers::pi / 2 - want));
                }
                return error;
              },
          .angle = true};
}

Problem spring_pendulum() {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const int ball = model->add_body("ball", {.mass = 1, .position = {1, 0}, .particle = true});
  SpringDamper<> spring;
  spring.k = 50;
  spring.length = 1;
  model->add_force("spring", spring, ground, ball);
  const auto values = reference_values("spring_pendulum");
  return {.model = model, .times = {0.5, 1, 2, 5}, .error = [values, ball](const Snapshot& s) {
            char name[16];
            std::snprintf(name, sizeof name, "t=%.1f", s.t);
            const auto& want = values.at(name);
            return std::hypot(frame_of(s, ball).x - want.at("x").get<double>(),
                              frame_of(s, ball).y - want.at("y").get<double>());
          }};
}

// All links are parallel: one angle is all there is to know.
Problem four_bars_through_the_flat_position() {
  const auto values = reference_values("A02_n_four_bar_N2");
  return {.model = four_bars(2),
          .times = {1, 2, 5},
          .error =
              [values](const Snapshot& s) {
                char name[16];
                std::snprintf(name, sizeof name, "t=%.1f", s.t);
                const Vec2<double> end = frame_of(s, 0).point(Vec2<double>{0.5, 0});
                const double x = values.at(name).at("B0x").get<double>(), y = values.at(name).at("B0y").get<double>();
                return std::abs(std::remainder(std::atan2(end.y, end.x) - std::atan2(y, x), 2 * std::numbers::pi));
              },
          .angle = true};
}

// Against a run at 2e-13, which other tests compare with the Test Set's answer: at one instant alone the errors of two
// runs may happen to agree.
Problem squeezing_mechanism() {
  std::vector<double> times;
  for (int k = 1; k <= 10; ++k) times.push_back(0.003 * k);
  auto exact = std::make_shared<std::map<double, std::vector<double>>>();
  Dynamics dynamics(testing::squeezer(), {}, {.tolerance = 2e-13});
  testing::run_dynamics(dynamics, TimeGrid::list(times), {},
                        [&](const Snapshot& s) { (*exact)[s.t].assign(s.q.begin(), s.q.end()); });
  return {.model = testing::squeezer(),
          .times = times,
          .error =
              [exact](const Snapshot& s) {
                double error = 0;
                for (std::size_t c = 2; c < s.q.size(); c += 3)
                  error = std::max(error, std::abs(s.q[c] - exact->at(s.t)[c]));
                return error;
              },
          .angle = true};
}

// Errors below this cannot be told from those of the answers.
constexpr double known = 2e-12;

/// The estimate may differ from the error by this factor, either way; looser across singular positions, where errors of
/// single steps stand out.
void check(const Problem& problem, double factor) {
  for (const IntegrationMethod method : testing::all_methods) {
    for (double tolerance = 1e-4; tolerance > 0.5e-9; tolerance /= 10) {
      const Errors errors = errors_of(problem, {.method = method, .tolerance = tolerance});
      EXPECT_LE(errors.estimated, factor * errors.asked + known) << to_string(method) << " " << tolerance;
      EXPECT_GE(errors.estimated, errors.asked / factor - known) << to_string(method) << " " << tolerance;
      EXPECT_LE(errors.given, factor * errors.estimated + known) << to_string(method) << " " << tolerance;
      EXPECT_GT(errors.estimated, 0) << to_string(method) << " " << tolerance;
    }
  }
}

TEST(ErrorEstimate, DoublePendulum) { check(double_pendulum(), 1.5); }
TEST(ErrorEstimate, SpringPendulum) { check(spring_pendulum(), 1.5); }
TEST(ErrorEstimate, SqueezingMechanism) { check(squeezing_mechanism(), 3); }
TEST(ErrorEstimate, FourBarsThroughTheFlatPosition) { check(four_bars_through_the_flat_position(), 10); }

TEST(ErrorEstimate, FixedStepsAreHalved) {
  for (const IntegrationMethod method : testing::all_methods) {
    for (const double step : {0.04, 0.02, 0.01}) {
      const Errors errors = errors_of(double_pendulum(), {.method = method, .step = step});
      EXPECT_LE(errors.estimated, 1.5 * errors.asked + known) << to_string(method) << " " << step;
      EXPECT_GE(errors.estimated, errors.asked / 1.5 - known) << to_string(method) << " " << step;
      EXPECT_LE(errors.given, errors.estimated + known) << to_string(method) << " " << step;
    }
  }
}

TEST(ErrorEstimate, NeedsRoomBelowTheTolerance) {
  EXPECT_THROW(finer_options({.tolerance = 5e-14}), std::invalid_argument);
  EXPECT_EQ(finer_options({.tolerance = 1e-12}).tolerance, 1e-13);
  EXPECT_EQ(finer_options({.tolerance = 5e-14, .step = 0.1}).step, 0.05);
}

}  // namespace
}  // namespace catena
