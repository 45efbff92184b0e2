// Gradients by one solve, or one way back, for any number of parameters: of equilibria and motions, against closed
// forms and against derivatives carried forward.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/sensitivity/motion_adjoint.hpp"
#include "catena/analysis/sensitivity/motion_derivatives.hpp"
#include "catena/analysis/statics/equilibrium_gradient.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "catena/scene/models/scene_models.hpp"
#include "catena/scene/reading/scene_reader.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// Rods of any lengths and masses between two pins at the same height. Moments about the middles of rods make the
/// tangent of rod k (V + (m_1 + ... + m_k-1 + m_k / 2) g) / H, H and V the forces at the first pin; both follow from
/// where the last one ends.
struct HangingRods {
  std::vector<long double> length, mass;
  long double span;
  static constexpr long double g = 9.81L;

  /// H and V by Newton's method.
  std::array<long double, 2> pin_forces() const {
    long double h = 0, v = 0;
    for (const long double m : mass) h += m * g, v -= m * g / 2;
    for (int n = 0; n < 200; ++n) {
      long double x = -span, y = 0, xh = 0, xv = 0, yh = 0, yv = 0, hung = 0;
      for (std::size_t k = 0; k < length.size(); ++k) {
        const long double w = v + (hung + mass[k] / 2) * g, r = std::hypot(h, w);
        hung += mass[k];
        x += length[k] * h / r;
        y += length[k] * w / r;
        xh += length[k] * w * w / (r * r * r);
        xv -= length[k] * h * w / (r * r * r);
        yh -= length[k] * h * w / (r * r * r);
        yv += length[k] * h * h / (r * r * r);
      }
      const long double det = xh * yv - xv * yh;
      // Shortened where it would turn the chain over.
      const long double dh = -(x * yv - y * xv) / det, dv = -(y * xh - x * yh) / det;
      const long double part = dh < -0.5L * h ? -0.5L * h / dh : 1;
      h += part * dh;
      v += part * dv;
    }
    return {h, v};
  }
};

std::shared_ptr<Model> model_of(const HangingRods& rods) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  double x = 0;
  for (std::size_t k = 0; k < rods.length.size(); ++k) {
    const auto l = static_cast<double>(rods.length[k]), m = static_cast<double>(rods.mass[k]);
    // A first guess that hangs: two straight halves.
    const double slope = k < rods.length.size() / 2 ? -0.7 : 0.7;
    const int body = model->add_body(
        "rod" + std::to_string(k),
        {.mass = m, .inertia = m * l * l / 12, .position = {x + l / 2 * std::cos(slope), -0.3}, .angle = slope});
    const double before = k == 0 ? 0 : static_cast<double>(rods.length[k - 1]) / 2;
    model->add("", Revolute<>{{before, 0}, {-l / 2, 0}}, k == 0 ? ground : body - 1, body);
    x += l * std::cos(slope);
  }
  model->add("", Revolute<>{{static_cast<double>(rods.span), 0}, {static_cast<double>(rods.length.back()) / 2, 0}},
             ground, static_cast<int>(rods.length.size()) - 1);
  return model;
}

/// dH by the lengths, from the pins: number k is pinned to its neighbours at the middle of its length on either side.
std::vector<double> by_lengths(const EquilibriumGradient& gradient, std::size_t rods) {
  const auto pins = gradient.by_constraints<Revolute>([](int, const Revolute<double>& pin) {
    return Revolute<DesignScalar>{{DesignScalar::variable(pin.s_i.x, 0), pin.s_i.y},
                                  {DesignScalar::variable(pin.s_j.x, 1), pin.s_j.y}};
  });
  std::vector<double> all(rods);
  for (std::size_t k = 0; k + 1 < rods; ++k) all[k] = -pins[k][1] / 2 + pins[k + 1][0] / 2;
  // The last pin has the ground first.
  all[rods - 1] = -pins[rods - 1][1] / 2 + pins[rods][1] / 2;
  return all;
}

