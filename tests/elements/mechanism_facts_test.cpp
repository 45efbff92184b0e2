// What is known of joints from mechanics, beyond their derivatives: gear ratios, rolling, belts, cams.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "catena/elements/all.hpp"

namespace catena {
namespace {

constexpr double pi = std::numbers::pi;

template <class E>
double row_of(const E& element, const Frame<double>& i, const Frame<double>& j, int row = 0) {
  double rows[E::rows];
  element.phi(Arguments<double>{i, j, 0, {}}, rows);
  return rows[row];
}

/// Phi_q qd of a row for rates of i and of j.
template <class E>
double rate_of(const E& element, const Frame<double>& i, const Frame<double>& j, const Rates& u, const Rates& v,
               int row = 0) {
  Taylor<double> rows[E::rows];
  const auto mi = moving(i, u.vx, u.vy, u.omega), mj = moving(j, v.vx, v.vy, v.omega);
  element.phi(Arguments<Taylor<double>>{mi, mj, Taylor<double>(0.0), {}}, rows);
  return rows[row].d;
}

/// Two wheels on a carrier at angle `arm`, centres `distance` apart, i at the origin.
Frame<double> on_carrier(double distance, double arm, double angle) {
  return make_frame(distance * std::cos(arm), distance * std::sin(arm), angle);
}

TEST(Gear, KeepsMeshingOverManyTurnsOfWheelsAndCarrier) {
  const double r_i = 0.2, r_j = 0.05;
  for (const bool internal : {false, true}) {
    SCOPED_TRACE(internal ? "internal" : "external");
    Gear<double> gear{.radius_i = r_i, .radius_j = r_j, .internal = internal};
    const double distance = internal ? r_i - r_j : r_i + r_j;
    const auto i = [](double turned) { return make_frame(0.0, 0.0, 0.3 + turned); };
    gear.complete(i(0), on_carrier(distance, 0.5, -1.0));
    ASSERT_EQ(gear.check(), nullptr);
    for (double carrier : {0.0, 2.9, 3.1, -7.5, 100 * pi, -123.456}) {
      for (double wheel : {0.0, 0.4, -55.5, 200 * pi}) {
        // In the carrier's frame: angles turned in the ratio of the radii.
        const double planet = carrier + (internal ? 1 : -1) * r_i / r_j * (wheel - carrier);
        const double miss = row_of(gear, i(wheel), on_carrier(distance, 0.5 + carrier, -1.0 + planet));
        EXPECT_NEAR(miss, 0, 1e-12) << carrier << ", " << wheel;
        // A tooth that slips shows.
        EXPECT_NEAR(row_of(gear, i(wheel + 0.01), on_carrier(distance, 0.5 + carrier, -1.0 + planet)), 0.01 * r_i,
                    1e-12);
      }
    }
  }
}

// Willis: (ws - wc) / (wr - wc) = -zr / zs, from the rows of sun-planet and planet-ring alone.
TEST(Gear, PlanetarySetObeysWillis) {
  const double sun = 0.020, ring = 0.070, planet = 0.025, arm = 0.7;
  const Frame<double> centre = make_frame(0.0, 0.0, 0.1), at = on_carrier(sun + planet, arm, 0.4);
  Gear<double> outer{.radius_i = sun, .radius_j = planet},
      inner{.radius_i = ring, .radius_j = planet, .internal = true};
  outer.complete(centre, at);
  inner.complete(centre, at);
  const double w_sun = 100, w_carrier = 200.0 / 9, w_planet = -40;  // ring at rest
  const double speed = w_carrier * (sun + planet);
  const Rates moving_planet{-speed * std::sin(arm), speed * std::cos(arm), w_planet};
  EXPECT_NEAR(rate_of(outer, centre, at, {0, 0, w_sun}, moving_planet), 0, 1e-14);
  EXPECT_NEAR(rate_of(inner, centre, at, {0, 0, 0}, moving_planet), 0, 1e-14);
  EXPECT_NEAR(rate_of(outer, centre, at, {0, 0, w_sun + 1}, moving_planet), sun, 1e-14);
}

TEST(Gear, RefusesWhatCannotMesh) {
  const Frame<double> here = make_frame(0.0, 0.0, 0.0), there = make_frame(1.0, 0.0, 0.0);
  const auto said = [&](Gear<double> gear, const Frame<double>& j) {
    gear.complete(here, j);
    const char* text = gear.check();
    return std::string(text ? text : "");
  };
  EXPECT_EQ(said({.radius_i = 0.5, .radius_j = 0.5}, there), "");
  EXPECT_EQ(said({.radius_i = 0, .radius_j = 0.5}, there), "radius_i is not above zero");
  EXPECT_EQ(said({.radius_i = 0.5, .radius_j = -1}, there), "radius_j is not above zero");
  EXPECT_EQ(said({.radius_i = 0.5, .radius_j = 0.5, .internal = true}, there),
            "an internal gear needs radii that differ");
  EXPECT_EQ(said({.radius_i = 0.5, .radius_j = 0.5}, here), "its centres coincide in the given configuration");
  Gear<double> gear{.radius_i = 0.5, .radius_j = 0.5};
  gear.complete(here, there);
  EXPECT_EQ(gear.trouble(Arguments<double>{here, there, 0, {}}), nullptr);
  EXPECT_STREQ(gear.trouble(Arguments<double>{here, here, 0, {}}), "its centres coincide");
}

// The strands of an open belt lean by asin((R_i - R_j)/d): the difference of their tensions pulls the bearings across
// the line of centres, and turns each pulley by its radius. A crossed belt leans by asin((R_i + R_j)/d).
TEST(Belt, BearsWhatItsStrandsPull) {
  const double r_i = 0.3, r_j = 0.1, d = 0.8;
  for (const bool crossed : {false, true}) {
    SCOPED_TRACE(crossed ? "crossed" : "open");
    Belt<double> belt{.radius_i = r_i, .radius_j = r_j, .crossed = crossed};
    const Frame<double> i = make_frame(0.0, 0.0, 0.2), j = make_frame(d, 0.0, -0.4);
    belt.complete(i, j);
    ASSERT_EQ(belt.check(), nullptr);
    EXPECT_NEAR(row_of(belt, i, j), 0, 1e-15);
    double e[6];
    belt.jacobian(Arguments<double>{i, j, 0, {}}, e);
    const double lean = (crossed ? r_i + r_j : r_i - r_j) / d;
    EXPECT_NEAR(e[0], 0, 1e-15);
    EXPECT_NEAR(e[1], lean, 1e-15);
    EXPECT_NEAR(e[4], -lean, 1e-15);
    EXPECT_NEAR(e[2], r_i, 1e-15);
    EXPECT_NEAR(e[5], crossed ? r_j : -r_j, 1e-15);
  }
  Belt<double> alike{.radius_i = 0.2, .radius_j = 0.2};
  const Frame<double> i = make_frame(0.0, 0.0, 0.0), j = make_frame(1.0, 0.0, 0.0);
  alike.complete(i, j);
  EXPECT_EQ(alike.check(), nullptr);
  EXPECT_NEAR(row_of(alike, make_frame(0.0, 0.0, 50.0), make_frame(0.6, 0.8, 50.0)), 0, 1e-14);
}

TEST(RackPinion, RollsWithoutSlipOnEitherSide) {
  for (const int side : {1, -1}) {
    RackPinion<double> joint{.axis_i = {3, 4}, .radius = 0.04, .side = side};
    const Frame<double> rack = make_frame(0.1, -0.2, 0.9);
    const Vec2<double> u = rack.axis(Vec2<double>{0.6, 0.8}), up = perpendicular(u);
    const auto pinion = [&](double along, double turned) {
      const Vec2<double> place = rack.origin() + along * u + side * joint.radius * up;
      return make_frame(place.x, place.y, turned);
    };
    joint.complete(rack, pinion(0.3, 1.0));
    ASSERT_EQ(joint.check(), nullptr);
    // Rolling forwards by a length turns a pinion on the left clockwise.
    for (double way : {0.0, 0.05, -4.0}) {
      const Frame<double> there = pinion(0.3 + way, 1.0 - side * way / joint.radius);
      EXPECT_NEAR(row_of(joint, rack, there, 0), 0, 1e-15);
      EXPECT_NEAR(row_of(joint, rack, there, 1), 0, 1e-14);
    }
    // The point of the pinion that touches the rack has no velocity.
    const double omega = 3, speed = -side * joint.radius * omega;
    EXPECT_NEAR(rate_of(joint, rack, pinion(0.3, 1.0), {}, {speed * u.x, speed * u.y, omega}, 1), 0, 1e-15);
  }
}

TEST(Slot, OffsetIsToTheLeftAndZeroUnlessGiven) {
  EXPECT_EQ(when_omitted<Slot<double>>(), Omitted::zero);
  EXPECT_EQ(when_omitted<Displacement<double>>(), Omitted::given);
  Slot<double> slot{.axis_i = {0, 2}};
  const Frame<double> i = make_frame(0.0, 0.0, 0.0), j = make_frame(-0.25, 0.7, 0.0);
  slot.complete(i, j);
  EXPECT_DOUBLE_EQ(slot.measure(i, j), 0.25);
  Displacement<double> along{.axis_i = {0, 2}};
  along.complete(i, j);
  EXPECT_DOUBLE_EQ(along.measure(i, j), 0.7);
}

TEST(Axes, WithoutDirectionAreRefused) {
  const Frame<double> f;
  Slot<double> slot;
  slot.complete(f, f);
  EXPECT_STREQ(slot.check(), "axis_i has no direction");
  Translational<double> joint;
  joint.complete(f, f);
  EXPECT_STREQ(joint.check(), "axis_i has no direction");
  RackPinion<double> rack{.radius = 1};
  rack.complete(f, f);
  EXPECT_STREQ(rack.check(), "axis_i has no direction");
  rack = {.axis_i = {1, 0}};
  EXPECT_STREQ(rack.check(), "radius is not above zero");
}

TEST(Translational, TakesTheSecondAxisFromTheGivenConfiguration) {
  const Frame<double> i = make_frame(0.0, 0.0, 0.4), j = make_frame(1.0, 2.0, -0.9);
  Translational<double> joint{.axis_i = {5, 0}};
  joint.complete(i, j);
  ASSERT_EQ(joint.check(), nullptr);
  EXPECT_NEAR(joint.axis_j.x, std::cos(1.3), 1e-15);
  EXPECT_NEAR(joint.axis_j.y, std::sin(1.3), 1e-15);
  EXPECT_NEAR(row_of(joint, i, j, 1), 0, 1e-15);
  EXPECT_NEAR(row_of(joint, i, make_frame(1.0, 2.0, -0.9 + 0.2), 1), std::sin(0.2), 1e-15);
}

}  // namespace
}  // namespace catena
