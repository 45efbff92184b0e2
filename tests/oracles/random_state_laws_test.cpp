// Random laws of state against integrations and dense algebra in the test: in motion and at rest.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "analysis/sanitized.hpp"
#include "oracles/random_seeds.hpp"
#include "oracles/scene_text.hpp"
#include "oracles/state_law_references.hpp"
#include "references/dense.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

// Random laws over particles in the plane: every component reads places and velocities of all, the time and a table.
std::string random_motion(unsigned seed) {
  RandomNumbers random(seed);
  const int count = 1 + static_cast<int>(random(0, 3)), n = 2 * count;
  std::vector<double> x{-9, -5, -2, 0, 1.5, 4, 9}, y;
  for (std::size_t k = 0; k < x.size(); ++k) y.push_back(random(-2, 2));
  const bool clamped = seed % 2 == 0;
  const ReferenceSpline table(x, y, clamped ? "clamped" : "natural");
  std::vector<double> mass, start, a(static_cast<std::size_t>(n * n)), b(a.size()), c(a.size()), d(a.size()), w;
  for (double& v : a) v = random(-6, 2);
  for (double& v : b) v = random(-0.8, 0.3);
  for (double& v : c) v = random(-0.2, 0.2);
  for (double& v : d) v = random(-1, 1);
  for (int k = 0; k < n; ++k) w.push_back(random(0.5, 4));
  for (int k = 0; k < count; ++k) mass.push_back(random(0.5, 3));
  for (int k = 0; k < 2 * n; ++k) start.push_back(random(-1, 1));
  const auto name = [](int k, const char* rate) {
    return "p" + std::to_string(k / 2) + "." + rate + (k % 2 == 0 ? "x" : "y");
  };
  std::string bodies, forces, outputs, list_x, list_y;
  for (std::size_t k = 0; k < x.size(); ++k) {
    list_x += (k > 0 ? "," : "") + text_of(x[k]);
    list_y += (k > 0 ? "," : "") + text_of(y[k]);
  }
  for (int body = 0; body < count; ++body) {
    const auto at = [&](int k) { return start[static_cast<std::size_t>(k)]; };
    bodies += (body > 0 ? "," : "") + ("\"p" + std::to_string(body)) + R"--(": {"particle": true, "mass": )--" +
              text_of(mass[static_cast<std::size_t>(body)]) + R"--(, "position": )--" +
              pair_of(at(2 * body), at(2 * body + 1)) + R"--(, "velocity": )--" +
              pair_of(at(n + 2 * body), at(n + 2 * body + 1)) + "}";
    std::string component[2];
    for (int k = 0; k < 2; ++k) {
      const int i = 2 * body + k;
      component[k] = "=sin(" + text_of(w[static_cast<std::size_t>(i)]) + "*t)";
      for (int j = 0; j < n; ++j) {
        const auto e = static_cast<std::size_t>(i * n + j);
        component[k] += " + " + text_of(a[e]) + "*" + name(j, "") + " + " + text_of(b[e]) + "*" + name(j, "v") + " + " +
                        text_of(c[e]) + "*" + name(j, "v") + "*" + name(i, "") + " + " + text_of(d[e]) + "*tab(" +
                        name(j, "") + ")";
      }
    }
    forces += (body > 0 ? "," : "") + (R"--({"type": "point_force", "i": "p)--" + std::to_string(body)) +
              R"--(", "force": [")--" + component[0] + R"--(", ")--" + component[1] + R"--("]})--";
    outputs += (body > 0 ? "," : "") + ("\"p" + std::to_string(body) + "\"");
  }
  const TextRun run =
      run_text(law_scene(R"--("tables": {"tab": {"x": [)--" + list_x + R"--(], "y": [)--" + list_y +
                             R"--(], "beyond": "line", "end": ")--" + (clamped ? "clamped" : "natural") +
                             R"--("}}, "bodies": {)--" + bodies + R"--(}, "forces": [)--" + forces + "]",
                         outputs + R"--(, "energy.balance")--",
                         R"--({"type": "dynamics", "until": 0.8, "every": 0.8, "tolerance": 1e-11})--"));
  if (run.outcome.exit_code != 0) return run.outcome.error_text + run.analysis().report.message;
  const auto slope = [&](double t, const ReferenceState& s) {
    ReferenceState rate(s.size());
    for (int i = 0; i < n; ++i) {
      const auto at = [&](int k) { return s[static_cast<std::size_t>(k)]; };
      double force = std::sin(w[static_cast<std::size_t>(i)] * t);
      for (int j = 0; j < n; ++j) {
        const auto e = static_cast<std::size_t>(i * n + j);
        force += a[e] * at(j) + b[e] * at(n + j) + c[e] * at(n + j) * at(i) + d[e] * table(at(j));
      }
      rate[static_cast<std::size_t>(i)] = at(n + i);
      rate[static_cast<std::size_t>(n + i)] = force / mass[static_cast<std::size_t>(i / 2)];
    }
    return rate;
  };
  const ReferenceState end = integrate(slope, start, 0.8, 4000);
  double worst = std::abs(run.last("energy.balance")) / 100;
  for (int i = 0; i < n; ++i) {
    worst = std::max({worst, std::abs(run.last(name(i, "")) - end[static_cast<std::size_t>(i)]),
                      std::abs(run.last(name(i, "v")) - end[static_cast<std::size_t>(n + i)])});
  }
  // The reference's own error where the table's third derivative jumps is h^4 of a jump of some hundred.
  return worst < 1e-8 ? "" : "off by " + text_of(worst);
}

