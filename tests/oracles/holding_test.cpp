// Whether friction can hold a position, against closed forms: blocks on slopes, ladders at walls, brakes of levers,
// sliders in guides, arms on pins; a slider-crank against a search along the one force that statics leaves open.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "analysis/sanitized.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

/// A line through the origin along (c, s) with a point of a body; free on its left.
std::string contact(const std::string& name, const std::string& point, double c, double s, const std::string& keys) {
  return R"({"type": "contact", "name": ")" + name + R"(", "i": "ground", "j": ")" + point +
         R"(", "curve": {"line": {"point": [0,0], "axis": )" + pair_of(c, s) + "}}" + keys + "}";
}
std::string scene(const std::string& bodies, const std::string& constraints, const std::string& forces) {
  return R"({"catena":1, "gravity":[0,-9.81], "bodies": {)" + bodies + R"(}, "constraints": [)" + constraints +
         R"(], "forces": [)" + forces + R"(], "analyses": [{"type": "equilibrium", "friction": "hold"}]})";
}

void expect_utilisation(const TextRun& run, double u) {
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  EXPECT_NEAR(field<double>(run, "utilisation"), u, 1e-9 * (1 + u));
  EXPECT_EQ(field<bool>(run, "held"), u <= 1);
}

// The forces of both corners add up to the weight's parts along and across the slope.
TEST(Holding, BlocksOnSlopes) {
  int held = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double slope = random(-0.7, 0.7), mu = random(0.1, 0.9), mass = random(0.1, 20);
    const double c = std::cos(slope), s = std::sin(slope);
    // A stiffness is for motion alone: equilibrium and its friction take the place as rigid.
    const std::string keys =
        R"(, "mu": )" + text_of(mu / 2) + R"(, "mu_static": )" + text_of(mu) + (seed % 3 == 0 ? R"(, "k": 1e5)" : "");
    const TextRun run =
        run_text(scene(R"("block": {"mass": )" + text_of(mass) + R"(, "inertia": 0.01, "angle": )" + text_of(slope) +
                           R"(, "position": )" + pair_of(-0.03 * s, 0.03 * c) +
                           R"(, "points": {"l": [-0.1,-0.03], "r": [0.1,-0.03]}})",
                       "", contact("l", "block.l", c, s, keys) + "," + contact("r", "block.r", c, s, keys)));
    expect_utilisation(run, std::abs(s / c) / mu);
    held += std::abs(s / c) <= mu;
  }
  EXPECT_GT(held, 10);
  EXPECT_LT(held, 35);
}

// With the angle of friction f at both ends a ladder stands down to the angle pi/2 - 2 f.
TEST(Holding, LaddersAtWalls) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double angle = random(0.3, 1.4), mu = random(0.1, 0.8), length = random(0.5, 10), mass = random(1, 50);
    const double x = length * std::cos(angle) / 2, y = length * std::sin(angle) / 2;
    const std::string keys = R"(, "mu": )" + text_of(mu);
    const std::string ladder = R"("ladder": {"mass": )" + text_of(mass) + R"(, "inertia": 1, "angle": )" +
                               text_of(-angle) + R"(, "position": )" + pair_of(x, y) + R"(, "points": {"top": )" +
                               pair_of(-length / 2, 0) + R"(, "foot": )" + pair_of(length / 2, 0) + "}}";
    const TextRun run = run_text(scene(
        ladder, "", contact("floor", "ladder.foot", 1, 0, keys) + "," + contact("wall", "ladder.top", 0, -1, keys)));
    expect_utilisation(run, std::tan((std::numbers::pi / 2 - angle) / 2) / mu);
    // On a smooth floor nothing presses it to the wall.
    const TextRun slips = run_text(scene(
        ladder, "", contact("floor", "ladder.foot", 1, 0, "") + "," + contact("wall", "ladder.top", 0, -1, keys)));
    ASSERT_EQ(slips.outcome.exit_code, 0) << slips.outcome.error_text << slips.analysis().report.message;
    EXPECT_FALSE(field<bool>(slips, "held"));
    EXPECT_FALSE(slips.analysis().report.warnings.empty());
  }
}

