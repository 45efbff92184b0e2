// Mechanisms that balance wherever they stand: springs without free length take the weight at every angle.
//
//   V = k |A - a u|^2 / 2 + m g L sin(theta),  A = (0, h), u along the arm:  constant where k a h = m g L
//
// Equilibrium leaves them as they are, and says that they are neutral; what does not balance beside them comes to rest.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "catena/analysis/equilibrium.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/static_scenes.hpp"

namespace catena::testing {
namespace {

class Balances {
 public:
  explicit Balances(unsigned seed) : random_(seed) {
    model_->gravity = {0, -earth};
    size_ = std::pow(10.0, uniform(-9, 9));
    weight_ = std::pow(10.0, uniform(-9, 9));
  }

  double uniform(double low, double high) { return low + (high - low) * (random_() / 4294967296.0); }

  // A massless arm on a pin, a mass at its end, as a particle or as a plate that a second bar keeps level.
  void add_arm(bool parallelogram) {
    const Vec2<double> foot{size_ * uniform(-5, 5), size_ * uniform(-5, 5)};
    const double length = size_ * uniform(0.2, 2), a = length * uniform(0.1, 0.9), h = length * uniform(0.1, 1);
    const double mass = weight_ * uniform(0.2, 2) / earth, angle = uniform(-3, 3);
    const Vec2<double> end = foot + length * Vec2<double>{std::cos(angle), std::sin(angle)};
    const int arm = model_->add_body(name("arm"), {.position = foot, .angle = angle});
    model_->add("", Revolute<double>{.s_i = foot, .s_j = {}}, ground, arm);
    BodyValues load{.mass = mass, .inertia = mass * length * length, .position = end};
    load.particle = !parallelogram;
    const int plate = model_->add_body(name("load"), load);
    model_->add("", Revolute<double>{.s_i = {length, 0}, .s_j = {}}, arm, plate);
    if (parallelogram) {
      const Vec2<double> up{0, length * uniform(0.1, 0.4)};
      const int bar = model_->add_body(name("bar"), {.position = foot + up, .angle = angle});
      model_->add("", Revolute<double>{.s_i = foot + up, .s_j = {}}, ground, bar);
      model_->add("", Revolute<double>{.s_i = {length, 0}, .s_j = up}, bar, plate);
    }
    model_->add_force("", spring(foot + Vec2<double>{0, h}, {a, 0}, mass * earth * length / (a * h), 0), ground, arm);
  }
  int add_pendulum() {
    const double length = size_ * uniform(0.2, 2), angle = uniform(-2.5, 2.5), mass = weight_ / earth;
    const int rod = model_->add_body(name("rod"), {.mass = mass,
                                                   .inertia = mass * length * length,
                                                   .position = {length * std::sin(angle), -length * std::cos(angle)},
                                                   .angle = angle});
    model_->add("", Revolute<double>{.s_i = {}, .s_j = {0, length}}, ground, rod);
    return rod;
  }
  const std::shared_ptr<Model>& model() const { return model_; }
  double size() const { return size_; }

 private:
  std::string name(const char* kind) { return kind + std::to_string(model_->bodies.size()); }

  std::shared_ptr<Model> model_ = std::make_shared<Model>();
  std::mt19937 random_;
  double size_ = 1, weight_ = 1;
};

TEST(Balanced, StaysWhereItStands) {
  for (unsigned seed = 1; seed <= 200; ++seed) {
    SCOPED_TRACE(seed);
    Balances scene(seed);
    const int arms = 1 + static_cast<int>(scene.uniform(0, 3));
    for (int k = 0; k < arms; ++k) scene.add_arm(scene.uniform(0, 1) < 0.5);
    const int rod = scene.uniform(0, 1) < 0.3 ? scene.add_pendulum() : -1;
    const auto model = scene.model();
    Equilibrium analysis(model);
    const EquilibriumReport report = analysis.solve();
    ASSERT_TRUE(report.ok()) << report.message;
    EXPECT_TRUE(report.neutral);
    EXPECT_FALSE(report.stable);
    EXPECT_EQ(report.negative_modes, 0);
    const std::vector<double> q = analysis.state().q;
    for (std::size_t b = 0; b < model->bodies.size(); ++b) {
      if (static_cast<int>(b) == rod) {
        EXPECT_NEAR(std::remainder(q[3 * b + 2], 2 * std::numbers::pi), 0, 1e-7);
        continue;
      }
      EXPECT_NEAR(q[3 * b + 2], model->bodies[b].angle, 1e-6) << model->bodies[b].angle;
    }
  }
}

}  // namespace
}  // namespace catena::testing
