// Modes and paths with one-sided elements. Oracles: closed forms of one mass, cables and a disc; chains of masses on
// springs with stops, whose stops are found by trying all sets with dense algebra. Structures:
// one_sided_structures_test.cpp.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <vector>

#include "analysis/sanitized.hpp"
#include "oracles/analysis_fields.hpp"
#include "oracles/scene_text.hpp"
#include "references/dense.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

/// Masses one below the other on springs from the ground, each with a stop below it: u is how far it is down.
struct Chain {
  std::vector<double> mass, k, reach;  // stops at u = reach
  std::vector<double> load;            // N for each unit of the parameter P

  static Chain random(RandomNumbers& draw, int count) {
    Chain chain;
    for (int n = 0; n < count; ++n) {
      chain.mass.push_back(draw(0.5, 2));
      chain.k.push_back(draw(50, 200));
      chain.reach.push_back(draw(0.02, 0.3));
      chain.load.push_back(draw(-1, 3));
    }
    return chain;
  }
  int count() const { return static_cast<int>(mass.size()); }

  std::string scene(double g, const std::string& analyses) const {
    std::string bodies, constraints, forces, outputs;
    for (int n = 0; n < count(); ++n) {
      const auto i = static_cast<std::size_t>(n);
      const std::string comma = n > 0 ? ", " : "", above = n > 0 ? fmt::format("\"b{}\"", n - 1) : "\"ground\"";
      bodies += comma + fmt::format(R"("b{}": {{"particle": true, "mass": {:.17g}, "position": [0, {}]}})", n, mass[i],
                                    -(n + 1));
      constraints += comma + fmt::format(R"({{"type": "absolute_x", "i": "b{}", "value": 0}})", n);
      forces += comma + fmt::format(
                            R"({{"type": "spring_damper", "i": {}, "j": "b{}", "k": {:.17g}, "length": 1}},
        {{"type": "point_force", "i": "b{}", "force": [0, "=-P*{:.17g}"]}},
        {{"type": "stop", "name": "s{}", "column": "b{}.y", "min": {:.17g}}})",
                            above, n, k[i], n, load[i], n, n, -(n + 1) - reach[i]);
      outputs += comma + fmt::format(R"("b{0}.y", "s{0}.force")", n);
    }
    return fmt::format(R"({{"catena": 1, "parameters": {{"P": 0}}, "gravity": [0, {:.17g}], "bodies": {{{}}},
      "constraints": [{}], "forces": [{}], "outputs": [{}], "analyses": [{}]}})",
                       -g, bodies, constraints, forces, outputs, analyses);
  }

  MatrixXd stiffness() const {
    MatrixXd K = MatrixXd::Zero(count(), count());
    for (int n = 0; n < count(); ++n) {
      const double s = k[static_cast<std::size_t>(n)];
      K(n, n) += s;
      if (n == 0) continue;
      K(n - 1, n - 1) += s;
      K(n, n - 1) -= s;
      K(n - 1, n) -= s;
    }
    return K;
  }
  struct Rest {
    unsigned set = 0;  // bit n: stop n is closed
    VectorXd u, p;
  };
  /// By trying all sets: exactly one fits, K being positive definite.
  Rest rest(double g, double P) const {
    const MatrixXd K = stiffness();
    VectorXd f(count());
    for (int n = 0; n < count(); ++n)
      f[n] = g * mass[static_cast<std::size_t>(n)] + P * load[static_cast<std::size_t>(n)];
    for (unsigned set = 0; set < 1u << count(); ++set) {
      // Rows of closed stops say u = reach; the force is what is left of K u = f - p.
      MatrixXd A = K;
      VectorXd b = f;
      for (int n = 0; n < count(); ++n) {
        if (!(set >> n & 1u)) continue;
        A.row(n).setZero();
        A(n, n) = 1;
        b[n] = reach[static_cast<std::size_t>(n)];
      }
      Rest found{set, solve<double>(A, b), {}};
      found.p = f - K * found.u;
      bool fits = true;
      for (int n = 0; n < count(); ++n) {
        fits = fits && (set >> n & 1u ? found.p[n] >= -1e-9 : found.u[n] <= reach[static_cast<std::size_t>(n)] + 1e-11);
      }
      if (fits) return found;
    }
    ADD_FAILURE() << "no set fits";
    return {};
  }
  /// Squares of the frequencies where the masses of closed stops stand still.
  std::vector<double> squares(unsigned set) const {
    std::vector<int> free;
    for (int n = 0; n < count(); ++n) {
      if (!(set >> n & 1u)) free.push_back(n);
    }
    const auto f = static_cast<Eigen::Index>(free.size());
    MatrixXd A(f, f);
    const MatrixXd K = stiffness();
    for (Eigen::Index a = 0; a < f; ++a) {
      for (Eigen::Index b = 0; b < f; ++b) {
        const int i = free[static_cast<std::size_t>(a)], j = free[static_cast<std::size_t>(b)];
        A(a, b) = K(i, j) / std::sqrt(mass[static_cast<std::size_t>(i)] * mass[static_cast<std::size_t>(j)]);
      }
    }
    const VectorXd values = f > 0 ? symmetric_eigenvalues<double>(A) : VectorXd();
    return {values.data(), values.data() + values.size()};
  }
};

