// Gradients of driven linkages against closed forms differenced in long double.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "design/four_bar_oracle.hpp"
#include "design/measured.hpp"

namespace catena::testing {
namespace {

constexpr long double step = 4e-3L;

/// The four-bar as a scene whose places all follow from the parameters.
std::string scene_of(const FourBar& f, const std::string& mode) {
  const FourBarPose start = pose_of(f, 0);
  const auto n = [](long double x) { return fmt::format("{:.17g}", static_cast<double>(x)); };
  return R"({"catena": 1, "parameters": {"a": )" + n(f.a) + R"(, "b": )" + n(f.b) + R"(, "c": )" + n(f.c) +
         R"(, "d": )" + n(f.d) + R"(, "u": )" + n(f.u) + R"(, "v": )" + n(f.v) + R"(, "w": )" + n(f.w) + R"(, "s": )" +
         n(f.s) + R"--(},
  "bodies": {
    "crank": {"points": {"end": ["a", 0]}, "angle": "s"},
    "coupler": {"points": {"end": ["b", 0], "pen": ["u", "v"]}, "position": ["=a*cos(s)", "=a*sin(s)"], "angle": )--" +
         n(start.coupler) + R"(},
    "rocker": {"points": {"end": ["c", 0]}, "position": ["d", 0], "angle": )" +
         n(start.rocker) + R"(}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "crank"}, {"type": "revolute", "i": "crank.end", "j": "coupler"},
    {"type": "revolute", "i": "coupler.end", "j": "rocker.end"}, {"type": "revolute", "i": ["ground", ["d", 0]], "j": "rocker"}],
  "drivers": [{"type": "absolute_angle", "i": "crank", "value": {"polynomial": ["s", "w"]}}],
  "outputs": ["coupler.pen.x", "coupler.pen.y", "rocker.angle", "rocker.omega", "rocker.alpha", "coupler.pen.ax"],
  "analyses": [{"type": "sensitivity", "mode": ")" +
         mode + R"(", "parameters": ["a", "b", "c", "d", "u", "v", "w", "s"],
    "of": {"type": "kinematics", "until": 1, "every": 0.25, "measures": {
      "area": {"integral": "=coupler.pen.x*rocker.omega"}, "reach": {"max": "coupler.pen.x"},
      "swing": {"range": "rocker.angle"}}}}]})";
}

using Member = long double FourBar::*;
constexpr std::pair<const char*, Member> members[] = {{"a", &FourBar::a}, {"b", &FourBar::b}, {"c", &FourBar::c},
                                                      {"d", &FourBar::d}, {"u", &FourBar::u}, {"v", &FourBar::v},
                                                      {"w", &FourBar::w}, {"s", &FourBar::s}};

/// A crank that turns fully: the shortest link beside it and Grashof's condition with room to spare.
FourBar random_four_bar(std::mt19937_64& random) {
  std::uniform_real_distribution<double> any(0, 1);
  for (;;) {
    FourBar f{0.2 + 0.3 * any(random),   0.8 + any(random),   0.8 + any(random), 0.8 + any(random), any(random),
              0.5 * (any(random) - 0.5), 1 + 4 * any(random), 6 * any(random)};
    const long double longest = std::max({f.b, f.c, f.d}), rest = f.b + f.c + f.d - longest;
    if (f.a + longest < rest - 0.2L) return f;
  }
}

/// Value of an output of a pose, and its time derivatives by differences.
long double output(const FourBar& f, const std::string& name, long double t) {
  const auto at = [&](long double time) {
    const FourBarPose p = pose_of(f, time);
    return name.starts_with("coupler.pen.y") ? p.pen_y : name.starts_with("coupler") ? p.pen_x : p.rocker;
  };
  if (name == "rocker.omega") return differentiate([&](long double h) { return at(t + h); }, step);
  if (name == "rocker.alpha" || name == "coupler.pen.ax") {
    return differentiate(
        [&](long double h) { return differentiate([&](long double g) { return at(t + h + g); }, 4 * step); }, 4 * step);
  }
  return at(t);
}

class RandomFourBars : public ::testing::TestWithParam<int> {};

