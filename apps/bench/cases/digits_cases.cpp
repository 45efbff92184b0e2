#include "cases/digits_cases.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace bench {

namespace {

using Real = long double;

class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}
  double uniform(double a, double b) { return std::uniform_real_distribution<double>(a, b)(random_); }
  double power(double a, double b) { return std::pow(10.0, uniform(a, b)); }

 private:
  std::mt19937 random_;
};

std::vector<Real> slider_at(const DigitsCase& c, double t) {
  const Real r = c.numbers[0], l = c.numbers[1], speed = c.numbers[3], a = c.numbers[2] + speed * Real(t);
  const Real sa = std::sin(a), ca = std::cos(a), w = std::sqrt((l - r * sa) * (l + r * sa));
  const Real w1 = -r * r * sa * ca / w, w2 = (-r * r * (ca - sa) * (ca + sa) - w1 * w1) / w;
  return {r * ca + w, speed * (-r * sa + w1), speed * speed * (-r * ca + w2)};
}

/// `at`: the instants; the slider lies to the right of the crank's pin.
DigitsCase slider_crank(double crank, double rod, double angle, double speed, const std::string& at) {
  DigitsCase c{
      .columns = {"slider.x", "slider.vx", "slider.ax"}, .exact = slider_at, .numbers = {crank, rod, angle, speed}};
  const double sa = std::sin(angle), ca = std::cos(angle), exact = std::asin(crank * sa / rod);
  // Given a little off the place, so that it has to be found.
  const double turn = -exact + 0.01 * std::cos(exact);
  const double pin_x = crank * ca, pin_y = crank * sa, along = rod * std::cos(turn);
  c.scene = fmt::format(
      R"({{"catena": 1, "bodies": {{
 "crank": {{"mass": 1, "inertia": 1, "position": [{:.17g}, {:.17g}], "angle": {:.17g}}},
 "rod": {{"mass": 1, "inertia": 1, "position": [{:.17g}, {:.17g}], "angle": {:.17g}}},
 "slider": {{"mass": 1, "inertia": 1, "position": [{:.17g}, 0]}}}},
 "constraints": [
 {{"type": "revolute", "i": ["ground", [0, 0]], "j": ["crank", [{:.17g}, 0]]}},
 {{"type": "revolute", "i": ["crank", [{:.17g}, 0]], "j": ["rod", [{:.17g}, 0]]}},
 {{"type": "revolute", "i": ["rod", [{:.17g}, 0]], "j": ["slider", [0, 0]]}},
 {{"type": "absolute_y", "i": "slider", "value": 0}}, {{"type": "absolute_angle", "i": "slider", "value": 0}}],
 "drivers": [{{"type": "absolute_angle", "i": "crank", "value": {{"polynomial": [{:.17g}, {:.17g}]}}}}],
 "outputs": ["slider.x", "slider.vx", "slider.ax"],
 "analyses": [{{"type": "inverse_dynamics", {}}}]}})",
      pin_x / 2, pin_y / 2, angle, pin_x + along / 2, pin_y / 2, turn, pin_x + along, -crank / 2, crank / 2, -rod / 2,
      rod / 2, angle, speed, at);
  return c;
}

/// sn, cn and dn of u at the modulus k, by means of 1 and the complementary modulus.
std::array<Real, 3> jacobi(Real u, Real k) {
  constexpr int most = 12;  // means of two numbers in [1e-9, 1] agree to rounding after seven
  std::array<Real, most + 1> a{1}, c{k};
  Real b = std::sqrt((1 - k) * (1 + k));
  int n = 0;
  while (n < most && c[static_cast<std::size_t>(n)] > 1e-19L) {
    const auto now = static_cast<std::size_t>(n++);
    a[now + 1] = (a[now] + b) / 2;
    c[now + 1] = (a[now] - b) / 2;
    b = std::sqrt(a[now] * b);
  }
  Real phi = std::ldexp(a[static_cast<std::size_t>(n)] * u, n), above = phi;
  for (; n > 0; --n) {
    above = phi;
    phi = (phi + std::asin(c[static_cast<std::size_t>(n)] / a[static_cast<std::size_t>(n)] * std::sin(phi))) / 2;
  }
  const Real sn = std::sin(phi), cn = std::cos(phi), spread = std::cos(above - phi);
  const Real dn = k == 0 ? 1 : std::abs(spread) > 0.1L ? cn / spread : std::sqrt((1 - k * sn) * (1 + k * sn));
  return {sn, cn, dn};
}