TEST(OneSidedStability, ModesOfAMassThatAStopHolds) {
  const Chain chain{{2}, {100}, {0.05}, {1}};
  // 2 kg under 9.81 m/s^2 on 100 N/m would sink by 0.2 m; under 1 m/s^2 by 0.02 m.
  const TextRun held = run_text(chain.scene(9.81, R"({"type": "equilibrium"}, {"type": "modes"})"));
  ASSERT_FINE(held);
  EXPECT_TRUE(held.column("omega2", 1).empty());
  EXPECT_EQ(field_of<std::vector<std::string>>(held.analysis(1), "active"), std::vector<std::string>{"s0"});
  const TextRun open = run_text(chain.scene(1, R"({"type": "equilibrium"}, {"type": "modes"})"));
  ASSERT_FINE(open);
  ASSERT_EQ(open.column("omega2", 1).size(), 1u);
  EXPECT_NEAR(open.column("omega2", 1)[0], 50, 1e-9);
  EXPECT_TRUE(field_of<std::vector<std::string>>(open.analysis(1), "active").empty());
  // It touches at rest without a force: named, and taken as open.
  const Chain touching{{2}, {100}, {0.02}, {1}};
  const TextRun weak = run_text(touching.scene(1, R"({"type": "equilibrium"}, {"type": "modes"})"));
  ASSERT_FINE(weak);
  ASSERT_EQ(weak.column("omega2", 1).size(), 1u);
  EXPECT_NEAR(weak.column("omega2", 1)[0], 50, 1e-9);
  EXPECT_TRUE(warns(weak.analysis(1), "touching without a force")) << weak.analysis(1).report.message;
  EXPECT_TRUE(warns(weak.analysis(1), "\"s0\""));
}

TEST(OneSidedStability, ModesOfChainsWithStopsAgainstDenseAlgebra) {
  int held = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers draw(seed);
    const Chain chain = Chain::random(draw, 2 + static_cast<int>(seed % 4));
    const TextRun run = run_text(chain.scene(9.81, R"({"type": "equilibrium"}, {"type": "modes"})"));
    ASSERT_FINE(run);
    const Chain::Rest rest = chain.rest(9.81, 0);
    const std::vector<double> squares = chain.squares(rest.set), found = run.column("omega2", 1);
    ASSERT_EQ(found.size(), squares.size());
    for (std::size_t k = 0; k < found.size(); ++k) EXPECT_NEAR(found[k], squares[k], 1e-9 * squares.back());
    std::vector<std::string> names;
    for (int n = 0; n < chain.count(); ++n) {
      if (rest.set >> n & 1u) names.push_back("s" + std::to_string(n));
      EXPECT_NEAR(run.last(fmt::format("b{}.y", n)), -(n + 1) - rest.u[n], 1e-9);
    }
    held += static_cast<int>(names.size());
    EXPECT_EQ(field_of<std::vector<std::string>>(run.analysis(1), "active"), names);
  }
  EXPECT_GE(held, 20);
}

