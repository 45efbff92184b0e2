// Gradients of random motions with impacts, compliant contacts, friction and events, carried forward and by the
// adjoint, against differences of whole runs extrapolated to fourth order.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>

#include "analysis/sanitized.hpp"
#include "design/measured.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

/// A parameter of a random scene.
struct Parameter {
  std::string name;
  double value;
};

struct RandomScene {
  std::vector<Parameter> parameters;
  std::string body;  // all but parameters and analyses
  std::string events;
  double until = 1;
};

/// Rods in a row that hang from the ground, bounded by stops between them.
RandomScene chain_with_stops(RandomNumbers& random) {
  const int links = 1 + static_cast<int>(random(0, 3));
  RandomScene scene;
  scene.parameters = {{"g", random(8, 11)}, {"l", random(0.3, 0.6)}, {"a", random(0.3, 0.8)}, {"m", random(0.5, 2)}};
  const bool rigid = random(0, 1) < 0.6;
  if (rigid) {
    scene.parameters.push_back({"e", random(0.2, 0.9)});
  } else {
    scene.parameters.push_back({"k", random(200, 2000)});
    scene.parameters.push_back({"c", random(0, 1) < 0.5 ? 0 : random(0.5, 3)});
  }
  const std::string bounce = rigid ? R"("restitution": "=e")" : R"("k": "=k", "c": "=c")";
  std::string bodies, joints, stops;
  std::string x = "0", y = "0";
  for (int n = 0; n < links; ++n) {
    const std::string name = "b" + std::to_string(n), angle = text_of(random(-0.2, 0.2));
    const std::string x2 = x + " + l*sin(" + angle + ")", y2 = y + " - l*cos(" + angle + ")";
    bodies += (n > 0 ? ", \"" : "\"") + name + R"(": {"mass": "=m*)" + text_of(random(0.5, 1.5)) +
              R"(", "rod": {"from": ["=)" + x + R"(", "=)" + y + R"("], "to": ["=)" + x2 + R"(", "=)" + y2 +
              R"("]}, "angular_velocity": )" + text_of(random(2, 6) * (random(0, 1) < 0.5 ? -1 : 1)) + "}";
    const std::string before = n == 0 ? R"(["ground", [0, 0]])" : "\"b" + std::to_string(n - 1) + ".to\"";
    joints += (n > 0 ? ", " : "") + (R"({"type": "revolute", "name": "J)" + std::to_string(n)) + R"(", "i": )" +
              before + R"(, "j": ")" + name + R"(.from"})";
    stops += (n > 0 ? ", " : "") + (R"({"type": "stop", "name": "S)" + std::to_string(n)) + R"(", "column": "J)" +
             std::to_string(n) + R"(.angle", "min": "=J_low)" + std::to_string(n) + R"(", "max": "=J_high)" +
             std::to_string(n) + "\", " + bounce + "}";
    x = x2;
    y = y2;
  }
  scene.body = R"("gravity": [0, "=-g"], "bodies": {)" + bodies + R"(}, "constraints": [)" + joints +
               R"(], "forces": [)" + stops + "]";
  // Bounds about the given angles, which are those of the rods.
  for (int n = 0; n < links; ++n) {
    for (const auto& [key, sign] : {std::pair{"J_low", "-"}, std::pair{"J_high", "+"}}) {
      const std::string place = key + std::to_string(n);
      for (std::size_t at = scene.body.find(place); at != std::string::npos; at = scene.body.find(place))
        scene.body.replace(at, place.size(),
                           std::string(sign) + "a*" + text_of(random(0.8, 1.2)) + (n == 0 ? " - pi/2" : ""));
    }
  }
  scene.until = random(0.4, 0.9);
  return scene;
}