// A lever that is pinned level with the brake's place presses there with P a / b, whatever the friction.
TEST(Holding, BrakesOfLevers) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double a = random(0.5, 2), b = random(0.2, 1), force = random(10, 200), radius = random(0.1, 0.5);
    const double torque = random(-20, 20), mu = random(0.1, 0.6);
    const TextRun run = run_text(
        scene(R"("wheel": {"mass": 1, "inertia": 1, "position": )" + pair_of(0, -radius) +
                  R"(}, "lever": {"mass": 0, "inertia": 0, "position": )" + pair_of(-b, 0) + R"(, "points": {"tip": )" +
                  pair_of(b, 0) + R"(, "end": )" + pair_of(a, 0) + "}}",
              R"({"type": "revolute", "i": ["ground", )" + pair_of(0, -radius) +
                  R"(], "j": "wheel"}, {"type": "revolute", "i": ["ground", )" + pair_of(-b, 0) + R"(], "j": "lever"})",
              R"({"type": "contact", "i": "wheel", "j": "lever.tip", "mu": )" + text_of(mu) +
                  R"(, "curve": {"circle": {"centre": [0,0], "radius": )" + text_of(radius) +
                  R"(}}}, {"type": "point_force", "i": "lever.end", "force": )" + pair_of(0, -force) +
                  R"(}, {"type": "torque", "i": "wheel", "torque": )" + text_of(torque) + "}"));
    expect_utilisation(run, std::abs(torque) / (mu * radius * force * a / b));
  }
}

// A body on two to four places anywhere, with a force: of forces along the edges of the cones three at a time balance
// the load where any do (Caratheodory). Bodies that are wedged are among them, whose forces grow without bound at the
// least friction that holds.
struct Placed {
  double x, y, angle, mu;
};

bool holds(const std::vector<Placed>& places, double fx, double fy, double moment, double u) {
  std::vector<std::array<double, 3>> edges;
  for (const Placed& p : places) {
    for (const double slope : {u * p.mu, -u * p.mu}) {
      const double ex = -std::sin(p.angle) + slope * std::cos(p.angle),
                   ey = std::cos(p.angle) + slope * std::sin(p.angle);
      edges.push_back({ex, ey, p.x * ey - p.y * ex});
    }
  }
  const auto det = [](const std::array<double, 3>& a, const std::array<double, 3>& b, const std::array<double, 3>& c) {
    return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
  };
  const std::array<double, 3> load{-fx, -fy, -moment};
  for (std::size_t i = 0; i < edges.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      for (std::size_t k = 0; k < j; ++k) {
        const double d = det(edges[i], edges[j], edges[k]);
        if (d == 0) continue;
        if (det(load, edges[j], edges[k]) / d >= 0 && det(edges[i], load, edges[k]) / d >= 0 &&
            det(edges[i], edges[j], load) / d >= 0)
          return true;
      }
    }
  }
  return false;
}

TEST(Holding, PlacesAnywhereAgainstThreeForces) {
  int held = 0, wanted = 0;
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const auto count = static_cast<int>(random(2, 4.999));
    const double most = random(0, 1) < 0.5 ? 0.6 : std::numbers::pi, mass = random(1, 5);
    std::vector<Placed> places;
    std::string points, forces;
    for (int k = 0; k < count; ++k) {
      Placed p{};
      p.x = random(-0.5, 0.5);
      p.y = random(-0.5, 0.5);
      p.angle = random(-most, most);
      p.mu = random(0.05, 1);
      places.push_back(p);
      const std::string n = std::to_string(k);
      points += (k ? ", \"p" : "\"p") + n + "\": " + pair_of(p.x, p.y);
      forces += R"({"type": "contact", "name": "c)" + n + R"(", "i": "ground", "j": "b.p)" + n + R"(", "mu": )" +
                text_of(p.mu) + R"(, "curve": {"line": {"point": )" + pair_of(p.x, p.y) + R"(, "axis": )" +
                pair_of(std::cos(p.angle), std::sin(p.angle)) + "}}},";
    }
    const double fx = random(-10, 10), fy = random(-10, 10), x = random(-0.5, 0.5), y = random(-0.5, 0.5);
    forces += R"({"type": "point_force", "i": ["b", )" + pair_of(x, y) + R"(], "force": )" + pair_of(fx, fy) + "}";
    const auto can = [&](double u) { return holds(places, fx, fy - 9.81 * mass, x * fy - y * fx, u); };
    const TextRun run = run_text(
        scene(R"("b": {"mass": )" + text_of(mass) + R"(, "inertia": 1, "points": {)" + points + "}}", "", forces));
    if (!can(1e4)) continue;
    ++wanted;
    double low = 0, high = 1e4;
    for (int k = 0; k < 200; ++k) (can(0.5 * (low + high)) ? high : low) = 0.5 * (low + high);
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    EXPECT_NEAR(field<double>(run, "utilisation"), high, 1e-8 * high + 1e-12);
    held += high <= 1;
  }
  EXPECT_GT(wanted, 20);
  EXPECT_GT(held, 2);
}

