// Gradients of motions in which an impact makes a damped floor press again at its very instant, against closed forms
// whose derivatives are formed by complex steps.
#include <gtest/gtest.h>

#include <array>
#include <complex>

#include "analysis/sanitized.hpp"
#include "design/measured.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

using Complex = std::complex<double>;

/// A particle of mass 1 in a floor that reaches up to y = 0, thrown at y0 downwards, and a ceiling within the floor.
/// The floor lets it go while it comes up, where k y + c y' = 0, and has it again from the ceiling on.
struct UnderCeiling {
  static constexpr std::array<const char*, 5> names{"v", "k", "c", "e", "ceiling"};
  std::array<Complex, 5> value{};
  double start = 0, until = 0;

  struct State {
    Complex y, v;
  };
  /// y'' = -k y - c y' for a time t.
  State pressed(const State& from, Complex t) const {
    const Complex half = value[2] / 2.0, w = std::sqrt(value[1] - half * half);
    const Complex a = from.y, b = (from.v + half * a) / w, fade = std::exp(-half * t);
    const Complex c = std::cos(w * t), s = std::sin(w * t);
    return {fade * (a * c + b * s), fade * ((w * b - half * a) * c - (w * a + half * b) * s)};
  }
  /// Where the floor lets go first.
  Complex release() const {
    const State from{start, value[0]};
    const auto force = [&](Complex t) {
      const State now = pressed(from, t);
      return -value[1] * now.y - value[2] * now.v;
    };
    double low = 0, high = 0;
    while (force(high).real() > 0) high += 1e-3;
    for (int n = 0; n < 60; ++n) (force((low + high) / 2).real() > 0 ? low : high) = (low + high) / 2;
    Complex t = low;
    // Its acceleration is zero there, so that the force changes by -k v.
    for (int n = 0; n < 3; ++n) t += force(t) / (value[1] * pressed(from, t).v);
    return t;
  }
  /// When it hits the ceiling.
  Complex impact() const {
    const Complex t = release();
    const State free = pressed({start, value[0]}, t);
    return t + (value[4] - free.y) / free.v;
  }
  /// y at the end; integrals of y, y' and of the force of the floor.
  std::array<Complex, 4> measures() const {
    const Complex let_go = release(), hits = impact();
    const State first{start, value[0]}, free = pressed(first, let_go);
    const State back{value[4], -value[3] * free.v}, last = pressed(back, until - hits);
    const auto way = [this](const State& a, const State& b) {
      return -(b.v - a.v + value[2] * (b.y - a.y)) / value[1];
    };
    return {last.y, way(first, free) + (free.y + value[4]) / 2.0 * (hits - let_go) + way(back, last), last.y - start,
            free.v - first.v + last.v - back.v};
  }
};

std::string text_of_ceiling(const UnderCeiling& scene, const std::string& mode) {
  std::string values, names;
  for (std::size_t p = 0; p < scene.value.size(); ++p) {
    values += (p > 0 ? ", \"" : "\"") + std::string(UnderCeiling::names[p]) + "\": " + text_of(scene.value[p].real());
    names += (p > 0 ? ", \"" : "\"") + std::string(UnderCeiling::names[p]) + "\"";
  }
  const auto line = [](const std::string& y) {
    return R"("curve": {"line": {"point": [0, )" + y + R"(], "axis": [1, 0]}}})";
  };
  return R"({"catena": 1, "parameters": {)" + values +
         R"(}, "bodies": {"b": {"particle": true, "mass": 1, "position": [0, )" + text_of(scene.start) +
         R"(], "velocity": [0, "v"]}}, "constraints": [{"type": "absolute_x", "i": "b", "value": 0}],
    "forces": [{"type": "contact", "name": "floor", "i": "ground", "j": "b", "k": "k", "c": "c", )" +
         line("0") +
         R"(, {"type": "contact", "name": "top", "i": "ground", "j": "b", "side": -1, "restitution": "e", )" +
         line("\"ceiling\"") + R"(], "analyses": [{"type": "sensitivity", "mode": ")" + mode + R"(", "parameters": [)" +
         names + R"(], "of": {"type": "dynamics", "until": )" + text_of(scene.until) +
         R"(, "tolerance": 1e-10, "measures": {"y": {"final": "b.y"}, "way": {"integral": "b.y"},
      "rise": {"integral": "b.vy"}, "push": {"integral": "floor.force"}, "t": {"field": "events[3].t"}}}}]})";
}

TEST(ImpactOnDamped, PressesAgainAtOnce) {
  expect_no_fault(1, size_of_test(12u, 2u), [](unsigned seed) -> std::string {
    RandomNumbers random(seed);
    UnderCeiling scene;
    scene.start = random(-0.08, -0.03);
    const double k = random(60, 200), v = random(-2.5, -1), c = random(0.5, 1.2) * std::sqrt(k), e = random(0.3, 0.8);
    scene.value = {v, k, c, e, 0};
    const Complex let_go = scene.release();
    const double free = scene.pressed({scene.start, v}, let_go).y.real();
    scene.value[4] = free * random(0.2, 0.8);
    const UnderCeiling::State after{scene.value[4], -e * scene.pressed({scene.start, v}, let_go).v};
    // Until before the floor lets it go again, or it comes up to the ceiling.
    double pressed = 0;
    const auto rises = [&](double t) { return scene.pressed(after, t).v.real() > 0; };
    while (!rises(pressed)) pressed += 1e-3;
    scene.until = scene.impact().real() + random(0.2, 1) * pressed;
    const auto expected = scene.measures();
    const std::array<std::string, 4> measures{"y", "way", "rise", "push"};
    for (const std::string mode : {"forward", "adjoint"}) {
      const TextRun run = run_text(text_of_ceiling(scene, mode));
      if (run.outcome.exit_code != 0) return run.outcome.error_text;
      for (std::size_t p = 0; p < scene.value.size(); ++p) {
        UnderCeiling beside = scene;
        beside.value[p] += Complex(0, 1e-30);
        const auto moved = beside.measures();
        const auto check = [&](const std::string& name, double is, double slope) {
          const double unit = std::max({1.0, std::abs(slope), std::abs(is / scene.value[p].real())});
          const double found = gradient(run, name, p);
          if (std::abs(found - slope) <= 10 * 1e-10 * unit) return std::string();
          return mode + ": d " + name + "/d " + UnderCeiling::names[p] + " = " + text_of(found) + ", expected " +
                 text_of(slope);
        };
        for (std::size_t m = 0; m < measures.size(); ++m) {
          const std::string wrong = check(measures[m], expected[m].real(), moved[m].imag() / 1e-30);
          if (!wrong.empty()) return wrong;
        }
        const std::string wrong = check("t", scene.impact().real(), beside.impact().imag() / 1e-30);
        if (!wrong.empty()) return wrong;
      }
    }
    return {};
  });
}

}  // namespace
}  // namespace catena::testing