/// A disc or a point thrown on a floor, a slope or a hump, with friction.
RandomScene thrown_disc(RandomNumbers& random) {
  RandomScene scene;
  scene.parameters = {{"g", random(8, 11)},     {"r", random(0.05, 0.15)}, {"h", random(0.3, 0.8)},
                      {"u", random(0.5, 2)},    {"w", random(-20, 20)},    {"mu", random(0.05, 0.6)},
                      {"s", random(-0.3, 0.3)}, {"m", random(0.5, 2)},     {"b", random(0.3, 0.6)}};
  const double kind = random(0, 1);
  std::string contact;
  if (kind < 0.35) {
    scene.parameters.push_back({"e", random(0.2, 0.9)});
    contact = R"("restitution": "=e")";
  } else if (kind < 0.6) {
    contact = R"("restitution": 0)";
  } else {
    scene.parameters.push_back({"k", random(500, 5000)});
    scene.parameters.push_back({"c", random(0, 1) < 0.4 ? 0 : random(1, 10)});
    contact = R"("k": "=k", "c": "=c")";
  }
  const bool smooth = random(0, 1) < 0.3;
  if (smooth) {
    scene.parameters.push_back({"vs", random(0.05, 0.3)});
    contact += R"(, "vs": "=vs")";
  }
  const bool hump = random(0, 1) < 0.3;
  const std::string curve = hump ? R"({"circle": {"centre": [0.4, "=-2*b*5"], "radius": "=2*b*5"}})"
                                 : R"({"line": {"point": [0, 0], "axis": [1, "=s"]}})";
  scene.body = R"("gravity": [0, "=-g"], "bodies": {"d": {"mass": "=m", "inertia": "=b*m*r^2", "position": [0, "=h"],
      "velocity": ["=u", 0], "angular_velocity": "=w"}}, "constraints": [], "forces": [{"type": "contact", "name": "floor",
      "i": "ground", "j": "d", "radius": "=r", "mu": "=mu", )" +
               contact + R"(, "curve": )" + curve + "}]";
  scene.until = random(0.6, 1.1);
  return scene;
}

/// A slider with friction on a rod that swings, pulled by a spring; a catch holds it or lets it go at an event.
RandomScene slider_with_catch(RandomNumbers& random) {
  RandomScene scene;
  scene.parameters = {{"g", random(8, 11)},       {"mu", random(0.05, 0.4)}, {"q", random(1.0, 1.6)},
                      {"k", random(20, 80)},      {"v", random(0.2, 1)},     {"m", random(0.5, 2)},
                      {"at", random(0.02, 0.08)}, {"p", random(-1, 1)}};
  const bool exact = random(0, 1) < 0.6;
  scene.body = R"("gravity": [0, "=-g"], "bodies": {"s": {"mass": "=m", "inertia": 0.02, "position": [0, 0],
      "velocity": ["=v", 0]}, "arm": {"mass": 1, "rod": {"from": [0, 0], "to": [0.3, -0.2]}, "angular_velocity": )" +
               text_of(random(-3, 3)) + R"(}},
      "constraints": [{"type": "translational", "name": "guide", "i": "ground", "j": "s", "axis_i": [1, 0]},
                      {"type": "revolute", "name": "pin", "i": "s", "j": "arm.from"}],
      "forces": [{"type": "friction", "name": "rub", "joint": "guide", "mu": "=mu", "mu_static": "=q*mu")" +
               (exact ? "" : R"(, "vs": 0.05)") + R"(},
                 {"type": "spring_damper", "i": ["ground", [-1, 0]], "j": "s", "k": "=k", "length": 1}])";
  scene.events =
      R"(, "events": [{"name": "knock", "when": "s.x", "value": "=at", "direction": "up", "impulse": {"i": "arm.to",
      "value": ["=p", 0.3]}}])";
  scene.until = random(0.5, 1.0);
  return scene;
}

/// `mode`: of the derivatives; empty: none.
std::string text_of_scene(const RandomScene& scene, const std::vector<Parameter>& parameters, const std::string& mode) {
  std::string list, names;
  for (const Parameter& p : parameters) {
    list += (list.empty() ? "\"" : ", \"") + p.name + "\": " + text_of(p.value);
    names += (names.empty() ? "\"" : ", \"") + p.name + "\"";
  }
  const std::string body = scene.body.find("\"b0\"") != std::string::npos    ? "b0"
                           : scene.body.find("\"arm\"") != std::string::npos ? "arm"
                                                                             : "d";
  const std::string run = R"({"type": "dynamics", "until": )" + text_of(scene.until) +
                          R"(, "every": 0.1, "tolerance": 1e-12)" + scene.events + R"(, "measures": {
      "x": {"final": ")" + body +
                          R"(.x"}, "angle": {"final": ")" + body + R"(.angle"},
      "speed": {"final": ")" +
                          body + R"(.omega"}, "way": {"integral": "=)" + body + R"(.vx^2"},
      "mean": {"mean": ")" +
                          body + R"(.omega"}}})";
  const std::string analysis = mode.empty() ? run
                                            : R"({"type": "sensitivity", "mode": ")" + mode + R"(", "parameters": [)" +
                                                  names + R"(], "of": )" + run + "}";
  return R"({"catena": 1, "parameters": {)" + list + "}, " + scene.body + R"(, "outputs": [], "analyses": [)" +
         analysis + "]}";
}