// The friction of joints: their forces follow from statics, or from a search along the one that it leaves open.
constexpr double g = 9.81;

std::string pin_friction(const std::string& joint, double mu, double radius) {
  return R"({"type": "friction", "joint": ")" + joint + R"(", "mu": )" + text_of(mu / 2) + R"(, "mu_static": )" +
         text_of(mu) + R"(, "radius": )" + text_of(radius) + "}";
}
std::string rod(const std::string& name, double mass, double x0, double y0, double x1, double y1) {
  return "\"" + name + R"(": {"mass": )" + text_of(mass) + R"(, "rod": {"from": )" + pair_of(x0, y0) + R"(, "to": )" +
         pair_of(x1, y1) + "}}";
}
// Sliders on slopes: tan(slope) / mu. A load beside a guide of length l presses its ends, moment / (l / 2).
TEST(Holding, SlidersInGuides) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double slope = random(-1.2, 1.2), mu = random(0.1, 0.9), mass = random(0.1, 20), length = random(0.05, 0.3);
    const double arm = random(-0.4, 0.4), load = random(5, 50), c = std::cos(slope), s = std::sin(slope);
    const bool guided = seed % 2 == 0;
    const std::string friction = R"({"type": "friction", "joint": "g", "mu": )" + text_of(mu) +
                                 (guided ? R"(, "length": )" + text_of(length) : "") + "}";
    const TextRun run = run_text(
        scene(R"("s": {"mass": )" + text_of(mass) + R"(, "inertia": 0.1, "angle": )" + text_of(slope) + "}",
              R"({"type": "translational", "name": "g", "i": "ground", "j": "s", "axis_i": )" + pair_of(c, s) + "}",
              friction + R"(, {"type": "point_force", "i": ["s", )" + pair_of(arm, 0) + R"(], "force": )" +
                  pair_of(0, -load) + "}"));
    const double weight = mass * g + load, moment = arm * c * load;
    const double N = weight * c + (guided ? std::abs(moment) / (length / 2) : 0);
    expect_utilisation(run, weight * std::abs(s) / (mu * N));
  }
}

// Two links on pins: each pin carries what hangs on it, and turns under the moment of that.
TEST(Holding, ArmsOnPins) {
  int held = 0;
  for (unsigned seed = 1; seed <= size_of_test(30u, 16u); ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double a = random(0.1, 0.5), b = random(0.1, 0.5), m1 = random(0.5, 3), m2 = random(0.5, 3);
    const double t1 = random(-3, 3), t2 = random(-3, 3), mu1 = random(0.2, 2), mu2 = random(0.2, 2);
    const double r1 = random(0.05, 0.3), r2 = random(0.05, 0.3), force = random(-20, 20);
    const double x1 = a * std::cos(t1), y1 = a * std::sin(t1), dx = b * std::cos(t2), dy = b * std::sin(t2);
    const TextRun run =
        run_text(scene(rod("one", m1, 0, 0, x1, y1) + "," + rod("two", m2, x1, y1, x1 + dx, y1 + dy),
                       R"({"type": "revolute", "name": "O", "i": "ground", "j": "one.from"},
           {"type": "revolute", "name": "A", "i": "one.to", "j": "two.from"})",
                       pin_friction("O", mu1, r1) + "," + pin_friction("A", mu2, r2) +
                           R"(, {"type": "point_force", "i": "two.to", "force": )" + pair_of(force, 0) + "}"));
    const double at_A = -m2 * g * dx / 2 - force * dy;
    const double at_O = -m1 * g * x1 / 2 - m2 * g * (x1 + dx / 2) - force * (y1 + dy);
    const double u = std::max(std::abs(at_A) / (mu2 * r2 * std::hypot(m2 * g, force)),
                              std::abs(at_O) / (mu1 * r1 * std::hypot((m1 + m2) * g, force)));
    expect_utilisation(run, u);
    held += u <= 1;
  }
  EXPECT_GT(held, 2);
}

