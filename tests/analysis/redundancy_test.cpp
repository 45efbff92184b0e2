// More equations than coordinates: which constraints are called redundant, and contradictions told from repetitions.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <set>

#include "analysis/linkages.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/gear.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {
namespace {

using Names = std::set<std::string>;

struct Check {
  explicit Check(const Model& m) : model(m), plan(Plan::make(model)), evaluator(plan, model, work) {
    evaluator.set_time(0);
    report = analyse_mobility(evaluator, evaluator.given_configuration());
  }
  Names redundant() const { return names(report.redundant_elements); }
  Names contradictory() const { return names(report.contradictory_elements); }
  Names follows_from(std::size_t k) const { return names(report.dependent_on.at(k)); }
  Names names(const std::vector<int>& elements) const {
    Names found;
    for (int element : elements) found.insert(std::string(model.element_name(element)));
    return found;
  }

  const Model& model;
  std::shared_ptr<const Plan> plan;
  EvaluationWork work;
  Evaluator evaluator;
  MobilityReport report;
};

AnalysisReport run(std::shared_ptr<const Model> model, int* rows = nullptr, bool accelerations = true) {
  Kinematics kinematics(std::move(model));
  RowFunction count([&](const Snapshot&) {
    if (rows) ++*rows;
    return true;
  });
  return kinematics.run(TimeGrid::range(0, 2, 0.1), {.velocity = true, .acceleration = accelerations}, count);
}

TEST(Redundancy, OfADoubledJointTheSecondIsNamed) {
  auto model = driven_four_bar({}, ramp(1, 1));
  pin(*model, "A again", model->find_body("crank"), "to", model->find_body("coupler"), "from");
  const Check check(*model);
  EXPECT_EQ(check.redundant(), Names{"A again"});
  EXPECT_EQ(check.follows_from(0), Names{"A"});
  EXPECT_TRUE(check.contradictory().empty());
  const AnalysisReport report = run(model);
  EXPECT_TRUE(report.ok()) << report.message;
  EXPECT_EQ(report.redundant, std::vector<std::string>{"A again"});
}

// Three planets between a sun and a ring: of each further planet one mesh is too many, not its pin.
TEST(Redundancy, OfAPlanetarySetGearsAreNamed) {
  auto model = std::make_shared<Model>();
  const double sun_radius = 2, planet_radius = 1, ring_radius = 4;
  const int sun = model->add_body("sun", {}), carrier = model->add_body("carrier", {}),
            ring = model->add_body("ring", {});
  model->add("sun bearing", Revolute<>{}, ground, sun);
  model->add("carrier bearing", Revolute<>{}, ground, carrier);
  model->add("ring bearing", Revolute<>{}, ground, ring);
  for (int k = 0; k < 3; ++k) {
    const double angle = 2 * std::numbers::pi * k / 3;
    const Vec2<double> at = (sun_radius + planet_radius) * Vec2<double>{std::cos(angle), std::sin(angle)};
    const std::string n = std::to_string(k);
    const int planet = model->add_body("planet" + n, {.position = at});
    model->add("pin" + n, Revolute<>{at, {}}, carrier, planet);
    model->add("inner" + n, Gear<>{{}, {}, sun_radius, planet_radius, false, 0}, sun, planet);
    model->add("outer" + n, Gear<>{{}, {}, ring_radius, planet_radius, true, 0}, ring, planet);
  }
  model->add_driver("turn sun", AbsoluteAngle<>{}, sun, ground, ramp(0, 3));
  model->add_driver("turn ring", AbsoluteAngle<>{}, ring, ground, ramp(0, 0));
  const Check check(*model);
  EXPECT_EQ(check.redundant().size(), 2u);
  for (const std::string& name : check.redundant()) {
    EXPECT_TRUE(name.starts_with("inner") || name.starts_with("outer")) << name;
  }
  EXPECT_TRUE(check.contradictory().empty());
}

// Drivers that agree in place and differ in speed: nothing can move, and the first row says so.
TEST(Redundancy, DriversThatDifferInSpeedContradictEachOther) {
  auto model = driven_four_bar({}, ramp(1, 1));
  model->add_driver("other", AbsoluteAngle<>{}, model->find_body("crank"), ground, ramp(1, 1.5));
  const Check check(*model);
  EXPECT_EQ(check.redundant(), Names{"other"});
  EXPECT_EQ(check.follows_from(0), Names{"drive"});
  EXPECT_EQ(check.contradictory(), Names{"other"});
  int rows = 0;
  const AnalysisReport report = run(model, &rows);
  EXPECT_EQ(report.status, Status::inconsistent);
  EXPECT_EQ(rows, 0);
  for (const char* word : {"\"drive\"", "\"other\"", "velocity", "0.5 rad/s"}) {
    EXPECT_NE(report.message.find(word), std::string::npos) << report.message;
  }
}

TEST(Redundancy, DriversThatDifferInAccelerationContradictEachOther) {
  auto model = driven_four_bar({}, ramp(1, 1));
  model->add_driver("other", AbsoluteAngle<>{}, model->find_body("crank"), ground,
                    TimeFunction<double>::polynomial(std::array{1.0, 1.0, 0.25}));
  EXPECT_TRUE(Check(*model).contradictory().empty());
  int rows = 0;
  const AnalysisReport report = run(model, &rows);
  EXPECT_EQ(report.status, Status::inconsistent);
  EXPECT_EQ(rows, 0);
  EXPECT_NE(report.message.find("acceleration"), std::string::npos) << report.message;
  // The same where no accelerations are asked for.
  const AnalysisReport unasked = run(model, &rows, false);
  EXPECT_EQ(unasked.status, Status::inconsistent);
  EXPECT_EQ(rows, 0);
  EXPECT_NE(unasked.message.find("acceleration"), std::string::npos) << unasked.message;
}

// The drivers of crank and rocker as the four-bar itself moves them: more than it needs, and no contradiction.
TEST(Redundancy, DriversThatAgreeAreNoContradiction) {
  const FourBar bars;
  auto model = driven_four_bar(bars, ramp(1, 1));
  const auto rocker = [bars](double t) {
    const auto angle = [&](double s) { return bars.at(1 + s).rocker; };
    const double h = 1e-2;
    const auto slope = [&](int k) { return (angle(t + k * h) - angle(t - k * h)) / (2 * k * h); };
    const auto bend = [&](int k) { return (angle(t + k * h) - 2 * angle(t) + angle(t - k * h)) / (k * k * h * h); };
    return Taylor<double>{angle(t), 1.5 * slope(1) - 0.6 * slope(2) + 0.1 * slope(3),
                          1.5 * bend(1) - 0.6 * bend(2) + 0.1 * bend(3)};
  };
  model->add_driver("follow", AbsoluteAngle<>{}, model->find_body("rocker"), ground,
                    TimeFunction<double>::custom(rocker));
  const Check check(*model);
  EXPECT_EQ(check.redundant(), Names{"follow"});
  EXPECT_EQ(check.follows_from(0), (Names{"A", "B", "C", "O", "drive"}));
  const AnalysisReport report = run(model);
  EXPECT_TRUE(report.ok()) << report.message;
  EXPECT_EQ(report.redundant, std::vector<std::string>{"follow"});
}

}  // namespace
}  // namespace catena::testing
