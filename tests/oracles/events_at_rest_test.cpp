// Events where nothing moves, or all moves evenly, and loads or the watched columns oscillate: steps are as long as the
// run there, and hold many periods. Against closed forms: instants of sines.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "analysis/sanitized.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "scene/event_entries.hpp"

namespace catena::testing {
namespace {

/// The instants in (0, end) at which amplitude sin(omega t + phase) = value.
std::vector<double> passages(double amplitude, double omega, double phase, double value, double end) {
  std::vector<double> found;
  const double arc = std::asin(value / amplitude), turn = 2 * std::numbers::pi;
  for (double k = -2; (k - 1) * turn < omega * end + turn; ++k) {
    for (const double angle : {arc + k * turn, std::numbers::pi - arc + k * turn}) {
      const double t = (angle - phase) / omega;
      if (t > 0 && t < end) found.push_back(t);
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string difference(const TextRun& run, const std::vector<double>& expected) {
  if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
  const std::vector<EventEntry> found = events_of(run);
  if (found.size() != expected.size()) return fmt::format("{} events, not {}", found.size(), expected.size());
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (!(std::abs(found[k].t - expected[k]) <= 1e-9))
      return fmt::format("event {} at {:.15g}, not at {:.15g}", k, found[k].t, expected[k]);
  }
  return {};
}

struct Load {
  double amplitude, omega, phase, value, end;
  explicit Load(unsigned seed) {
    RandomNumbers random(seed);
    amplitude = random(1, 20);
    omega = std::exp(random(0, 5));
    phase = random(-3, 3);
    value = amplitude * random(-0.95, 0.95);
    // Whole periods for some: samples at equal distances would all be alike.
    end = seed % 3 == 0 ? 16 * std::numbers::pi / omega : random(5, 20);
  }
};

// The reaction of a body that is held under a force, by a function of time or a law; a body beside it turns evenly.
TEST(EventsAtRest, LoadsOfAHeldBody) {
  expect_no_fault(1, size_of_test(60u, 8u), [](unsigned seed) {
    const Load load(seed);
    const std::string by_time =
        fmt::format(R"({{"harmonic": {{"amplitude": {:.17g}, "omega": {:.17g}, "phase": {:.17g}}}}})", load.amplitude,
                    load.omega, load.phase);
    const std::string by_law =
        fmt::format("\"=0*b.x + {:.17g}*sin({:.17g}*t + {:.17g})\"", load.amplitude, load.omega, load.phase);
    const std::string type = seed % 2 == 0 ? "dynamics" : "inverse_dynamics";
    const TextRun run =
        run_text(R"({"catena": 1, "bodies": {"b": {"mass": 1, "inertia": 1}, "c": {"mass": 1, "inertia": 1}},
      "constraints": [{"type": "weld", "name": "W", "i": "ground", "j": "b"},
                      {"type": "revolute", "i": "ground", "j": "c"}],
      "drivers": [{"type": "absolute_angle", "i": "c", "value": {"polynomial": [0, 0.01]}}],
      "forces": [{"type": "point_force", "i": "b", "force": [0, )" +
                 (seed % 4 < 2 ? by_time : by_law) + R"(]}],
      "outputs": ["W.fy"], "analyses": [{"type": ")" +
                 type + "\", \"until\": " + text_of(load.end) + ", \"every\": " + text_of(load.end) +
                 R"(, "events": [{"name": "e", "when": "W.fy", "value": )" + text_of(-load.value) + "}]}]}");
    return difference(run, passages(load.amplitude, load.omega, load.phase, load.value, load.end));
  });
}

// A point that goes on evenly, watched by a sine of its place.
TEST(EventsAtRest, SinesOfAPlaceThatMovesEvenly) {
  expect_no_fault(1, 40, [](unsigned seed) {
    const Load load(seed);
    const std::string when = "=" + text_of(load.amplitude) + "*sin(b.x + " + text_of(load.phase) + ")";
    const TextRun run =
        run_text(R"({"catena": 1, "bodies": {"b": {"mass": 1, "particle": true, "velocity": [)" + text_of(load.omega) +
                 R"(, 0]}}, "outputs": ["b.x"],
      "analyses": [{"type": "dynamics", "until": )" +
                 text_of(load.end) + ", \"every\": " + text_of(load.end) + R"(, "events": [{"name": "e", "when": ")" +
                 when + R"(", "value": )" + text_of(load.value) + "}]}]}");
    return difference(run, passages(load.amplitude, load.omega, load.phase, load.value, load.end));
  });
}

// A block that sticks on a rough floor slips as soon as the force exceeds what friction can hold, to either side.
TEST(EventsAtRest, BlocksThatStick) {
  int judged = 0;
  expect_no_fault(1, size_of_test(40u, 5u), [&](unsigned seed) -> std::string {
    const Load load(seed);
    const double held = std::abs(load.value);
    const std::vector<double> up = passages(load.amplitude, load.omega, load.phase, held, load.end),
                              down = passages(load.amplitude, load.omega, load.phase, -held, load.end);
    if (std::abs(load.amplitude * std::sin(load.phase)) > held || up.empty() || down.empty()) return {};
    ++judged;
    const double first = std::min(up.front(), down.front());
    const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -10], "bodies": {"b": {"mass": 1, "particle": true}},
      "forces": [{"type": "contact", "name": "floor", "i": "ground", "j": "b",
                  "curve": {"line": {"point": [0, 0], "axis": [1, 0]}}, "mu": )" +
                                 text_of(held / 20) + ", \"mu_static\": " + text_of(held / 10) + R"(},
                 {"type": "point_force", "i": "b", "force": [{"harmonic": {"amplitude": )" +
                                 text_of(load.amplitude) + ", \"omega\": " + text_of(load.omega) +
                                 ", \"phase\": " + text_of(load.phase) +
                                 R"(}}, 0]}], "outputs": ["b.x"], "analyses": [{"type": "dynamics", "until": )" +
                                 text_of(load.end) + ", \"every\": " + text_of(load.end) + "}]}");
    if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
    const std::vector<EventEntry> found = events_of(run);
    if (found.empty() || found.front().kind != "slip") return "does not slip first";
    return std::abs(found.front().t - first) <= 1e-9
               ? std::string()
               : fmt::format("slips at {:.15g}, not at {:.15g}", found.front().t, first);
  });
  EXPECT_GT(judged, size_of_test(5, 1));
}

// A body at rest under a law that is a pulse in time, six widths and more from both ends: it moves on with its impulse.
TEST(EventsAtRest, PulsesOfLaws) {
  expect_no_fault(1, 60, [](unsigned seed) -> std::string {
    RandomNumbers random(seed);
    const double end = std::exp(random(0, 4)), width = end * std::exp(random(-4.5, -3)), at = end * random(0.3, 0.7);
    const double force = random(1, 20), stiffness = seed % 2 == 0 ? 0 : random(0.1, 1) / (end * end);
    const char* method = seed % 3 == 0 ? "adams" : seed % 3 == 1 ? "rk8" : "rk5";
    const std::string law =
        fmt::format("=-{:.17g}*b.x + {:.17g}*exp(-((t - {:.17g})/{:.17g})^2)", stiffness, force, at, width);
    const TextRun run =
        run_text(R"({"catena": 1, "gravity": [0, 0], "bodies": {"b": {"mass": 2, "particle": true}},
      "forces": [{"type": "point_force", "i": "b", "force": [")" +
                 law + R"(", 0]}], "outputs": ["b.vx", "b.x"], "analyses": [{"type": "dynamics", "method": ")" +
                 method + R"(", "until": )" + text_of(end) + ", \"every\": " + text_of(end) + "}]}");
    if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
    // On a spring: v = integral of F(s) cos(omega (end - s)) / m, by the transform of the bell.
    const double omega = std::sqrt(stiffness / 2), whole = force * std::sqrt(std::numbers::pi) * width / 2;
    const double v = whole * std::exp(-omega * omega * width * width / 4) * std::cos(omega * (end - at));
    return std::abs(run.last("b.vx") - v) <= 1e-5 * whole ? std::string()
                                                          : fmt::format("{} m/s, not {}", run.last("b.vx"), v);
  });
}

}  // namespace
}  // namespace catena::testing
