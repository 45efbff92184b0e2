// Gradients of driven linkages against closed forms differenced in long double.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <random>

#include "design/four_bar_oracle.hpp"
#include "scene/run_text.hpp"

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

TEST_P(RandomFourBars, HaveGradientsOfMeasuresWhateverTheMode) {
  std::mt19937_64 random(static_cast<std::uint64_t>(GetParam()));
  const FourBar f = random_four_bar(random);
  const TextRun forward = run_text(scene_of(f, "forward")), adjoint = run_text(scene_of(f, "adjoint"));
  ASSERT_EQ(adjoint.outcome.exit_code, 0) << adjoint.outcome.error_text << adjoint.analysis().report.message;
  EXPECT_TRUE(adjoint.column("d(rocker.angle)/d(a)").empty());
  // The integral by Simpson's rule of the closed form: with 400 parts its own error is 1e-8.
  const auto area = [](const FourBar& g) {
    constexpr int n = 1000;
    long double sum = 0;
    for (int k = 0; k <= n; ++k) {
      const long double time = static_cast<long double>(k) / n;
      const long double omega = differentiate([&](long double h) { return pose_of(g, time + h).rocker; }, step);
      sum += (k == 0 || k == n ? 1 : k % 2 ? 4 : 2) * pose_of(g, time).pen_x * omega;
    }
    return sum / (3 * n);
  };
  for (std::size_t m = 0; m < forward.analysis().measures.size(); ++m) {
    const MeasureResult &one = forward.analysis().measures[m], &other = adjoint.analysis().measures[m];
    for (std::size_t p = 0; p < std::size(members); ++p) {
      EXPECT_NEAR(one.gradient[p], other.gradient[p], 1e-10 * std::max(1.0, std::abs(one.gradient[p]))) << one.name;
      if (one.name != "area") continue;
      const long double expected = differentiate(
          [&](long double h) {
            FourBar moved = f;
            moved.*(members[p].second) += h;
            return area(moved);
          },
          step);
      EXPECT_NEAR(one.gradient[p], static_cast<double>(expected), 1e-8 * std::max(1.0L, std::abs(expected)))
          << members[p].first;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RandomFourBars, ::testing::Range(1, 6));

}  // namespace
}  // namespace catena::testing