TEST(EquilibriumGradient, OfTheTensionOfRodsThatHangIsThatOfTheClosedForm) {
  std::mt19937_64 random(7);
  std::uniform_real_distribution<double> any(0.7, 1.3);
  for (const std::size_t n : {2u, 5u, 40u}) {
    HangingRods rods{{}, {}, 0.7L * static_cast<long double>(n)};
    for (std::size_t k = 0; k < n; ++k) rods.length.push_back(any(random)), rods.mass.push_back(any(random));
    Equilibrium rest(model_of(rods));
    const EquilibriumReport report = rest.solve();
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_NEAR(rest.lambda()[0], static_cast<double>(rods.pin_forces()[0]), 1e-9 * rest.lambda()[0]);
    const auto before = rest.evaluator().counters.factorizations;
    EquilibriumGradient gradient(rest);
    ASSERT_TRUE(gradient.measure_multiplier(0, 0));
    EXPECT_EQ(rest.evaluator().counters.factorizations, before) << "factors of the certificate were at hand";
    const std::vector<double> lengths = by_lengths(gradient, n), masses = gradient.by_masses();
    const auto exact = [&](std::vector<long double> HangingRods::*what, std::size_t k) {
      constexpr long double h = 1e-4L;
      const auto tension = [&](long double by) {
        HangingRods moved = rods;
        (moved.*what)[k] += by;
        return moved.pin_forces()[0];
      };
      return static_cast<double>((tension(-2 * h) - 8 * tension(-h) + 8 * tension(h) - tension(2 * h)) / (12 * h));
    };
    double largest = 0;
    for (const double d : lengths) largest = std::max(largest, std::abs(d));
    for (std::size_t k = 0; k < n; ++k) {
      EXPECT_NEAR(lengths[k], exact(&HangingRods::length, k), 1e-9 * largest) << n << " rods, length " << k;
      EXPECT_NEAR(masses[k], exact(&HangingRods::mass, k), 1e-9 * largest) << n << " rods, mass " << k;
    }
  }
}

// A mass m on two springs in a row, k1 above: y = -l1 - l2 - m g / k1 - m g / k2.
TEST(EquilibriumGradient, BySpringsAndOfAPlace) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -10};
  model->add_body("upper", {.mass = 0.001, .position = {0, -1}, .particle = true});
  model->add_body("lower", {.mass = 3, .position = {0, -2}, .particle = true});
  SpringDamper<> upper, lower;
  upper.k = 500, upper.length = 0.8;
  lower.k = 200, lower.length = 0.9;
  model->add_force("", upper, ground, 0);
  model->add_force("", lower, 0, 1);
  Equilibrium rest(model);
  ASSERT_TRUE(rest.solve().ok());
  EquilibriumGradient gradient(rest);
  const std::vector<double> height{0, 0, 0, 0, 1, 0};
  ASSERT_TRUE(gradient.measure(height, {}));
  const auto springs = gradient.by_forces<SpringDamper>([](int, const SpringDamper<double>& spring) {
    SpringDamper<DesignScalar> lifted;
    lifted.k = DesignScalar::variable(spring.k, 0);
    lifted.length = DesignScalar::variable(spring.length, 1);
    return lifted;
  });
  EXPECT_NEAR(springs[0][0], 30.01 / (500.0 * 500), 1e-12);
  EXPECT_NEAR(springs[1][0], 30 / (200.0 * 200), 1e-12);
  EXPECT_NEAR(springs[0][1], -1, 1e-11);
  EXPECT_NEAR(springs[1][1], -1, 1e-11);
  EXPECT_NEAR(gradient.by_masses()[1], -10 * (1 / 500.0 + 1 / 200.0), 1e-12);
}

TEST(EquilibriumGradient, RefusesWhatHasNone) {
  auto model = std::make_shared<Model>();
  model->add_body("bob", {.mass = 1, .position = {0, -1}, .particle = true});
  Equilibrium never(model);
  EXPECT_THROW(EquilibriumGradient{never}, std::invalid_argument);
}

// A hanging balance of 0.1 m x 3 kg against 0.3 m x 1 kg and 1e-12 of it more, which its certificate takes for
// rounding; its matrix is regular.
TEST(EquilibriumGradient, RefusesANeutralPlaceAsItsCertificateJudgesIt) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -9.81};
  const double down = -std::acos(0.0);
  const int beam = model->add_body("beam", {.mass = 3, .inertia = 1, .position = {0, 0.1}, .angle = down});
  Revolute<> pin;
  pin.s_j = {0.1, 0};
  model->add("pin", pin, ground, beam);
  PointForce<> weight;
  weight.s_i = {0.1 + 0.3, 0};
  model->add_force("weight", weight, beam, ground,
                   {TimeFunction<double>(0.0), TimeFunction<double>(-9.81 * (1 + 1e-12))});
  Equilibrium rest(model);
  const EquilibriumReport report = rest.solve();
  ASSERT_TRUE(report.ok()) << report.message;
  ASSERT_TRUE(rest.is_neutral());
  EquilibriumGradient gradient(rest);
  EXPECT_FALSE(gradient.measure(std::vector<double>{0, 0, 1}, {}));
}

