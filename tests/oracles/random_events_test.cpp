// Instants of events in random scenes, driven and free, against closed forms. No code of the library computes them.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "analysis/sanitized.hpp"
#include "oracles/random_seeds.hpp"
#include "scene/event_entries.hpp"

namespace catena::testing {
namespace {

constexpr double pi = std::numbers::pi;

struct Expected {
  std::string name;
  double t;
  bool operator<(const Expected& other) const { return t < other.t; }
};

/// What differs between the list of a run and the one that is expected, in words.
std::string difference(const TextRun& run, std::vector<Expected> expected, double allowed) {
  if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
  std::sort(expected.begin(), expected.end());
  const std::vector<EventEntry> found = events_of(run);
  if (found.size() != expected.size()) return fmt::format("{} events, not {}", found.size(), expected.size());
  const std::vector<double> t = run.column("t");
  for (std::size_t k = 0; k < found.size(); ++k) {
    if (found[k].name != expected[k].name || !(std::abs(found[k].t - expected[k].t) <= allowed))
      return fmt::format("event {}: {} at {:.15g}, not {} at {:.15g}", k, found[k].name, found[k].t, expected[k].name,
                         expected[k].t);
    if (t[static_cast<std::size_t>(found[k].row)] != found[k].t) return fmt::format("row of event {}", k);
  }
  return {};
}

/// Whether two of them are so near to each other, or to the ends, that rounding decides.
bool doubtful(std::vector<Expected> events, double until) {
  std::sort(events.begin(), events.end());
  for (std::size_t k = 0; k < events.size(); ++k) {
    if (events[k].t > until - 1e-6 || (k > 0 && events[k].t - events[k - 1].t < 1e-6)) return true;
  }
  return false;
}

/// Real roots of a t^2 + b t + c = 0.
std::vector<double> roots(double a, double b, double c) {
  const double d = b * b - 4 * a * c;
  if (d < 0) return {};
  const double q = -(b + std::copysign(std::sqrt(d), b)) / 2;
  return {q / a, c / q};
}

// A crank whose angle is a t^2 / 2 + b t + c; its end passes places, its angle values; rows are anywhere.
std::string crank(unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  const double length = draw(0.2, 3), a = draw(-4, 4), b = draw(-10, 10), c = draw(-3, 3), until = draw(1, 12);
  const double x = length * draw(-0.99, 0.99), y = length * draw(-0.99, 0.99), angle = c + draw(-5, 5);
  std::vector<Expected> expected;
  const auto add = [&](const std::string& name, double at, int direction) {
    for (const double t : roots(a / 2, b, c - at)) {
      const double rate = a * t + b;
      if (t > 0 && t < until && (direction == 0 || direction * rate > 0)) expected.push_back({name, t});
    }
  };
  const int turns = 2 + static_cast<int>((std::abs(c) + until * (std::abs(b) + std::abs(a) * until)) / (2 * pi));
  for (int n = -turns; n <= turns; ++n) {
    // x falls where sin(angle) times the rate is positive.
    add("x", std::acos(x / length) + 2 * pi * n, 1);
    add("x", -std::acos(x / length) + 2 * pi * n, -1);
    add("y", std::asin(y / length) + 2 * pi * n, 0);
    add("y", pi - std::asin(y / length) + 2 * pi * n, 0);
  }
  add("angle", angle, 0);
  if (doubtful(expected, until)) return {};
  const bool dynamics = seed % 3 == 0;
  const TextRun run = run_text(fmt::format(
      R"({{"catena": 1, "bodies": {{"crank": {{"mass": 1, "rod": {{"from": [0, 0],
         "to": [{0:.17g}, {1:.17g}]}}}}}},
    "constraints": [{{"type": "revolute", "i": "ground", "j": "crank.from"}}],
    "drivers": [{{"type": "relative_angle", "i": "ground", "j": "crank", "value": {{"polynomial": [{2:.17g}, {3:.17g}, {4:.17g}]}}}}],
    "analyses": [{{"type": "{9}", "until": {5:.17g}, "every": {6:.17g}, "events": [
      {{"name": "x", "when": "crank.to.x", "value": {7:.17g}, "direction": "down"}},
      {{"name": "y", "when": "=crank.to.y - {8:.17g}"}},
      {{"name": "angle", "when": "crank.angle", "value": {10:.17g}}}]}}]}})",
      length * std::cos(c), length * std::sin(c), c, b, a / 2, until, draw(0.02, 1) * until, x, y,
      dynamics ? "dynamics" : "kinematics", angle));
  return difference(run, expected, 1e-9);
}

TEST(RandomEvents, OfACrank) { expect_no_fault(1, size_of_test(50u, 15u), crank); }

