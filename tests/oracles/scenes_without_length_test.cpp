// Scenes in which nothing gives a length, particles on springs without length at one place: the same in all units.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

struct Units {
  double length = 1, force = 1;
};

/// y of the particle at rest and omega2 about it, in the units of the scene, under g = 10 and a mass of one.
struct AtRest {
  const char* what;
  std::string (*forces)(const Units&);
  double y, omega2;
};

std::string law(const std::string& x, const std::string& y) {
  return R"({"type": "point_force", "i": "p", "force": ["=)" + x + R"(", "=)" + y + R"("]})";
}

const AtRest scenes[] = {
    {"spring",
     [](const Units& u) {
       return R"({"type": "spring_damper", "i": "ground", "j": "p", "length": 0, "k": )" +
              text_of(3 * u.force / u.length) + "}";
     },
     -10.0 / 3, 3},
    {"bushing",
     [](const Units& u) {
       return R"({"type": "bushing", "i": "ground", "j": "p", "kx": )" + text_of(7 * u.force / u.length) +
              R"(, "ky": )" + text_of(5 * u.force / u.length) + R"(, "kt": 0})";
     },
     -2, 5},
    {"far spring",
     [](const Units& u) {
       return R"({"type": "spring_damper", "i": "ground", "j": "p", "length": 0, "k": )" +
              text_of(1e-6 * u.force / u.length) + "}";
     },
     -1e7, 1e-6},
    {"law",
     [](const Units& u) {
       const std::string k = text_of(u.force / u.length);
       return law("-" + k + "*p.x-0.5*" + k + "*p.y", "-2*" + k + "*p.y");
     },
     -5, 1},
    {"cubic law",
     [](const Units& u) {
       const std::string k = text_of(u.force / u.length);
       return law("-" + k + "*p.x", "-" + text_of(u.force) + "*(p.y/" + text_of(u.length) + ")^3");
     },
     -std::cbrt(10.0), 1},
    {"cable",
     [](const Units& u) {
       return R"({"type": "cable", "i": "ground", "j": "p", "length": )" + text_of(2 * u.length) + R"(, "k": )" +
              text_of(5 * u.force / u.length) + "}";
     },
     -4, 2.5},
};

std::string fault_of(unsigned seed) {
  RandomNumbers random(seed);
  const double decades = random(-9, 9);
  const Units units{std::pow(10.0, decades), std::pow(10.0, random(-9, 9))};
  for (const AtRest& scene : scenes) {
    const TextRun run =
        run_text(R"({"catena": 1, "gravity": [0, )" + text_of(-10 * units.force) +
                 R"(], "bodies": {"p": {"particle": true, "mass": 1}}, "forces": [)" + scene.forces(units) +
                 R"(], "outputs": ["p.y"], "analyses": [{"type": "equilibrium"}, {"type": "modes"}]})");
    const std::string name = std::string(scene.what) + " at " + text_of(units.length) + " m: ";
    for (std::size_t k = 0; k < 2; ++k) {
      const Report& report = run.analysis(k).report;
      if (!report.ok()) return name + std::string(to_string(report.status)) + ": " + report.message;
    }
    if (!(std::abs(run.last("p.y") / units.length - scene.y) <= 1e-10 * std::abs(scene.y)))
      return name + "y " + text_of(run.last("p.y") / units.length);
    if (!(std::abs(run.first("omega2", 1) * units.length / units.force - scene.omega2) <= 1e-9 * scene.omega2))
      return name + "omega2 " + text_of(run.first("omega2", 1) * units.length / units.force);
  }
  return "";
}

TEST(ScenesWithoutLength, RestAtTheSamePlaces) { expect_no_fault(1, 20, fault_of); }

}  // namespace
}  // namespace catena::testing