TEST(StateLaws, RandomOnesMoveAsIntegratedInTheTest) { expect_no_fault(1, size_of_test(40u, 12u), random_motion); }

// Random linear laws at rest: F_i = b_i - sum_j K_ij x_j, not symmetric, so that no energy could be minimised.
// `unsolved` counts searches that end without an answer, and say so.
std::string random_balance(unsigned seed, int& unsolved) {
  RandomNumbers random(seed);
  const int count = 1 + static_cast<int>(random(0, 3)), n = 2 * count;
  Eigen::MatrixXd k(n, n), by_p(n, n);
  Eigen::VectorXd b(n);
  const double p = random(0.5, 2);
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < n; ++j) {
      k(i, j) = random(-1, 1) + (i == j ? 1.5 * n : 0);
      by_p(i, j) = random(-0.3, 0.3);
    }
    b(i) = random(-2, 2);
  }
  const Eigen::VectorXd rest = solve<double>(k + p * by_p, b);
  const Eigen::VectorXd rest_p = solve<double>(k + p * by_p, -by_p * rest);
  const auto name = [](int i) { return "p" + std::to_string(i / 2) + (i % 2 == 0 ? ".x" : ".y"); };
  std::string bodies, forces, outputs;
  for (int body = 0; body < count; ++body) {
    std::string component[2];
    for (int c = 0; c < 2; ++c) {
      const int i = 2 * body + c;
      component[c] = "=" + text_of(b(i));
      for (int j = 0; j < n; ++j)
        component[c] += " - (" + text_of(k(i, j)) + " + p*" + text_of(by_p(i, j)) + ")*" + name(j);
    }
    const std::string comma = body > 0 ? "," : "", who = "p" + std::to_string(body);
    const double y = random(-1, 1), x = random(-1, 1);
    bodies += comma + "\"" + who + R"--(": {"particle": true, "mass": 1, "position": )--" + pair_of(x, y) + "}";
    forces += comma + R"--({"type": "point_force", "i": ")--" + who + R"--(", "force": [")--" + component[0] +
              R"--(", ")--" + component[1] + R"--("]})--";
    outputs += comma + "\"" + who + R"--(.x", ")--" + who + R"--(.y")--";
  }
  const std::string parts = R"--("parameters": {"p": )--" + text_of(p) + R"--(}, "bodies": {)--" + bodies +
                            R"--(}, "forces": [)--" + forces + "]";
  const TextRun run = run_text(law_scene(parts, outputs, R"--({"type": "equilibrium"},
    {"type": "sensitivity", "from": "initial", "parameters": ["p"], "of": {"type": "equilibrium", "measures": {"x": {"final": "p0.x"}}}})--"));
  if (run.outcome.exit_code > 1) return run.outcome.error_text;
  if (run.outcome.analyses.front().report.status == Status::not_converged) {
    ++unsolved;
    return {};
  }
  if (run.outcome.exit_code != 0) return run.outcome.analyses.back().report.message;
  double worst = 0;
  for (int i = 0; i < n; ++i) {
    worst = std::max(
        {worst, std::abs(run.last(name(i)) - rest(i)), std::abs(run.last("d(" + name(i) + ")/d(p)", 1) - rest_p(i))});
  }
  return worst < 1e-9 ? "" : "off by " + text_of(worst);
}

TEST(StateLaws, RandomOnesBalanceAsSolvedInTheTest) {
  int unsolved = 0;
  expect_no_fault(1, 40, [&](unsigned seed) { return random_balance(seed, unsolved); });
  EXPECT_LE(unsolved, 2);
}

}  // namespace
}  // namespace catena::testing