// A slider-crank without weight, pushed at the crank: the friction T of the crank's pin is free, all other forces
// follow from it: the rod carries S with S h = M - T, h its lever arm at the crank's pin.
double slider_crank_share(double r, double l, double angle, double moment, double push, const double (&mu_r)[2],
                          double mu) {
  const double x = r * std::cos(angle), y = r * std::sin(angle), slope = std::asin(y / l);
  // The rod pulls the crank's end along (cos, -sin)(slope) with S; moments about the pin balance M.
  const double arm = -x * std::sin(slope) - y * std::cos(slope);
  const auto share = [&](double T) {
    const double S = -(moment + T) / arm;
    const double slide = std::abs(push - S * std::cos(slope)), press = std::abs(S * std::sin(slope));
    return std::max(std::abs(T) / (mu_r[0] * mu_r[1] * std::abs(S)), slide / (mu * press));
  };
  double best = 1e300, place = 0, wide = 4 * (moment + r * std::abs(push));
  for (int k = -20000; k <= 20000; ++k) {
    const double T = wide * k / 20000, u = share(T);
    if (u < best) {
      best = u;
      place = T;
    }
  }
  for (wide /= 10000; wide > 1e-15 * (1 + std::abs(place)); wide *= 0.7) {
    for (const double T : {place - wide, place + wide, place - wide / 2, place + wide / 2}) {
      if (share(T) >= best) continue;
      best = share(T);
      place = T;
    }
  }
  return best;
}

TEST(Holding, SliderCranksWithOneForceOpen) {
  const unsigned last = size_of_test(12u, 2u);
  for (unsigned seed = 1; seed <= last; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    const double r = random(0.1, 0.2), l = random(0.4, 0.6), angle = random(0.4, 1.4);
    const double moment = random(2, 10), push = random(-60, 60), mu = random(0.2, 0.8);
    const double pin[2] = {random(0.2, 0.9), random(0.01, 0.04)};  // mu_static, radius
    const double x = r * std::cos(angle), y = r * std::sin(angle), end = x + std::sqrt(l * l - y * y);
    const std::string light = R"("mass": 0, "inertia": 0, "rod": {"from": )";
    const TextRun run =
        run_text(scene(R"("crank": {)" + light + R"([0,0], "to": )" + pair_of(x, y) + R"(}}, "rod": {)" + light +
                           pair_of(x, y) + R"(, "to": )" + pair_of(end, 0) +
                           R"(}}, "slider": {"mass": 0, "inertia": 0, "position": )" + pair_of(end, 0) + "}",
                       R"({"type": "revolute", "name": "O", "i": "ground", "j": "crank.from"},
           {"type": "revolute", "name": "A", "i": "crank.to", "j": "rod.from"},
           {"type": "revolute", "name": "B", "i": "rod.to", "j": "slider"},
           {"type": "translational", "name": "G", "i": "ground", "j": "slider", "axis_i": [1, 0]})",
                       pin_friction("O", pin[0], pin[1]) + R"(, {"type": "friction", "joint": "G", "mu": )" +
                           text_of(mu) + R"(}, {"type": "torque", "i": "crank", "torque": )" + text_of(moment) +
                           R"(}, {"type": "point_force", "i": "slider", "force": )" + pair_of(push, 0) + "}"));
    expect_utilisation(run, slider_crank_share(r, l, angle, moment, push, pin, mu));
  }
}

}  // namespace
}  // namespace catena::testing