constexpr double gravity = 9.81;

std::vector<Real> pendulum_at(const DigitsCase& c, double t) {
  const Real mass = c.numbers[0], inertia = c.numbers[1], arm = c.numbers[2];
  const Real start = c.numbers[3] + std::numbers::pi_v<Real> / 2, k = std::sin(std::abs(start) / 2);
  const Real square = mass * gravity * arm / (inertia + mass * arm * arm), omega = std::sqrt(square);
  const auto [sn, cn, dn] = jacobi(omega * Real(t), k);
  const Real sine = k * cn / dn, slope = -k * (1 - k * k) * sn / (dn * dn), side = start < 0 ? -1 : 1;
  const Real theta = 2 * side * std::asin(sine);
  return {theta - std::numbers::pi_v<Real> / 2, 2 * side * omega * slope / std::sqrt((1 - sine) * (1 + sine)),
          -square * std::sin(theta)};
}

std::vector<Real> rod_at_rest(const DigitsCase& c, double) {
  const Real weight = Real(c.numbers[0]) * Real(gravity), arm = c.numbers[1], spring = c.numbers[2],
             rest = c.numbers[3];
  // The spring is stiffer than the weight anywhere: the torque falls with phi.
  Real low = rest - 2, high = rest + 2;
  for (int k = 0; k < 80; ++k) {
    const Real middle = (low + high) / 2;
    (spring * (middle - rest) + weight * arm * std::cos(middle) > 0 ? high : low) = middle;
  }
  return {low, arm * std::cos(low), arm * std::sin(low)};
}

std::vector<Real> loaded_rod_at(const DigitsCase& c, double load) {
  const Real arm = c.numbers[0], spring = c.numbers[1], rest = c.numbers[2];
  // The spring is stiffer than the load anywhere: what is left falls with phi.
  Real low = rest - 2, high = rest + 2;
  for (int k = 0; k < 80; ++k) {
    const Real middle = (low + high) / 2;
    (spring * (middle - rest) - load * arm * std::cos(middle) > 0 ? high : low) = middle;
  }
  return {low, arm * std::cos(low), arm * std::sin(low)};
}

std::vector<Real> ball_at(const DigitsCase& c, double t) {
  const Real radius = c.numbers[0], drop = c.numbers[1], e = c.numbers[2], g = gravity;
  const Real fall = std::sqrt(2 * drop / g);
  if (t < fall) return {radius + drop - g * t * t / 2, -g * t};
  Real since = t - fall, speed = e * g * fall;
  while (since > 2 * speed / g) {
    since -= 2 * speed / g;
    speed *= e;
  }
  return {radius + speed * since - g * since * since / 2, speed - g * since};
}

}  // namespace

DigitsCase random_slider_crank(unsigned seed) {
  Draw draw(seed);
  const double crank = draw.power(-2, 2), rod = crank * (1 + draw.power(-4, 0.5));
  const double angle = draw.uniform(-1, 1), speed = draw.uniform(-2, 2);
  return slider_crank(crank, rod, angle, speed, R"("until": 1, "every": 0.125)");
}

DigitsCase slider_crank_near_dead_point(double part) {
  const double crank = 0.1, rod = crank * (1 + part), angle = std::numbers::pi / 2 - 2 * std::sqrt(part);
  DigitsCase c = slider_crank(crank, rod, angle, 1, R"("at": [0])");
  const double height = crank * std::sin(angle);
  c.condition = rod / std::sqrt((rod - height) * (rod + height));
  return c;
}

DigitsCase random_pendulum(unsigned seed, const char* method) {
  Draw draw(seed);
  const double mass = draw.power(-1, 1), arm = draw.power(-1, 1), inertia = mass * arm * arm * draw.uniform(0.1, 0.5);
  const double start = draw.uniform(-2.8, 2.8) - std::numbers::pi / 2, until = draw.uniform(0.5, 3) * std::sqrt(arm);
  const double tolerance = draw.power(-11, -7);
  DigitsCase c{
      .columns = {"rod.angle", "rod.omega", "rod.alpha"}, .exact = pendulum_at, .numbers = {mass, inertia, arm, start}};
  c.scene = fmt::format(
      R"({{"catena": 1, "gravity": [0, {}], "bodies": {{"rod": {{"mass": {:.17g}, "inertia": {:.17g},
 "position": [{:.17g}, {:.17g}], "angle": {:.17g}}}}},
 "constraints": [{{"type": "revolute", "i": ["ground", [0, 0]], "j": ["rod", [{:.17g}, 0]]}}],
 "outputs": ["rod.angle", "rod.omega", "rod.alpha"],
 "analyses": [{{"type": "dynamics", "until": {:.17g}, "every": {:.17g}, "tolerance": {:.17g},
 "method": "{}"}}]}})",
      -gravity, mass, inertia, arm * std::cos(start), arm * std::sin(start), start, -arm, until, until / 8, tolerance,
      method);
  return c;
}

