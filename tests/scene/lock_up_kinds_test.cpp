// Drivers and constraints of several kinds, driven past a dead point whose instant and driver's value are known:
//
//   value(t) = from + speed t   locks at   t* = (end - from) / speed,   end: the least or greatest that closes the loop
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <random>

#include "analysis/sanitized.hpp"
#include "scene/event_entries.hpp"

namespace catena::testing {
namespace {

/// A mechanism with a driver "d" that locks.
struct Locking {
  std::string kind, bodies, constraints, driver;  // the driver up to its value
  double from, end;
};

std::string particle(const std::string& name, double x, double y) {
  return fmt::format(R"("{}": {{"particle": true, "mass": 1, "position": [{:.17g}, {:.17g}]}})", name, x, y);
}
std::string rod(const std::string& name, double x0, double y0, double x1, double y1) {
  return fmt::format(R"("{}": {{"mass": 1, "rod": {{"from": [{:.17g}, {:.17g}], "to": [{:.17g}, {:.17g}]}}}})", name,
                     x0, y0, x1, y1);
}

std::vector<Locking> lockings(std::mt19937& random) {
  const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  std::vector<Locking> all;
  // A point on a circle about the origin, at `along` in a direction that is drawn.
  const double radius = draw(0.3, 3), along = radius * draw(-0.9, 0.9),
               across = std::sqrt(radius * radius - along * along);
  const double turned = draw(-std::numbers::pi, std::numbers::pi), ux = std::cos(turned), uy = std::sin(turned);
  const double x = along * ux - across * uy, y = along * uy + across * ux;
  const std::string ring =
      fmt::format(R"({{"type": "absolute_distance", "i": "p", "ground": [0, 0], "value": {:.17g}}})", radius);
  const std::string circle = fmt::format(
      R"({{"type": "point_on_curve", "i": "ground", "j": "p", "curve": {{"circle": {{"centre": [0, 0], "radius": {:.17g}}}}}}})",
      radius);
  const std::string pin = R"({"type": "revolute", "i": ["ground", [0, 0]], "j": "r.from"})";
  const std::string oblique =
      fmt::format(R"("type": "displacement", "i": "ground", "axis_i": [{:.17g}, {:.17g}])", ux, uy);
  all.push_back({"a ring and absolute_x", particle("p", along, across), ring, R"("type": "absolute_x", "i": "p")",
                 along, radius});
  all.push_back({"a ring and a displacement", particle("p", x, y), ring, oblique + R"(, "j": "p")", along, radius});
  all.push_back({"a circle and absolute_y", particle("p", across, along), circle, R"("type": "absolute_y", "i": "p")",
                 along, radius});
  all.push_back({"a rod and a displacement", rod("r", 0, 0, x, y), pin, oblique + R"(, "j": "r.to")", along, radius});
  const double away = radius * draw(1.2, 3);
  all.push_back({"a ring and a distance", particle("p", x, y), ring,
                 fmt::format(R"("type": "absolute_distance", "i": "p", "ground": [{:.17g}, 0])", away),
                 std::hypot(x - away, y), away + radius});
  all.push_back({"a line and a distance that shrinks", particle("p", along, across),
                 R"({"type": "absolute_x", "i": "p"})", R"("type": "absolute_distance", "i": "p", "ground": [0, 0])",
                 radius, std::abs(along)});
  // A crank and a coupler, whose end stays on the x axis.
  const double coupler = radius * draw(1.1, 3), angle = draw(0.2, 2.9), cx = radius * std::cos(angle),
               cy = radius * std::sin(angle);
  const double sx = cx + std::sqrt(coupler * coupler - cy * cy);
  const std::string links = rod("r", 0, 0, cx, cy) + ", " + rod("c", cx, cy, sx, 0),
                    joint = pin + R"(, {"type": "revolute", "i": "r.to", "j": "c.from"}, )";
  const std::string slider = R"({"type": "absolute_y", "i": "c.to"})";
  all.push_back(
      {"a crank drawn out", links, joint + slider, R"("type": "absolute_x", "i": "c.to")", sx, radius + coupler});
  all.push_back({"a crank pushed in", links, joint + slider, R"("type": "relative_x", "i": "ground", "j": "c.to")", sx,
                 coupler - radius});
  all.push_back({"two particles drawn out", particle("p", cx, cy) + ", " + particle("q", sx, 0),
                 ring + R"(, {"type": "relative_distance", "i": "p", "j": "q"}, {"type": "absolute_y", "i": "q"})",
                 R"("type": "relative_x", "i": "ground", "j": "q")", sx, radius + coupler});
  // A four-bar linkage turned until coupler and rocker are in line.
  const double ground = 2 * radius, second = radius * draw(0.9, 1.2), third = radius * draw(0.9, 1.2);
  const double end =
      std::acos((radius * radius + ground * ground - (second + third) * (second + third)) / (2 * radius * ground));
  const double start = end * draw(0.7, 0.95), tx = radius * std::cos(start), ty = radius * std::sin(start);
  const double diagonal = std::hypot(ground - tx, ty);
  const double lean = std::atan2(-ty, ground - tx) +
                      std::acos((second * second + diagonal * diagonal - third * third) / (2 * second * diagonal));
  const double bx = tx + second * std::cos(lean), by = ty + second * std::sin(lean);
  all.push_back(
      {"a four-bar linkage",
       rod("r", 0, 0, tx, ty) + ", " + rod("c", tx, ty, bx, by) + ", " + rod("k", bx, by, ground, 0),
       joint +
           fmt::format(
               R"({{"type": "revolute", "i": "c.to", "j": "k.from"}}, {{"type": "revolute", "i": ["ground", [{:.17g}, 0]], "j": "k.to"}})",
               ground),
       R"("type": "absolute_angle", "i": "r")", start, end});
  return all;
}

void expect_lock_up(const Locking& locking, const std::string& beside, const std::string& forces, double t,
                    const std::string& analysis, const std::string& seed) {
  const TextRun run = run_text(
      R"({"catena": 1, "gravity": [0, -9.81], "bodies": {)" + locking.bodies + beside + R"(}, "constraints": [)" +
      locking.constraints + R"(], "drivers": [{"name": "d", )" + locking.driver +
      fmt::format(
          R"(, "value": {{"polynomial": [{:.17g}, {:.17g}]}}}}], {}"outputs": ["d.value"], "analyses": [{{{}, "until": {:.17g}, "every": {:.17g}}}]}})",
          locking.from, (locking.end - locking.from) / t, forces, analysis, 1.05 * t, 0.37 * t));
  const std::string what = fmt::format("{}: {}, {}: {}", seed, locking.kind, analysis, run.analysis().report.message);
  ASSERT_EQ(run.analysis().report.status, Status::lock_up) << what;
  double told = std::nan(""), value = std::nan("");
  for (const FieldRecord& record : records_of(run, "singular")) {
    for (const auto& [key, field] : record) {
      if (key == "t") told = std::get<double>(field);
      if (key == "value") value = std::get<double>(field);
    }
  }
  EXPECT_NEAR(told, t, 1e-7 * t) << what;
  EXPECT_NEAR(value, locking.end, 1e-7) << what;
  EXPECT_EQ(run.last("t"), told) << what;
  // The driver's coordinate there is of second order in the distance at which steps end.
  EXPECT_NEAR(run.last("d.value"), locking.end, 1e-6) << what;
}

// 3 seeds of ten mechanisms.
TEST(LockUpKinds, InEveryAnalysisAndMethod) {
  for (unsigned seed = 1; seed <= size_of_test(3u, 1u); ++seed) {
    std::mt19937 random(seed);
    const std::vector<Locking> all = lockings(random);
    const double t = std::uniform_real_distribution<double>(0.2, 2)(random);
    for (const Locking& locking : all) {
      for (const std::string& analysis : {std::string(R"("type": "kinematics")"), std::string(R"("type": "dynamics")"),
                                          std::string(R"("type": "dynamics", "method": "adams")"),
                                          std::string(R"("type": "dynamics", "method": "baumgarte")"),
                                          std::string(R"("type": "dynamics", "method": "partitioning")"),
                                          fmt::format(R"("type": "dynamics", "step": {:.17g})", t / 1000.5)}) {
        expect_lock_up(locking, "", "", t, analysis, fmt::format("seed {}", seed));
      }
    }
  }
}

// Beside something fast that is integrated by itself, and beside something that strikes a floor.
TEST(LockUpKinds, BesideOtherMechanisms) {
  for (unsigned seed = 1; seed <= 2; ++seed) {
    std::mt19937 random(seed);
    for (const Locking& locking : lockings(random)) {
      const std::string what = fmt::format("seed {}", seed), dynamics = R"("type": "dynamics")";
      expect_lock_up(locking, R"(, "fast": {"particle": true, "mass": 1, "position": [1, 0]})",
                     R"("forces": [{"type": "spring_damper", "i": "ground", "j": "fast", "k": 1e4, "length": 0}], )",
                     0.7, dynamics, what + ", beside a fast one");
      expect_lock_up(
          locking, R"(, "ball": {"particle": true, "mass": 1, "position": [20, 1]})",
          R"("forces": [{"type": "contact", "i": "ground", "j": "ball", "restitution": 0.5, "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}}], )",
          0.7, dynamics, what + ", beside a ball that bounces");
    }
  }
}

}  // namespace
}  // namespace catena::testing
