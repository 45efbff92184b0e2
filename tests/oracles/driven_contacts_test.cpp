// Drivers that move on against rigid contacts, stops, cables and ropes: the motion ends there, in closed form, with the
// element and the driver's value; and blows at several places that follow each other faster and faster come to an end.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "scene/event_entries.hpp"

namespace catena::testing {
namespace {

const std::string floor_of_ground = R"("curve": {"line": {"point": [0, 0], "axis": [1, 0]}}, "i": "ground")";
const std::string along_y = R"({"type": "absolute_x", "i": "p"})";

std::string particle(double y) {
  return fmt::format(R"("p": {{"particle": true, "mass": 1, "position": [0, {:.17g}]}})", y);
}

void expect_blocked(const std::string& bodies, const std::string& constraints, const std::string& driver,
                    const std::string& forces, double t, double value, const std::string& what, double known = 1e-9) {
  const TextRun run =
      run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {)" + bodies + R"(}, "constraints": [)" + constraints +
               R"(], "drivers": [{"name": "d", )" + driver + R"(}], "forces": [)" + forces +
               fmt::format(R"(], "outputs": ["d.value"], "analyses": [
      {{"type": "dynamics", "until": {:.17g}, "every": {:.17g}}}]}})",
                           1.3 * t, 0.4 * t));
  const std::string told = what + ": " + run.analysis().report.message;
  ASSERT_EQ(run.analysis().report.status, Status::lock_up) << told;
  EXPECT_NE(told.find("\"way\""), std::string::npos) << told;
  EXPECT_NEAR(run.last("t"), t, known * t) << told;
  EXPECT_NEAR(run.last("d.value"), value, 1e-9) << told;
  const auto singular = records_of(run, "singular");
  ASSERT_EQ(singular.size(), 1U) << told;
  for (const auto& [key, field] : singular.front()) {
    if (key == "driver") {
      EXPECT_EQ(std::get<std::string>(field), "d") << told;
    } else if (key == "value") {
      EXPECT_NEAR(std::get<double>(field), value, 1e-9) << told;
    }
  }
}

// 6 seeds.
TEST(DrivenContacts, EndWhereTheyAreMet) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    std::mt19937 random(seed);
    const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
    const double from = draw(0.5, 2), speed = draw(0.3, 3), t = from / speed;
    const std::string down =
        fmt::format(R"("type": "absolute_y", "i": "p", "value": {{"polynomial": [{:.17g}, {:.17g}]}})", from, -speed);
    const std::string contact =
        R"({"type": "contact", "name": "way", "j": "p", "restitution": 0.5, )" + floor_of_ground + "}";
    expect_blocked(particle(from), along_y, down, contact, t, 0, "a floor");
    const std::string cable =
        fmt::format(R"({{"type": "cable", "name": "way", "i": ["ground", [0, 3]], "j": "p", "length": 3}})");
    expect_blocked(particle(from), along_y, down, cable, t, 0, "a cable");
    // Over a peg: the straight part from (0, 3), which is 2 m from the rope's end.
    const std::string rope =
        R"({"type": "rope", "name": "way", "i": ["ground", [2, 3]], "over": [{"at": ["ground", [0, 3]], "radius": 0}], "j": "p", "length": 5})";
    expect_blocked(particle(from), along_y, down, rope, t, 0, "a rope");
    // A driven plate comes down on a ball that lies on the floor.
    const std::string plate = particle(from) + R"(, "ball": {"particle": true, "mass": 0.5, "position": [0, 0]})";
    const std::string squeeze =
        R"({"type": "contact", "j": "ball", )" + floor_of_ground +
        R"(}, {"type": "contact", "name": "way", "i": "p", "j": "ball", "side": -1, "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}})";
    expect_blocked(plate, along_y, down, squeeze, t, 0, "a plate");
    const std::string wheel = R"("p": {"mass": 1, "inertia": 1, "position": [0, 0]})";
    const std::string turn =
        fmt::format(R"("type": "absolute_angle", "i": "p", "value": {{"polynomial": [0, {:.17g}]}})", speed);
    expect_blocked(wheel, R"({"type": "revolute", "name": "pin", "i": ["ground", [0, 0]], "j": "p"})", turn,
                   fmt::format(R"({{"type": "stop", "name": "way", "column": "pin.angle", "max": {:.17g}}})", from), t,
                   from, "a stop");
  }
}

