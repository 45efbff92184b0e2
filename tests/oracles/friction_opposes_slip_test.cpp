// Carts on guides with rods hung on them, both rubbing, from rest under harmonic loads: they stick, slip and turn
// round. In every row friction opposes the slip and is what presses times mu, by the cart's own balance of forces; and
// what steps of other kinds find is the same motion. The forces at stages of steps that are given up say nothing.
#include <gtest/gtest.h>

#include <cmath>
#include <string>

#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

struct Cart {
  std::string scene;
  double mu = 0;
};

// A push along the guide on the cart, a torque on the rod. `method` of the run.
Cart random_cart(unsigned seed, const std::string& method) {
  RandomNumbers random(seed);
  Cart cart{.scene = {}, .mu = random(0.2, 0.5)};
  const double mass = random(0.5, 2), rod = random(1, 4), half = random(0.2, 0.4), angle = random(-3, 3);
  const auto harmonic = [&](double most) {
    return R"({"harmonic": {"amplitude": )" + text_of(random(0.5, 1) * most) + R"(, "omega": )" +
           text_of(random(3, 6)) + R"(, "phase": )" + text_of(random(-3, 3)) + "}}";
  };
  const std::string push = harmonic(1.5 * cart.mu * 9.81 * (mass + rod)), torque = harmonic(6);
  cart.scene = R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"s": {"mass": )" + text_of(mass) +
               R"(, "inertia": 0.01}, "p": {"mass": )" + text_of(rod) + R"(, "inertia": )" +
               text_of(rod * half * half / 3) + R"(, "position": )" +
               pair_of(half * std::cos(angle), half * std::sin(angle)) + R"(, "angle": )" + text_of(angle) +
               R"(}}, "constraints": [{"type": "translational", "name": "G", "i": "ground", "j": "s", "axis_i": [1, 0]},
      {"type": "revolute", "name": "J", "i": "s", "j": ["p", )" +
               pair_of(-half, 0) + R"(]}], "forces": [{"type": "friction", "name": "FG", "joint": "G", "mu": )" +
               text_of(cart.mu) + R"(}, {"type": "friction", "name": "FJ", "joint": "J", "mu": )" +
               text_of(random(0.1, 0.4)) + R"(, "radius": 0.1}, {"type": "point_force", "i": "s", "force": [)" + push +
               R"(, 0]}, {"type": "torque", "i": "p", "torque": )" + torque +
               R"(}], "outputs": ["s.x", "p.angle", "FG.slip", "FG.friction", "FJ.slip", "FJ.friction", "p.ay"],
      "analyses": [{"type": "dynamics", "until": 3, "every": 0.02, "method": ")" +
               method + R"(", "tolerance": 1e-8, "digits": false}]})";
  return cart;
}

std::string fault(unsigned seed) {
  const Cart cart = random_cart(seed, "auto");
  const TextRun run = run_text(cart.scene), other = run_text(random_cart(seed, "radau").scene);
  for (const TextRun* one : {&run, &other}) {
    if (!one->analysis().report.ok()) return one->analysis().report.message;
  }
  const auto t = run.column("t");
  for (const std::string joint : {"FG", "FJ"}) {
    const auto slip = run.column(joint + ".slip"), friction = run.column(joint + ".friction");
    for (std::size_t k = 0; k < t.size(); ++k) {
      if (slip[k] * friction[k] > 1e-9 * std::abs(friction[k]))
        return joint + " rubs along its slip of " + text_of(slip[k]) + " at " + text_of(t[k]);
    }
  }
  for (const std::string column : {"s.x", "p.angle"}) {
    const double difference = std::abs(run.last(column) - other.last(column));
    if (!(difference < 1e-4)) return column + " ends " + text_of(difference) + " from where radau's steps end";
  }
  return {};
}

TEST(FrictionOpposesSlip, OfCartsWithRods) { expect_no_fault(1, 20, fault); }

