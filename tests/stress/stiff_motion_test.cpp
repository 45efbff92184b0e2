// Random stiff mechanisms: radau, alpha and `auto` beside a dense formulation that shares nothing with the library.
//
// A wrong answer, by more than ten tolerances times what the motion multiplies an error of its start by, is a failure;
// printed is how often each status came.
#include <gtest/gtest.h>

#include "oracles/random_seeds.hpp"
#include "scene/run_text.hpp"
#include "stress/cases.hpp"
#include "stress/stiff_scene.hpp"

namespace catena::testing {
namespace {

using Instants = std::vector<double>;

/// Places at the instants; empty where the oracle gives up.
std::vector<Vector> stiff_motion(const RandomScene& random, const Vector& v0, const Instants& instants) {
  std::vector<Vector> places;
  const auto keep = [&](std::size_t, const Vector& q, const Vector&, const Vector&) { places.push_back(q); };
  return follow_stiff_motion(random, v0, instants, 1e-13L, keep) ? places : std::vector<Vector>{};
}

/// The largest difference of places, in sizes and rad.
double apart(const RandomScene& random, const Vector& a, const Vector& b) {
  double most = 0;
  for (Eigen::Index k = 0; k < a.size(); ++k)
    most = std::max(most, double(std::abs(a[k] - b[k]) / (k % 3 == 2 ? 1 : Real(random.size))));
  return most;
}

Vector row_of(const RandomScene& random, const TextRun& run, std::size_t row) {
  Vector q(random.dense.size());
  for (Eigen::Index k = 0; k < q.size(); ++k) {
    static const char* const columns[] = {".x", ".y", ".angle"};
    q[k] = run.column("b" + std::to_string(k / 3) + columns[k % 3]).at(row);
  }
  return q;
}

double growth_of(const RandomScene& random, const Instants& instants, const Vector& end) {
  constexpr Real small = 1e-6L;
  const Matrix basis = random.motions();
  double most = 1;
  for (Eigen::Index k = 0; k < basis.cols(); ++k) {
    const auto moved =
        stiff_motion(random, random.v + small * Real(random.pace * random.size) * basis.col(k), instants);
    if (!moved.empty()) most = std::max(most, apart(random, moved.back(), end) / double(small));
  }
  return most;
}

std::string fault_of_stiff_motion(unsigned seed, std::map<std::string, int>& seen) {
  RandomScene random(seed, RandomScene::Forces::moving);
  make_stiff(random);
  static const char* const methods[] = {"radau", "radau", "auto", "alpha"};
  const std::string method = methods[random.pick(4)];
  const int exponent = method == "alpha" ? random.pick(3) : random.pick(8);
  const double tolerance = std::pow(10.0, -3 - exponent), until = random.uniform(0.3, 1) / random.pace;
  random.scene["analyses"] = {{{"type", "dynamics"},
                               {"until", until},
                               {"every", until / 2},
                               {"method", method},
                               {"digits", false},
                               {"tolerance", tolerance},
                               {"max_steps", 200000}}};
  keep_scene("stiff", seed, random.scene.dump(1));
  const TextRun run = run_text(random.scene.dump());
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text;
  const AnalysisReport& report = run.analysis().report;
  ++seen[method + " " + std::string(to_string(report.status))];
  if (!report.ok()) {
    show_refusal(seed, report.message);
    return report.message.empty() ? "no message" : "";
  }
  const Instants instants{until / 2, until};
  const std::vector<Vector> known = stiff_motion(random, random.v, instants);
  if (known.empty()) return ++seen["(not compared)"], "";
  const double error =
      std::max(apart(random, known[0], row_of(random, run, 1)), apart(random, known[1], row_of(random, run, 2)));
  if (error <= 10 * tolerance) return ++seen["(within 10)"], "";
  if (error <= 10 * tolerance * growth_of(random, instants, known[1])) return ++seen["(within 10 x growth)"], "";
  return method + " at " + std::to_string(-3 - exponent) + " is wrong by " + std::to_string(error / tolerance) +
         " tolerances";
}

TEST(StiffMotion, IsThatOfADenseFormulation) {
  std::map<std::string, int> seen;
  expect_no_fault(first_case(), last_case(100), [&](unsigned seed) { return fault_of_stiff_motion(seed, seen); });
  print_shares("stiff motions", seen);
  // The oracle gives up where it would need more steps than are worth it.
  if (stress_cases(100) >= 20) {
    EXPECT_GE(seen["(within 10)"] + seen["(within 10 x growth)"], stress_cases(100) / 5);
  }
}

}  // namespace
}  // namespace catena::testing