// Drivers that only touch pass; those that rest in touch and then press on end where they begin to: with the third
// power of time, so that a place known to 1e-26 gives an instant to 1e-9.
TEST(DrivenContacts, TouchingIsNotPressing) {
  const std::string contact = R"({"type": "contact", "name": "way", "j": "p", )" + floor_of_ground + "}";
  const TextRun run = run_text(R"({"catena": 1, "bodies": {)" + particle(0.5) + R"(}, "constraints": [)" + along_y +
                               R"(], "drivers": [{"type": "absolute_y", "i": "p", "value":
      {"harmonic": {"amplitude": 0.5, "omega": 2, "offset": 0.5}}}], "forces": [)" +
                               contact + R"(], "analyses": [{"type": "dynamics", "until": 6, "every": 0.5}]})");
  EXPECT_EQ(run.analysis().report.status, Status::ok) << run.analysis().report.message;
  expect_blocked(
      particle(0), along_y,
      R"("type": "absolute_y", "i": "p", "value": {"step": {"t0": 1, "t1": 2, "from": 0, "to": -1, "order": 5}})",
      contact, 1, 0, "a step", 1e-8);
}

// Boxes that hang on two cables or ropes, of every coupling between the places: they come to rest there. 24 seeds.
TEST(DrivenContacts, AlternatingBlowsComeToRest) {
  for (unsigned seed = 1; seed <= 24; ++seed) {
    std::mt19937 random(seed);
    const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
    const double half = draw(0.2, 0.8), inertia = std::pow(10, draw(-2, -0.5)), turned = draw(-0.3, 0.3);
    std::string forces;
    for (const double x : {-half, half}) {
      const std::string restitution = fmt::format(R"("restitution": {:.17g}, )", seed % 4 == 0 ? 0 : draw(0, 0.5));
      forces += forces.empty() ? "{" : ", {";
      if (seed % 2 == 1)
        forces += R"("type": "cable", )" + restitution +
                  fmt::format(R"("i": ["ground", [{0:.17g}, 2.4]], "j": ["p", [{0:.17g}, 0]], "length": 1.2}})", x);
      if (seed % 2 == 0)
        forces +=
            R"("type": "rope", )" + restitution +
            fmt::format(
                R"("i": ["ground", [{1:.17g}, 2.4]], "over": [{{"at": ["ground", [{0:.17g}, 2.4]], "radius": 0}}], "j": ["p", [{0:.17g}, 0]], "length": 1.7}})",
                x, x - 0.5);
    }
    const TextRun run = run_text(
        fmt::format(
            R"({{"catena": 1, "gravity": [0, -9.81], "bodies": {{"p": {{"mass": 1, "inertia": {:.17g}, "position": [0, 1.6], "angle": {:.17g}}}}}, "constraints": [{}], "forces": [)",
            inertia, turned, along_y) +
        forces +
        R"(], "outputs": ["p.y", "p.angle", "energy.total"], "analyses": [{"type": "dynamics", "until": 8, "every": 0.5}]})");
    const std::string what = fmt::format("seed {}: {}", seed, run.analysis().report.message);
    ASSERT_EQ(run.analysis().report.status, Status::ok) << what;
    EXPECT_NEAR(run.last("p.y"), 1.2, 1e-5) << what;
    EXPECT_NEAR(run.last("p.angle"), 0, 1e-5) << what;
    EXPECT_NEAR(run.last("energy.total"), 9.81 * 1.2, 1e-4) << what;
  }
}

}  // namespace
}  // namespace catena::testing
