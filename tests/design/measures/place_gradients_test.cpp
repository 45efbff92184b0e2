// Gradients of what a program measures of places itself, by one solve an instant: random four-bars whose pins lie
// anywhere in their bodies, against two triangles in long double and against derivatives carried forward.
//
//   crank at the angle t, of the pin (n0, n4); ground pin (n3, n7); coupler from its origin to (n1, n5); rocker to
//   (n2, n6): each is a line whose length and own angle are those of its pin
#include <gtest/gtest.h>

#include <array>
#include <cmath>

#include "catena/analysis/adjoint/kinematic_adjoint.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/sensitivity/kinematic_derivatives.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_add.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

constexpr std::size_t pin_count = 8;
template <class Real>
using Pins = std::array<Real, pin_count>;

/// Angles of coupler and rocker where the crank is at `crank`.
template <class Real>
std::array<Real, 2> angles_of(const Pins<Real>& n, Real crank) {
  const auto length = [&](std::size_t k) { return std::hypot(n[k], n[k + 4]); };
  const auto own = [&](std::size_t k) { return std::atan2(n[k + 4], n[k]); };
  const Real tip_x = length(0) * std::cos(crank + own(0)), tip_y = length(0) * std::sin(crank + own(0));
  const Real x = n[3] - tip_x, y = n[7] - tip_y, r2 = x * x + y * y;
  const Real b = length(1), c = length(2);
  const Real coupler = std::atan2(y, x) + std::acos((b * b + r2 - c * c) / (2 * b * std::sqrt(r2)));
  const Real rocker = std::atan2(b * std::sin(coupler) - y, b * std::cos(coupler) - x);
  return {coupler - own(1), rocker - own(2)};
}

template <class S>
std::shared_ptr<BasicModel<S>> model_of(const Pins<S>& n, const Pins<double>& given) {
  auto model = std::make_shared<BasicModel<S>>();
  const auto [coupler, rocker] = angles_of<double>(given, 0.2);
  const double c = std::cos(0.2), s = std::sin(0.2);
  const std::array<std::array<double, 3>, 3> pose{
      {{0, 0, 0.2}, {given[0] * c - given[4] * s, given[0] * s + given[4] * c, coupler}, {given[3], given[7], rocker}}};
  for (const auto& [x, y, angle] : pose) {
    BasicBody<S> body;
    body.position = {S(x), S(y)};
    body.angle = angle;
    model->append_body("body" + std::to_string(model->bodies.size()), body);
  }
  const Vec2<S> none{};
  model->add("", Revolute<S>{none, none}, ground, 0);
  model->add("", Revolute<S>{{n[0], n[4]}, none}, 0, 1);
  model->add("", Revolute<S>{{n[1], n[5]}, {n[2], n[6]}}, 1, 2);
  model->add("", Revolute<S>{{n[3], n[7]}, none}, ground, 2);
  const std::vector<S> turning{S(0.2), S(3.0)};
  model->add_driver("drive", AbsoluteAngle<S>{}, 0, ground, TimeFunction<S>::polynomial(turning));
  return model;
}

DesignModels designs_of(const Pins<double>& n) {
  DesignModels designs;
  for (std::size_t first = 0; first < pin_count; first += parameters_at_once) {
    Pins<DesignScalar> lifted;
    for (std::size_t k = 0; k < pin_count; ++k) {
      const bool varied = k >= first && k < first + parameters_at_once;
      lifted[k] = varied ? DesignScalar::variable(n[k], static_cast<int>(k - first)) : DesignScalar(n[k]);
    }
    designs.push_back(model_of<DesignScalar>(lifted, n));
  }
  return designs;
}

/// Of both angles by a pin, by differences of order 4.
std::array<double, 2> slopes_of(const Pins<double>& n, std::size_t pin, double crank) {
  constexpr long double h = 1e-3L;
  const auto moved = [&](long double by) {
    Pins<long double> at_pins;
    std::copy(n.begin(), n.end(), at_pins.begin());
    at_pins[pin] += by;
    return angles_of<long double>(at_pins, crank);
  };
  const auto a = moved(-2 * h), b = moved(-h), c = moved(h), d = moved(2 * h);
  const auto slope = [&](std::size_t k) { return static_cast<double>((a[k] - 8 * b[k] + 8 * c[k] - d[k]) / (12 * h)); };
  return {slope(0), slope(1)};
}

TEST(PlaceGradients, OfRandomFourBars) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    RandomNumbers random(seed);
    Pins<double> n{1, 2.5, 2, 3};
    for (double& number : n) number += random(-0.12, 0.12);
    const double of_coupler = random(-1, 1), of_rocker = random(-1, 1);
    Kinematics kinematics(model_of<double>(n, n));
    const DesignModels designs = designs_of(n);
    KinematicAdjoint back(kinematics.evaluator(), designs, pin_count);
    KinematicDerivatives forward(kinematics.evaluator(), designs, pin_count);
    const auto angle_of = [&](int body) { return at(3 * kinematics.plan().plan_body[at(body)] + 2); };
    std::vector<double> slopes(at(kinematics.plan().coordinates()), 0.0);
    slopes[angle_of(1)] = of_coupler;
    slopes[angle_of(2)] = of_rocker;
    int rows = 0;
    RowFunction look([&](const Snapshot& snapshot) {
      Pins<double> found{};
      if (!back.add_gradient(snapshot, slopes, found) || !forward.find(snapshot)) return false;
      ++rows;
      double largest = 0;
      for (const double derivative : found) largest = std::max(largest, std::abs(derivative));
      for (std::size_t p = 0; p < pin_count; ++p) {
        const auto exact = slopes_of(n, p, 0.2 + 3 * snapshot.t);
        // Differences of order 4: h^4 times a fifth derivative that grows as the linkage stretches.
        EXPECT_NEAR(found[p], of_coupler * exact[0] + of_rocker * exact[1], 1e-9 * (1 + largest))
            << "seed " << seed << ", pin " << p << ", t " << snapshot.t;
        double carried = 0;
        for (const int body : {1, 2})
          carried += slopes[angle_of(body)] *
                     forward.configuration(p / parameters_at_once)[angle_of(body)].d[p % parameters_at_once];
        EXPECT_NEAR(found[p], carried, 1e-12 * (1 + largest)) << "seed " << seed << ", pin " << p;
      }
      return true;
    });
    ASSERT_TRUE(kinematics.run(TimeGrid::range(0, 2, 0.1), {}, look).ok()) << back.why() << forward.why();
    EXPECT_EQ(rows, 21);
  }
}

}  // namespace
}  // namespace catena::testing