std::vector<std::string> story(const TextRun& run) {
  std::vector<std::string> kinds;
  for (const NamedField& field : run.analysis().fields) {
    if (field.name != "events") continue;
    for (const FieldRecord& record : std::get<std::vector<FieldRecord>>(field.value)) {
      for (const auto& [name, value] : record) {
        if (name == "kind" || name == "name") kinds.push_back(std::get<std::string>(value));
      }
    }
  }
  return kinds;
}

/// How many derivatives were compared, and how many scenes were gone back over.
int compared = 0, gone_back = 0;

std::string fault_of(const RandomScene& scene) {
  const TextRun run = run_text(text_of_scene(scene, scene.parameters, "forward"));
  if (!run.outcome.error_text.empty()) return run.outcome.error_text;
  if (!run.analysis().report.ok()) return {};  // a Painleve state, or the like: a motion that ends is none of ours
  const TextRun back = run_text(text_of_scene(scene, scene.parameters, "adjoint"));
  if (!back.outcome.error_text.empty()) return back.outcome.error_text;
  if (!back.analysis().report.ok()) return "the run of the adjoint: " + back.analysis().report.message;
  gone_back += went_back(back);
  const std::vector<std::string> events = story(run);
  for (std::size_t p = 0; p < scene.parameters.size(); ++p) {
    const double size = std::max(std::abs(scene.parameters[p].value), 0.1);
    std::array<std::array<double, 5>, 2> difference{};
    bool same = true;
    for (std::size_t level = 0; level < 2 && same; ++level) {
      const double h = (level == 0 ? 2e-4 : 1e-4) * size;
      std::array<std::array<double, 5>, 2> values{};
      for (std::size_t side = 0; side < 2 && same; ++side) {
        std::vector<Parameter> moved = scene.parameters;
        moved[p].value += side == 0 ? -h : h;
        const TextRun beside = run_text(text_of_scene(scene, moved, ""));
        same = beside.outcome.exit_code == 0 && story(beside) == events;
        for (std::size_t m = 0; m < 5 && same; ++m) values[side][m] = *beside.analysis().measures[m].value;
      }
      for (std::size_t m = 0; m < 5; ++m) difference[level][m] = (values[1][m] - values[0][m]) / (2 * h);
    }
    if (!same) continue;  // another number of impacts beside: the differences span a kink
    for (std::size_t m = 0; m < 5; ++m) {
      const double best = (4 * difference[1][m] - difference[0][m]) / 3, own = std::abs(best - difference[1][m]);
      for (const TextRun* one : {&run, &back}) {
        const MeasureResult& measure = one->analysis().measures[m];
        const double unit = std::max({std::abs(best), std::abs(*measure.value) / size, 1e-3});
        // Differences of values that are good to 1e-11.
        const double allowed = 2 * own + 1e-6 * unit + 1e-6;
        ++compared;
        if (std::abs(measure.gradient[p] - best) <= allowed) continue;
        return std::string(one == &run ? "forward" : "adjoint") + " d " + measure.name + "/d " +
               scene.parameters[p].name + " = " + text_of(measure.gradient[p]) + ", differences " + text_of(best) +
               " +- " + text_of(own) + " " + measure.trouble;
      }
    }
  }
  return {};
}

template <class Make>
void expect_gradients(unsigned first, unsigned last, Make&& make) {
  compared = gone_back = 0;
  expect_no_fault(first, last, [&](unsigned seed) {
    RandomNumbers random(seed);
    return fault_of(make(random));
  });
  EXPECT_GT(compared, 20 * static_cast<int>(last - first + 1));
  EXPECT_GT(2 * gone_back, static_cast<int>(last - first + 1));
}

TEST(RandomImpactGradients, OfChainsThatHitStops) { expect_gradients(1, size_of_test(8u, 1u), chain_with_stops); }
TEST(RandomImpactGradients, OfDiscsThatAreThrown) { expect_gradients(1, size_of_test(4u, 1u), thrown_disc); }
TEST(RandomImpactGradients, OfSlidersThatRub) { expect_gradients(1, size_of_test(4u, 1u), slider_with_catch); }

}  // namespace
}  // namespace catena::testing