// A bob on two cables, the second too long to carry: it swings as on the first alone.
TEST(OneSidedStability, ModesOfABobOnTwoCablesOfWhichOneIsSlack) {
  const TextRun run = run_text(R"({"catena": 1, "gravity": [0, -9.81], "bodies": {"b": {"particle": true, "mass": 3,
    "position": [0.1, -0.9]}}, "forces": [
      {"type": "cable", "name": "taut", "i": "ground", "j": "b", "length": 0.8},
      {"type": "cable", "name": "slack", "i": ["ground", [1, 0]], "j": "b", "length": 2}],
    "outputs": ["b.x", "b.y"], "analyses": [{"type": "equilibrium"}, {"type": "modes"}]})");
  ASSERT_FINE(run);
  ASSERT_EQ(run.column("omega2", 1).size(), 1u);
  EXPECT_NEAR(run.column("omega2", 1)[0], 9.81 / 0.8, 1e-8);
  EXPECT_EQ(field_of<std::vector<std::string>>(run.analysis(1), "active"), std::vector<std::string>{"taut"});
}

// Pressed into compliant stops a chain swings with their stiffness where they carry, dN/dd = e k^(1/e) N^(1 - 1/e).
TEST(OneSidedStability, ModesOfChainsOnCompliantStopsAgainstDenseAlgebra) {
  int held = 0;
  for (unsigned seed = 1; seed <= 30; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers draw(seed);
    Chain chain = Chain::random(draw, 2 + static_cast<int>(seed % 4));
    const double k = draw(1e3, 1e5), exponent = seed % 3 == 0 ? 1.5 : seed % 3 == 1 ? 1 : 2.2;
    std::string text = chain.scene(9.81, R"({"type": "equilibrium"}, {"type": "modes"})");
    const std::string stop = R"("type": "stop",)",
                      law = stop + fmt::format(R"( "k": {:.17g}, "exponent": {:.17g},)", k, exponent);
    for (std::size_t at = 0; (at = text.find(stop, at)) != std::string::npos; at += law.size())
      text.replace(at, stop.size(), law);
    const TextRun run = run_text(text);
    ASSERT_FINE(run);
    const Chain::Rest rest = chain.rest(9.81, 0);
    MatrixXd A = chain.stiffness();
    for (int n = 0; n < chain.count(); ++n) {
      if (!(rest.set >> n & 1u)) continue;
      ++held;
      A(n, n) += exponent * std::pow(k, 1 / exponent) * std::pow(rest.p[n], 1 - 1 / exponent);
    }
    for (int i = 0; i < chain.count(); ++i) {
      for (int j = 0; j < chain.count(); ++j)
        A(i, j) /= std::sqrt(chain.mass[static_cast<std::size_t>(i)] * chain.mass[static_cast<std::size_t>(j)]);
    }
    const VectorXd squares = symmetric_eigenvalues<double>(A);
    const std::vector<double> found = run.column("omega2", 1);
    ASSERT_EQ(static_cast<Eigen::Index>(found.size()), squares.size());
    for (std::size_t n = 0; n < found.size(); ++n)
      EXPECT_NEAR(found[n], squares[static_cast<Eigen::Index>(n)], 1e-9 * squares.maxCoeff());
  }
  EXPECT_GE(held, 20);
}