/// A scene, its models, and derivatives both ways along its motion.
class BothWays final : public RowObserver {
 public:
  BothWays(const std::string& text, double until, double tolerance, IntegrationMethod method = IntegrationMethod::rk8)
      : scene_(read_scene(SourceText("motion", text), diagnostics_)), models_(*scene_, 1000) {
    model_ = models_.model(scene_->parameters, {});
    for (int p = 0; p < static_cast<int>(scene_->parameters.names().size()); ++p) parameters_.push_back(p);
    Dynamics motion(model_, {}, {.method = method, .tolerance = tolerance});
    const auto count = static_cast<int>(parameters_.size());
    const DesignModels designs = models_.designs(scene_->parameters, {}, parameters_);
    forward.emplace(motion.evaluator(), designs, count, GivenByModel{});
    adjoint.emplace(motion.evaluator(), designs, count, GivenByModel{});
    report = motion.run(TimeGrid::instant(until), {.velocity = true}, *this);
  }
  std::size_t parameters() const { return parameters_.size(); }
  bool wants_stretches() const override { return true; }
  bool cover(const MotionStretch& stretch) override {
    forward->cover(stretch);
    adjoint->cover(stretch);
    last_ = stretch.to;
    return true;
  }
  bool observe(const Snapshot& snapshot) override {
    found = forward->find(snapshot);
    end = snapshot.t;
    coordinates = snapshot.q.size();
    return true;
  }

  std::optional<MotionDerivatives> forward;
  std::optional<MotionAdjoint> adjoint;
  AnalysisReport report;
  bool found = false;
  double end = 0;
  std::size_t coordinates = 0;

 private:
  Diagnostics diagnostics_{10};
  std::unique_ptr<SceneTemplate> scene_;
  SceneModels models_;
  std::shared_ptr<const Model> model_;
  std::vector<int> parameters_;
  double last_ = 0;
};

constexpr const char* slider_crank = R"--({"catena": 1, "gravity": [0, "=-g"],
  "parameters": {"a": 0.5, "b": 1.3, "k": 60, "c": 0.9, "m": 2, "g": 9.81, "l": 0.8, "e": 0.1, "d": 0.05, "n": 0.7},
  "bodies": {"one": {"rod": {"from": [0, 0], "to": ["=a*cos(0.8)", "=a*sin(0.8)"]}, "mass": "m"},
    "two": {"rod": {"from": ["=a*cos(0.8)", "=a*sin(0.8)"], "to": ["=a*cos(0.8)+sqrt(b^2-(a*sin(0.8)-e)^2)", "e"]},
            "mass": "n"},
    "slider": {"mass": 1.5, "inertia": 0.1, "position": ["=a*cos(0.8)+sqrt(b^2-(a*sin(0.8)-e)^2)", "e"]}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "one.from", "c": "d"},
    {"type": "revolute", "i": "one.to", "j": "two.from"}, {"type": "revolute", "i": "two.to", "j": "slider"},
    {"type": "translational", "i": ["ground", [0, "e"]], "j": "slider", "axis_i": [1, 0]}],
  "forces": [{"type": "spring_damper", "i": ["ground", [2.5, 0.3]], "j": "slider", "k": "k", "c": "c", "length": "l"}],
  "analyses": []})--";

constexpr const char* driven_arm = R"({"catena": 1, "gravity": [0, -9.81],
  "parameters": {"a": 0.6, "b": 0.9, "w": 1.3, "m": 2, "k": 12},
  "bodies": {"one": {"rod": {"from": [0, 0], "to": ["a", 0]}, "mass": "m"},
    "two": {"rod": {"from": ["a", 0], "to": ["=a+b", 0]}, "mass": 1.1}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "one.from"}, {"type": "revolute", "i": "one.to", "j": "two.from"}],
  "drivers": [{"type": "relative_angle", "i": "one", "j": "two", "value": {"polynomial": [0, 0, "w"]}}],
  "forces": [{"type": "torsion_spring", "i": "ground", "j": "one", "k": "k"}],
  "analyses": []})";

// A tip so light that solutions are refined one after the other instead of four side by side.
constexpr const char* light_tip = R"({"catena": 1, "gravity": [0, -9.81],
  "parameters": {"a": 0.6, "b": 0.9, "c": 0.02, "m": 2, "n": 4e-6},
  "bodies": {"one": {"rod": {"from": [0, 0], "to": ["a", 0]}, "mass": "m"},
    "two": {"rod": {"from": ["a", 0], "to": ["=a+b", 0]}, "mass": "n"}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "one.from"}, {"type": "revolute", "i": "one.to", "j": "two.from"}],
  "forces": [{"type": "torsion_spring", "i": "ground", "j": "one", "k": 12, "c": "c"}],
  "analyses": []})";

class Adjoint : public ::testing::TestWithParam<const char*> {};