// Sliders on sines, as many as a block makes of them, seen at both ends of the run alone.
std::string sliders(unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  const int count = 1 + static_cast<int>(seed % 5);
  const double omega = draw(1, 30), phase = draw(0, 6), part = draw(-0.95, 0.95), until = draw(1, 5);
  std::vector<Expected> expected;
  for (int k = 1; k <= count; ++k) {
    for (int n = -2; n < 400; ++n) {
      for (const double angle : {std::asin(part) + 2 * pi * n, pi - std::asin(part) + 2 * pi * n}) {
        const double t = (angle - phase) / (omega * (1 + 0.1 * k));
        if (t > 0 && t < until) expected.push_back({fmt::format("s{}", k), t});
      }
    }
  }
  if (doubtful(expected, until)) return {};
  const TextRun run = run_text(fmt::format(
      R"({{"catena": 1, "parameters": {{"w": {0:.17g}, "n": {1}}},
    "replicate": [{{"count": "n", "bodies": {{"s{{k}}": {{"particle": true}}}},
      "constraints": [{{"type": "absolute_y", "i": "s{{k}}", "value": "=k"}}],
      "drivers": [{{"type": "absolute_x", "i": "s{{k}}", "value": {{"harmonic": {{"amplitude": "=0.5*k",
                   "omega": "=w + 0.1*w*k", "phase": {2:.17g}}}}}}}]}}],
    "analyses": [{{"type": "kinematics", "at": {3:.17g},
      "replicate": [{{"count": "n", "events": [{{"name": "s{{k}}", "when": "=s{{k}}.x/k", "value": {4:.17g}}}]}}]}}]}})",
      omega, count, phase, until, part / 2));
  return difference(run, expected, 1e-9);
}

TEST(RandomEvents, OfSliders) { expect_no_fault(101, 130, sliders); }

// Thrown balls, which fall freely: y = y0 + v t - g t^2 / 2.
std::string balls(unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  const double g = draw(1, 20), v = draw(1, 12), until = draw(1, 4);
  const int count = 2 + static_cast<int>(seed % 4);
  std::vector<Expected> expected;
  for (int k = 1; k <= count; ++k) {
    for (const double t : roots(-g / 2, v + 0.5 * k, -0.1 * k)) {
      if (t > 0 && t < until) expected.push_back({fmt::format("ball{}", k), t});
    }
  }
  if (doubtful(expected, until)) return {};
  const TextRun run = run_text(fmt::format(
      R"({{"catena": 1, "gravity": [0, {0:.17g}], "parameters": {{"v": {1:.17g}}},
    "replicate": [{{"count": {2}, "bodies": {{"b{{k}}": {{"particle": true, "mass": 1, "position": ["=k", 0],
       "velocity": [1, "=v + 0.5*k"]}}}}}}],
    "analyses": [{{"type": "dynamics", "until": {3:.17g}, "every": {3:.17g}, "tolerance": 1e-10,
      "replicate": [{{"count": {2}, "events": [{{"name": "ball{{k}}", "when": "b{{k}}.y", "value": "=0.1*k"}}]}}]}}]}})",
      -g, v, count, until));
  return difference(run, expected, 1e-9);
}

TEST(RandomEvents, OfThrownBalls) { expect_no_fault(201, 230, balls); }

// A slide whose drivers take turns: each moves it by its own speed from where the one before let it go.
std::string relay(unsigned seed) {
  std::mt19937 random(seed);
  const auto draw = [&](double from, double to) { return std::uniform_real_distribution<double>(from, to)(random); };
  const int legs = 2 + static_cast<int>(seed % 4);
  std::string drivers, events;
  std::vector<Expected> expected;
  double t = 0, x = 0;
  for (int k = 0; k < legs; ++k) {
    const double speed = draw(0.3, 3), way = draw(0.2, 1);
    drivers += fmt::format(
        R"({}{{"type": "absolute_x", "name": "d{}", "i": "a", "value": {{"polynomial": [{:.17g}, {:.17g}]}}}})",
        k ? ", " : "", k, x - speed * t, speed);
    t += way / speed;
    x += way;
    if (k + 1 == legs) break;
    events += fmt::format(
        R"({}{{"name": "on", "when": "a.x", "value": {:.17g}, "action": "engage", "element": "d{}"}},
      {{"name": "off", "when": "a.x", "value": {:.17g}, "action": "release", "element": "d{}"}})",
        k ? ", " : "", x, k + 1, x, k);
    expected.push_back({"on", t});
    expected.push_back({"off", t});
  }
  const TextRun run = run_text(fmt::format(
      R"({{"catena": 1, "bodies": {{"a": {{"particle": true, "mass": 2}}}},
    "constraints": [{{"type": "absolute_y", "i": "a", "value": 0}}], "drivers": [{}], "outputs": ["a.x"],
    "analyses": [{{"type": "{}", "until": {:.17g}, "events": [{}]}}]}})",
      drivers, seed % 2 ? "dynamics" : "kinematics", t, events));
  if (std::string wrong = difference(run, expected, 1e-8); !wrong.empty()) return wrong;
  return std::abs(run.last("a.x") - x) < 1e-7 ? std::string() : fmt::format("ends at {}, not {}", run.last("a.x"), x);
}

TEST(RandomEvents, OfDriversThatTakeTurns) { expect_no_fault(301, 330, relay); }

}  // namespace
}  // namespace catena::testing