// A disc that lies in a round bowl swings, without turning, about the bowl's centre: N Psi_qq = -N / (R - r) across.
// With a stiffness the contact adds a second mode, along its normal.
TEST(OneSidedStability, ModesOfADiscInABowl) {
  for (unsigned seed = 1; seed <= 6; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers draw(seed);
    const double R = draw(0.5, 2), r = draw(0.05, 0.2), x = draw(-0.2, 0.2) * R;
    const std::string stiffness = seed % 2 == 0 ? R"(, "k": 1e5)" : "";
    const TextRun run = run_text(fmt::format(R"({{"catena": 1, "gravity": [0, -9.81], "bodies": {{"b": {{
      "particle": true, "mass": 2, "position": [{:.17g}, {:.17g}]}}}}, "forces": [{{"type": "contact", "name": "bowl",
      "i": "ground", "j": "b", "radius": {:.17g}, "side": -1,
      "curve": {{"circle": {{"centre": [0, 0], "radius": {:.17g}}}}}{}}}],
      "outputs": ["b.x", "b.y", "bowl.force"], "analyses": [{{"type": "equilibrium"}}, {{"type": "modes"}}]}})",
                                             x, -0.8 * (R - r), r, R, stiffness));
    ASSERT_FINE(run);
    EXPECT_NEAR(run.last("b.y"), r - R, 1e-10);
    const std::vector<double> squares = run.column("omega2", 1);
    ASSERT_EQ(squares.size(), stiffness.empty() ? 1u : 2u);
    EXPECT_NEAR(squares[0], 9.81 / (R - r), 1e-8);
    if (!stiffness.empty()) {
      EXPECT_NEAR(squares[1], 1e5 / 2, 1e-6);
    }
  }
}

TEST(OneSidedStability, ModesOfAPlaceThatViolatesAStopSayWhatToDo) {
  const Chain chain{{2}, {100}, {-0.1}, {1}};  // the given place is 0.1 m below the stop
  const TextRun run = run_text(chain.scene(1, R"({"type": "modes"})"));
  EXPECT_EQ(run.outcome.exit_code, 1);
  EXPECT_NE(run.analysis().report.message.find("stop \"s0\" is violated at this place by 0.1 m"), std::string::npos)
      << run.analysis().report.message;
}

/// Every row of a path against the one set that fits its parameter; every change where the oracle changes its set.
void expect_path(const Chain& chain, const TextRun& run, std::size_t analysis, int& changes) {
  const std::vector<double> P = run.column("P", analysis);
  ASSERT_GE(P.size(), 2u);
  for (std::size_t row = 0; row < P.size(); ++row) {
    const Chain::Rest rest = chain.rest(9.81, P[row]);
    for (int n = 0; n < chain.count(); ++n) {
      EXPECT_NEAR(run.column(fmt::format("b{}.y", n), analysis)[row], -(n + 1) - rest.u[n], 1e-9) << row;
      EXPECT_NEAR(run.column(fmt::format("s{}.force", n), analysis)[row], std::max(rest.p[n], 0.0), 1e-7) << row;
    }
  }
  const auto records = field_of<std::vector<FieldRecord>>(run.analysis(analysis), "changes");
  for (const FieldRecord& record : records) {
    const double at = value_of<double>(record, "value");
    const int n = value_of<std::string>(record, "element")[1] - '0';
    const bool closes = value_of<std::string>(record, "kind") == "closes";
    const double sense = P.back() > P.front() ? 1 : -1;
    EXPECT_EQ(chain.rest(9.81, at - sense * 1e-7).set >> n & 1u, closes ? 0u : 1u) << at;
    EXPECT_EQ(chain.rest(9.81, at + sense * 1e-7).set >> n & 1u, closes ? 1u : 0u) << at;
    EXPECT_NEAR(P[static_cast<std::size_t>(value_of<std::int64_t>(record, "row"))], at, 1e-12);
  }
  EXPECT_EQ((static_cast<int>(records.size()) -
             std::popcount(chain.rest(9.81, P.front()).set ^ chain.rest(9.81, P.back()).set)) %
                2,
            0);
  changes += static_cast<int>(records.size());
}

TEST(OneSidedStability, PathsOfChainsWithStopsAgainstDenseAlgebra) {
  int changes = 0;
  for (unsigned seed = 1; seed <= size_of_test(60u, 16u); ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers draw(seed + 100);
    const Chain chain = Chain::random(draw, 1 + static_cast<int>(seed % 4));
    const TextRun run = run_text(chain.scene(9.81, R"({"type": "path", "parameter": "P", "to": 8, "arc": 0.1},
      {"type": "path", "parameter": "P", "to": -6, "arc": 0.1})"));
    ASSERT_FINE(run);
    expect_path(chain, run, 0, changes);
    expect_path(chain, run, 1, changes);
  }
  EXPECT_GE(changes, size_of_test(50, 10));
}

}  // namespace
}  // namespace catena::testing