// A slider-crank from rest whose slide rubs, turned over once by a harmonic push. By three other kinds of steps and an
// integration in one coordinate with events.
TEST(FrictionOpposesSlip, OfASliderCrankFromRest) {
  const std::string before = R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
    "crank": {"mass": 1.8295256908810744, "inertia": 0.019900293445163454,
      "position": [-0.03338028215247594, 0.14366749743509702], "angle": 1.799089811557446},
    "rod": {"mass": 1.9372814156189104, "inertia": 0.13874736322952122,
      "position": [0.35862337022876073, 0.1031954416245193], "angle": -0.4085248250552145},
    "sl": {"mass": 2.770569448246835, "inertia": 0.02770569448246835,
      "position": [0.8340073047624734, -0.06094411162115544], "angle": -0.11487898724129574}},
    "constraints": [{"type": "revolute", "i": "ground", "j": ["crank", [-0.14749438313319768, 0]]},
      {"type": "revolute", "i": ["crank", [0.14749438313319768, 0]], "j": ["rod", [-0.4635287119789869, 0]]},
      {"type": "revolute", "i": ["rod", [0.46352871197898693, 0]],
        "j": ["sl", [-0.047377903660481974, -0.02559949696259857]]},
      {"type": "translational", "name": "G", "i": ["ground", [0.7853979855758056, -0.10926461151067604]],
        "j": ["sl", [-0.04275011024587212, -0.05357391805095356]], "axis_i": [-1, 0],
        "axis_j": [-0.9934086628538165, -0.11462647411044463]}],
    "forces": [{"type": "friction", "name": "FG", "joint": "G", "mu": 0.24, "length": 0.51},
      {"type": "point_force", "i": ["sl", [-0.047, -0.026]],
        "force": [{"harmonic": {"amplitude": 34, "omega": 5.9, "phase": 2.7}}, 0]}],
    "outputs": ["FG.slip"], "analyses": [{"type": "dynamics", "until": 1.2, "every": 0.01, "method": ")";
  for (const std::string method : {"auto", "rk8", "rk5", "radau", "adams"}) {
    const TextRun run = run_text(before + method + "\"}]}");
    ASSERT_TRUE(run.analysis().report.ok()) << method << ": " << run.analysis().report.message;
    for (const std::string& warning : run.analysis().report.warnings)
      EXPECT_EQ(warning.find("did not meet"), std::string::npos) << warning;
    EXPECT_NEAR(run.last("FG.slip"), -0.3420415, 1e-6) << method;
  }
}

// A rod on one pin from rest, mu_static above mu, under loads of the ground and of a torque: what presses the pin
// follows from the centroid's acceleration. What presses it while it slides may be enough to hold it, and the other way
// round.
std::string fault_of_pin(unsigned seed) {
  RandomNumbers random(seed);
  const double mass = random(0.5, 2), half = random(0.2, 0.5), angle = random(-3, 3), mu = random(0.2, 0.4),
               hold = random(1, 1.5) * mu, radius = random(0.1, 0.25), torque = random(2, 8);
  const double push[2] = {random(5, 20), random(5, 20)}, rate[3] = {random(3, 9), random(3, 9), random(3, 9)};
  const auto harmonic = [](double amplitude, double omega) {
    return R"({"harmonic": {"amplitude": )" + text_of(amplitude) + R"(, "omega": )" + text_of(omega) + "}}";
  };
  const TextRun run = run_text(
      R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"a": {"mass": )" + text_of(mass) + R"(, "inertia": )" +
      text_of(mass * half * half / 3) + R"(, "position": )" + pair_of(half * std::cos(angle), half * std::sin(angle)) +
      R"(, "angle": )" + text_of(angle) +
      R"(}}, "constraints": [{"type": "revolute", "name": "J", "i": "ground", "j": ["a", )" + pair_of(-half, 0) +
      R"(]}], "forces": [{"type": "friction", "name": "F", "joint": "J", "mu": )" + text_of(mu) + R"(, "mu_static": )" +
      text_of(hold) + R"(, "radius": )" + text_of(radius) + R"(}, {"type": "torque", "i": "a", "torque": )" +
      harmonic(torque, rate[2]) + R"(}, {"type": "point_force", "i": "a", "force": [)" + harmonic(push[0], rate[0]) +
      "," + harmonic(push[1], rate[1]) +
      R"(]}], "outputs": ["a.ax", "a.ay", "F.slip", "F.friction"], "analyses": [{"type": "dynamics", "until": 2,
      "every": 0.01, "digits": false}]})");
  if (!run.analysis().report.ok()) return run.analysis().report.message;
  const auto t = run.column("t"), ax = run.column("a.ax"), ay = run.column("a.ay"), slip = run.column("F.slip"),
             friction = run.column("F.friction");
  for (std::size_t k = 0; k < t.size(); ++k) {
    const double pressed = radius * std::hypot(mass * ax[k] - push[0] * std::sin(rate[0] * t[k]),
                                               mass * (ay[k] + 9.81) - push[1] * std::sin(rate[1] * t[k]));
    const bool slides = std::abs(slip[k]) > 1e-7;
    const bool fits = slides ? std::abs(friction[k] + std::copysign(mu * pressed, slip[k])) < 1e-6 * (1 + pressed)
                             : std::abs(friction[k]) < hold * pressed + 1e-6;
    if (!fits)
      return "friction " + text_of(friction[k]) + " at slip " + text_of(slip[k]) + ", pressed by " + text_of(pressed) +
             ", t = " + text_of(t[k]);
  }
  return {};
}

TEST(FrictionOpposesSlip, OfRodsOnPins) { expect_no_fault(1, 80, fault_of_pin); }

// One that reaches, at 0.167 s, a place at rest where sliding presses its pin enough to hold, and holding does not. It
// slides back at first, as a double-precision sum of all moments has it: -0.5465 rad/s^2.
TEST(FrictionOpposesSlip, WhereHoldingPressesLessThanSliding) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"a": {"mass": 1.6639370631765389,
    "inertia": 0.0965887689675498, "position": [0.16289144477278109, 0.41197144933445934], "angle": -2.0283282556620215}},
    "constraints": [{"type": "revolute", "name": "J", "i": ["ground", [0.38108470269240335, 0.8551126694716145]],
      "j": ["a", [-0.49394578527023125, 0]]}],
    "forces": [{"type": "friction", "joint": "J", "mu": 0.32602343460104627, "mu_static": 0.449363128111514,
        "radius": 0.1924974065574897},
      {"type": "torque", "i": "a", "torque": {"harmonic": {"amplitude": 6.550432243073943, "omega": 4.992936490135872,
        "phase": -2.0690888211400176, "offset": 0.433091188535488}}},
      {"type": "point_force", "i": ["a", [-0.22360261614332605, 0.0013674991262887654]], "force": [
        {"harmonic": {"amplitude": 19.163536637007333, "omega": 8.783501817985483, "phase": 1.1972469339901004}},
        {"harmonic": {"amplitude": 13.01812996861276, "omega": 5.692633889403312, "phase": 5.634397033737475,
          "offset": 4.032007906205179}}]}],
    "outputs": ["a.alpha"], "analyses": [{"type": "dynamics", "at": [0.16723588, 1.2]}]})");
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  EXPECT_NEAR(run.column("a.alpha")[0], -0.5465, 1e-3);
}

}  // namespace
}  // namespace catena::testing
