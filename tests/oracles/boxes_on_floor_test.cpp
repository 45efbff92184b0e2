// Boxes on two rough feet, on level and tilted floors, pushed or not, from rest or sliding: both feet of a box hold
// each other, and how they share friction is not unique. Closed forms while no foot is relieved: uniform acceleration
// g (sin tilt) + F / m -+ mu N / m, N = m g cos(tilt), until it stops; then at rest if mu_static N holds it, or back.
// Boxes that stand while a force on them grows from zero, in any unit of length, the whole turned by any angle: nothing
// moves, friction balances the force, and a motion without change takes few steps.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"
#include "stress/cases.hpp"

namespace catena::testing {
namespace {

constexpr double g = 9.81;

struct Box {
  double half_width, half_height, mass, mu, mu_static, speed, push, height, tilt, until;

  /// Largest and least of what presses the feet, over m g cos(tilt), with friction of this part of it along the floor.
  std::pair<double, double> pressed(double friction) const {
    const double weight = mass * g * std::cos(tilt);
    const double share = (push * height - half_height * friction * weight) / (2 * half_width * weight);
    return {0.5 + std::abs(share), 0.5 - std::abs(share)};
  }
};

Box random_box(unsigned seed) {
  RandomNumbers draw(seed);
  Box box{};
  box.half_width = draw(0.1, 1);
  box.half_height = draw(0.1, 1);
  box.mass = draw(0.5, 20);
  box.mu = draw(0.05, 1.2);
  box.mu_static = box.mu * (draw(0, 1) < 0.4 ? 1.4 : 1);
  box.speed = draw(0, 1) < 0.5 ? 0 : draw(-4, 4);
  box.tilt = draw(0, 1) < 0.5 ? 0 : draw(-0.6, 0.6);
  box.push = draw(0, 1) < 0.4 ? 0 : draw(-1.5, 1.5) * box.mu * box.mass * g;
  box.height = draw(-box.half_height, box.half_height);
  box.until = draw(0.3, 1.5);
  return box;
}

/// How far it slides and how fast it is at the end; nothing where a foot may be relieved, or rounding decides.
std::optional<std::pair<double, double>> slides(const Box& box) {
  const double weight = box.mass * g * std::cos(box.tilt), drive = box.push - box.mass * g * std::sin(box.tilt);
  double t = 0, x = 0, v = box.speed;
  // At rest any share of friction up to its limit may act.
  const auto stands = [&](double friction) { return box.pressed(friction).second > 0.02; };
  while (true) {
    if (v == 0) {
      if (std::abs(std::abs(drive) - box.mu_static * weight) < 1e-6 * weight) return {};
      // Where it might stand on one foot as well, two motions fit.
      if (!stands(-box.mu_static) || !stands(box.mu_static)) return {};
      if (std::abs(drive) < box.mu_static * weight) return std::pair(x, 0.0);
    }
    const double way = v != 0 ? std::copysign(1, v) : std::copysign(1, drive);
    if (!stands(-way * box.mu)) return {};
    const double a = (drive - way * box.mu * weight) / box.mass;
    const double stop = a * way < 0 ? t - v / a : box.until;
    if (stop >= box.until)
      return std::pair(x + v * (box.until - t) + a * std::pow(box.until - t, 2) / 2, v + a * (box.until - t));
    x += v * (stop - t) + a * (stop - t) * (stop - t) / 2;
    t = stop;
    v = 0;
  }
}

std::string box_text(const Box& box) {
  const double c = std::cos(box.tilt), s = std::sin(box.tilt);
  const auto foot = [&](const char* name) {
    return fmt::format(R"({{"type": "contact", "i": "ground", "j": "box.{}", "mu": {:.17g}, "mu_static": {:.17g},
 "curve": {{"line": {{"point": [0, 0], "axis": [{:.17g}, {:.17g}]}}}}}})",
                       name, box.mu, box.mu_static, c, s);
  };
  return fmt::format(
      R"({{"catena": 1, "gravity": [0, -9.81], "bodies": {{"box": {{"mass": {:.17g}, "inertia": {:.17g},
 "position": [{:.17g}, {:.17g}], "angle": {:.17g}, "velocity": [{:.17g}, {:.17g}],
 "points": {{"left": [{:.17g}, {:.17g}], "right": [{:.17g}, {:.17g}], "top": [0, {:.17g}]}}}}}},
 "forces": [{}, {}, {{"type": "point_force", "i": "box.top", "force": [{:.17g}, {:.17g}]}}],
 "outputs": ["box.x", "box.y", "box.angle", "box.vx"],
 "analyses": [{{"type": "dynamics", "at": [{:.17g}], "tolerance": 1e-10}}]}})",
      box.mass, box.mass * (box.half_width * box.half_width + box.half_height * box.half_height) / 3,
      -s * box.half_height, c * box.half_height, box.tilt, box.speed * c, box.speed * s, -box.half_width,
      -box.half_height, box.half_width, -box.half_height, box.height, foot("left"), foot("right"), box.push * c,
      box.push * s, box.until);
}

std::string box_fault(unsigned seed) {
  const Box box = random_box(seed);
  const auto exact = slides(box);
  const TextRun run = run_text(box_text(box));
  if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
  if (!exact) return {};
  const double c = std::cos(box.tilt), s = std::sin(box.tilt);
  const double off = std::max({std::abs(run.column("box.x").back() - (exact->first * c - box.half_height * s)),
                               std::abs(run.column("box.y").back() - (exact->first * s + box.half_height * c)),
                               std::abs(run.column("box.angle").back() - box.tilt),
                               std::abs(run.column("box.vx").back() - exact->second * c)});
  return off <= 1e-8 ? std::string() : fmt::format("off by {:.2g}", off);
}