DigitsCase random_rod_on_spring(unsigned seed) {
  Draw draw(seed);
  const double mass = draw.power(-1, 1), arm = draw.power(-1, 1), rest = draw.uniform(-1.5, 1.5);
  const double spring = mass * gravity * arm * (1 + draw.power(-3, 2));
  DigitsCase c{.columns = {"rod.angle", "rod.x", "rod.y"}, .exact = rod_at_rest, .numbers = {mass, arm, spring, rest}};
  c.scene = fmt::format(
      R"({{"catena": 1, "gravity": [0, {}], "bodies": {{"rod": {{"mass": {:.17g}, "inertia": 1,
 "position": [{:.17g}, {:.17g}], "angle": {:.17g}}}}},
 "constraints": [{{"type": "revolute", "i": ["ground", [0, 0]], "j": ["rod", [{:.17g}, 0]]}}],
 "forces": [{{"type": "torsion_spring", "i": "ground", "j": "rod", "k": {:.17g}, "angle": {:.17g}}}],
 "outputs": ["rod.angle", "rod.x", "rod.y"], "analyses": [{{"type": "equilibrium"}}]}})",
      -gravity, mass, arm * std::cos(rest), arm * std::sin(rest), rest, -arm, spring, rest);
  return c;
}

DigitsCase random_loaded_rod(unsigned seed) {
  Draw draw(seed);
  const double arm = draw.power(-1, 1), rest = draw.uniform(-1, 1), spring = draw.power(-1, 2);
  const double to = draw.uniform(0.2, 0.8) * spring / arm;
  DigitsCase c{.columns = {"rod.angle", "rod.x", "rod.y"}, .exact = loaded_rod_at, .numbers = {arm, spring, rest}};
  c.scene = fmt::format(
      R"({{"catena": 1, "parameters": {{"load": 0}}, "bodies": {{"rod": {{"mass": 1, "inertia": 1,
 "position": [{:.17g}, {:.17g}], "angle": {:.17g}}}}},
 "constraints": [{{"type": "revolute", "i": ["ground", [0, 0]], "j": ["rod", [{:.17g}, 0]]}}],
 "forces": [{{"type": "torsion_spring", "i": "ground", "j": "rod", "k": {:.17g}, "angle": {:.17g}}},
 {{"type": "point_force", "i": "rod", "force": [0, "load"]}}],
 "outputs": ["rod.angle", "rod.x", "rod.y"],
 "analyses": [{{"type": "path", "parameter": "load", "to": {:.17g}}}]}})",
      arm * std::cos(rest), arm * std::sin(rest), rest, -arm, spring, rest, to);
  return c;
}

DigitsCase random_bouncing_ball(unsigned seed) {
  Draw draw(seed);
  const double radius = draw.uniform(0.01, 0.1), drop = draw.uniform(0.1, 1), e = draw.uniform(0.5, 0.9);
  const double until = draw.uniform(1.2, 3) * std::sqrt(2 * drop / gravity), tolerance = draw.power(-10, -6);
  DigitsCase c{.columns = {"ball.y", "ball.vy"}, .exact = ball_at, .numbers = {radius, drop, e}};
  // The height as a double holds it.
  const double height = radius + drop;
  c.numbers[1] = height - radius;
  c.scene = fmt::format(
      R"({{"catena": 1, "gravity": [0, {}], "bodies": {{"ball": {{"particle": true, "mass": 1,
 "position": [0, {:.17g}]}}}},
 "forces": [{{"type": "contact", "i": "ground", "j": "ball", "radius": {:.17g}, "restitution": {:.17g},
 "curve": {{"line": {{"point": [0, 0], "axis": [1, 0]}}}}}}],
 "outputs": ["ball.y", "ball.vy"],
 "analyses": [{{"type": "dynamics", "until": {:.17g}, "every": {:.17g}, "tolerance": {:.17g}}}]}})",
      -gravity, height, radius, e, until, until / 8, tolerance);
  return c;
}

}  // namespace bench