TEST_P(RandomFourBars, HaveExactDerivatives) {
  std::mt19937_64 random(static_cast<std::uint64_t>(GetParam()));
  const FourBar f = random_four_bar(random);
  const TextRun run = run_text(scene_of(f, "forward"));
  ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
  const std::vector<double> t = run.column("t");
  for (const auto& [letter, member] : members) {
    for (const char* name : {"coupler.pen.x", "coupler.pen.y", "rocker.angle", "rocker.omega", "rocker.alpha"}) {
      const std::vector<double> found = run.column(fmt::format("d({})/d({})", name, letter));
      ASSERT_EQ(found.size(), t.size());
      const bool second = std::string(name) == "rocker.alpha";
      for (std::size_t k = 0; k < t.size(); ++k) {
        const long double expected = differentiate(
            [&, member = member](long double h) {
              FourBar moved = f;
              moved.*member += h;
              return output(moved, name, t[k]);
            },
            second ? 4 * step : step);
        // Differences of third order lose digits: long double leaves 1e-8 of them.
        EXPECT_NEAR(found[k], static_cast<double>(expected),
                    (second ? 1e-6 : 1e-10) * std::max(1.0L, std::abs(expected)))
            << name << " " << letter << " " << t[k];
      }
    }
  }
}

/// The integral of pen_x omega over [0, 1] by Simpson's rule on the closed form: with 1000 parts its own error is
/// 1e-10.
long double area(const FourBar& f) {
  constexpr int n = 1000;
  long double sum = 0;
  for (int k = 0; k <= n; ++k) {
    const long double time = static_cast<long double>(k) / n;
    const long double omega = differentiate([&](long double h) { return pose_of(f, time + h).rocker; }, step);
    sum += (k == 0 || k == n ? 1 : k % 2 ? 4 : 2) * pose_of(f, time).pen_x * omega;
  }
  return sum / (3 * n);
}

/// The largest value of sign x quantity over [0, 1]: of samples, then by thirds about the best of them.
long double largest(const FourBar& f, long double FourBarPose::*quantity, int sign) {
  constexpr int n = 1000;
  const auto at = [&](long double t) { return sign * (pose_of(f, t).*quantity); };
  int best = 0;
  for (int k = 1; k <= n; ++k) {
    if (at(static_cast<long double>(k) / n) > at(static_cast<long double>(best) / n)) best = k;
  }
  long double from = std::max(best - 1, 0), to = std::min(best + 1, n);
  from /= n;
  to /= n;
  for (int k = 0; k < 90; ++k) {
    const long double left = from + (to - from) / 3, right = to - (to - from) / 3;
    (at(left) < at(right) ? from : to) = at(left) < at(right) ? left : right;
  }
  return std::max(at(from), at(to));
}

TEST_P(RandomFourBars, HaveGradientsOfMeasuresWhateverTheMode) {
  std::mt19937_64 random(static_cast<std::uint64_t>(GetParam()));
  const FourBar f = random_four_bar(random);
  const std::pair<const char*, std::function<long double(const FourBar&)>> measures[] = {
      {"area", area},
      {"reach", [](const FourBar& g) { return largest(g, &FourBarPose::pen_x, 1); }},
      {"swing",
       [](const FourBar& g) { return largest(g, &FourBarPose::rocker, 1) + largest(g, &FourBarPose::rocker, -1); }}};
  std::map<std::pair<std::string, std::size_t>, double> in_first_mode;  // the same numbers in the other
  for (const char* mode : {"forward", "adjoint"}) {
    SCOPED_TRACE(mode);
    const TextRun run = run_text(scene_of(f, mode));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    EXPECT_EQ(run.column("d(rocker.angle)/d(a)").empty(), std::string(mode) == "adjoint");
    for (const auto& [name, exact] : measures) {
      EXPECT_NEAR(value(run, name), static_cast<double>(exact(f)), 1e-8) << name;
      for (std::size_t p = 0; p < std::size(members); ++p) {
        const long double expected = differentiate(
            [&, &exact = exact](long double h) {
              FourBar moved = f;
              moved.*(members[p].second) += h;
              return exact(moved);
            },
            step);
        // Of extremes the search in the closed form loses digits more.
        const double allowed = std::string_view(name) == "area" ? 1e-8 : 1e-7;
        EXPECT_NEAR(gradient(run, name, p), static_cast<double>(expected), allowed * std::max(1.0L, std::abs(expected)))
            << name << " " << members[p].first;
        const auto [known, first] = in_first_mode.try_emplace({name, p}, gradient(run, name, p));
        if (first) continue;
        EXPECT_NEAR(gradient(run, name, p), known->second, 1e-10 * std::max(1.0, std::abs(known->second)));
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomFourBars, ::testing::Range(1, 6));

}  // namespace
}  // namespace catena::testing