// Both transpose the same steps: the difference is rounding.
TEST_P(Adjoint, IsTheForwardDerivativeBackwards) {
  BothWays both(GetParam(), 1.2, 1e-9);
  ASSERT_TRUE(both.report.ok()) << both.report.message;
  ASSERT_TRUE(both.found) << both.forward->why();
  EXPECT_LT(both.adjoint->reached_elements(), 12 * static_cast<int>(both.parameters()));
  for (std::size_t c = 0; c + 3 < both.coordinates; ++c) {
    MotionPulse pulse{both.end, std::vector<double>(both.coordinates, 0.0), {}};
    pulse.by_q[c] = 1;
    const auto gradient = both.adjoint->gradient({pulse});
    ASSERT_TRUE(gradient) << both.adjoint->why();
    for (std::size_t p = 0; p < both.parameters(); ++p) {
      const double forward = both.forward->configuration(p / 4)[c].d[p % 4];
      EXPECT_NEAR((*gradient)[p], forward, 1e-9 * (1 + std::abs(forward))) << "coordinate " << c << ", parameter " << p;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Mechanisms, Adjoint, ::testing::Values(slider_crank, driven_arm, light_tip));

// x - l = A cos(w t), w^2 = k / m, at the end and inside of a step.
TEST(AdjointOfAMotion, IsThatOfTheClosedForm) {
  BothWays both(R"({"catena": 1, "parameters": {"k": 50, "m": 2, "s": 1.3, "l": 1},
    "bodies": {"b": {"mass": "m", "inertia": 1, "position": ["s", 0]}},
    "constraints": [{"type": "absolute_y", "i": "b"}, {"type": "absolute_angle", "i": "b"}],
    "forces": [{"type": "spring_damper", "i": "ground", "j": "b", "k": "k", "length": "l"}],
    "analyses": []})",
                2, 1e-11);
  ASSERT_TRUE(both.report.ok()) << both.report.message;
  for (const double t : {2.0, 1.37, 0.001}) {
    const double w = std::sqrt(50 / 2.0), amplitude = 0.3, slope = amplitude * t * std::sin(w * t) * w / 2;
    MotionPulse place{t, std::vector<double>(both.coordinates, 0.0), {}};
    place.by_q[0] = 1;
    const auto of_place = both.adjoint->gradient({place});
    ASSERT_TRUE(of_place) << both.adjoint->why();
    EXPECT_NEAR((*of_place)[0], -slope / 50, 1e-9);
    EXPECT_NEAR((*of_place)[1], slope / 2, 1e-9);
    EXPECT_NEAR((*of_place)[2], std::cos(w * t), 1e-9);
    EXPECT_NEAR((*of_place)[3], 1 - std::cos(w * t), 1e-9);
    MotionPulse velocity{t, {}, place.by_q};
    const auto of_velocity = both.adjoint->gradient({velocity});
    ASSERT_TRUE(of_velocity) << both.adjoint->why();
    EXPECT_NEAR((*of_velocity)[2], -w * std::sin(w * t), 1e-8);
    const auto of_both = both.adjoint->gradient({place, velocity});
    EXPECT_NEAR((*of_both)[2], (*of_place)[2] + (*of_velocity)[2], 1e-10);
  }
}

// The short steps of another method are gone back over several at once: within the tolerance of the motion.
TEST(AdjointOfAMotion, JoinsTheStepsOfAnotherMethod) {
  BothWays both(slider_crank, 1.2, 1e-8, IntegrationMethod::adams);
  ASSERT_TRUE(both.report.ok()) << both.report.message;
  ASSERT_TRUE(both.found) << both.forward->why();
  MotionPulse pulse{both.end, std::vector<double>(both.coordinates, 0.0), {}};
  pulse.by_q[0] = pulse.by_q[5] = 1;
  const auto gradient = both.adjoint->gradient({pulse});
  ASSERT_TRUE(gradient) << both.adjoint->why();
  EXPECT_LT(both.adjoint->blocks(), both.adjoint->steps());
  EXPECT_LT(both.forward->blocks(), both.adjoint->steps());
  for (std::size_t p = 0; p < both.parameters(); ++p) {
    const double forward =
        both.forward->configuration(p / 4)[0].d[p % 4] + both.forward->configuration(p / 4)[5].d[p % 4];
    EXPECT_NEAR((*gradient)[p], forward, 1e-6 * (1 + std::abs(forward))) << "parameter " << p;
  }
}

TEST(AdjointOfAMotion, SaysWhatItDoesNotPass) {
  BothWays law(R"({"catena": 1, "parameters": {"k": 2}, "bodies": {"b": {"mass": 1, "inertia": 1, "angle": 0.3}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "b"}],
    "forces": [{"type": "torque", "i": "b", "torque": "=-k*b.angle"}], "analyses": []})",
               1, 1e-8);
  ASSERT_TRUE(law.found) << law.forward->why();
  EXPECT_FALSE(law.adjoint->gradient({}));
  EXPECT_NE(law.adjoint->why().find("laws of state"), std::string::npos) << law.adjoint->why();
}

}  // namespace
}  // namespace catena::testing