TEST(BoxesOnTwoFeet, Random) {
  int known = 0, at_rest = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    const auto exact = slides(random_box(seed));
    known += exact.has_value();
    at_rest += exact && exact->second == 0;
  }
  EXPECT_GT(known, 30);
  EXPECT_GT(at_rest, 8);
  expect_no_fault(first_case(), last_case(60), box_fault);
}

/// A box under a force F = rate t that never moves it, on two rough feet or held by three rows, seen from a frame that
/// is turned by an angle.
struct StandingBox {
  double half_width, half_height, mass, mu, rate, height, turned, unit, weight;
  bool held;
};

StandingBox random_standing_box(unsigned seed) {
  RandomNumbers draw(seed);
  StandingBox box{};
  box.unit = std::pow(10, draw(-3, 3));
  box.half_width = box.unit * draw(0.3, 1);
  box.half_height = box.unit * draw(0.1, 0.5);
  box.mass = std::pow(10, draw(-2, 3));
  box.held = draw(0, 1) < 0.5;
  box.weight = box.held && draw(0, 1) < 0.5 ? 0 : box.mass * g * box.unit;
  box.mu = draw(0.1, 0.5);
  // Neither slides nor rocks up to t = 1.
  box.rate = draw(-0.9, 0.9) * box.mu * box.mass * g * box.unit;
  box.height = draw(-box.half_height, 0.5 * box.half_height);
  box.turned = draw(0, 1) < 0.3 ? 0 : draw(-3, 3);
  return box;
}

std::string standing_text(const StandingBox& box) {
  const double c = std::cos(box.turned), s = std::sin(box.turned), gravity = box.weight / box.mass;
  const double x = -s * box.half_height, y = c * box.half_height;
  const auto foot = [&](const char* name) {
    return fmt::format(R"({{"type": "contact", "name": "{0}", "i": "ground", "j": "box.{0}", "mu": {1:.17g},
 "curve": {{"line": {{"point": [0, 0], "axis": [{2:.17g}, {3:.17g}]}}}}}}, )",
                       name, box.mu, c, s);
  };
  const std::string rows = fmt::format(
      R"({{"type": "absolute_x", "i": "box.left", "value": {:.17g}}},
 {{"type": "absolute_y", "i": "box.left", "value": {:.17g}}}, {{"type": "absolute_angle", "i": "box", "value": {:.17g}}})",
      -c * box.half_width, -s * box.half_width, box.turned);
  return fmt::format(
      R"({{"catena": 1, "gravity": [{:.17g}, {:.17g}], "bodies": {{"box": {{"mass": {:.17g}, "inertia": {:.17g},
 "position": [{:.17g}, {:.17g}], "angle": {:.17g},
 "points": {{"left": [{:.17g}, {:.17g}], "right": [{:.17g}, {:.17g}], "top": [0, {:.17g}]}}}}}},
 "constraints": [{}], "forces": [{}{{"type": "point_force", "i": "box.top",
 "force": [{{"polynomial": [0, {:.17g}]}}, {{"polynomial": [0, {:.17g}]}}]}}],
 "outputs": ["box.x", "box.y", "box.angle", "energy.balance"{}],
 "analyses": [{{"type": "dynamics", "until": 1, "every": 0.25, "tolerance": 1e-8}}]}})",
      gravity * s, -gravity * c, box.mass,
      box.mass * (box.half_width * box.half_width + box.half_height * box.half_height) / 3, x, y, box.turned,
      -box.half_width, -box.half_height, box.half_width, -box.half_height, box.height, box.held ? rows : "",
      box.held ? "" : foot("left") + foot("right"), box.rate * c, box.rate * s,
      box.held ? "" : R"(, "left.friction", "right.friction")");
}

std::string standing_fault(unsigned seed) {
  const StandingBox box = random_standing_box(seed);
  const TextRun run = run_text(standing_text(box));
  if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
  const double c = std::cos(box.turned), s = std::sin(box.turned);
  const double moved = std::max({std::abs(run.last("box.x") + s * box.half_height) / box.unit,
                                 std::abs(run.last("box.y") - c * box.half_height) / box.unit,
                                 std::abs(run.last("box.angle") - box.turned)});
  if (!(moved < 1e-12)) return fmt::format("it moved by {:.2g}", moved);
  const double energy = (std::abs(box.rate) + box.mass * g * box.unit) * box.unit;
  if (!(std::abs(run.last("energy.balance")) < 1e-12 * energy))
    return fmt::format("energy is missing: {:.2g}", run.last("energy.balance") / energy);
  if (!box.held) {
    const double friction = std::abs(run.last("left.friction") + run.last("right.friction"));
    if (!(std::abs(friction - std::abs(box.rate)) < 1e-10 * energy / box.unit))
      return fmt::format("friction {:.17g} N against a force of {:.17g} N", friction, box.rate);
  }
  const Counters& counters = run.analysis().report.counters;
  // Five rows, and a few steps before it is known that nothing happens.
  const auto steps = counters.steps + counters.rejected;
  return steps <= 40 ? std::string() : fmt::format("{} steps", steps);
}

TEST(BoxesThatStand, WhileAForceGrowsFromZero) { expect_no_fault(first_case(), last_case(100), standing_fault); }

}  // namespace
}  // namespace catena::testing
