// Random mechanisms with stiff, damped bushings and springs, 1e2 ... 1e10 times as stiff as their weights ask for,
// stiff dampers and light bodies: radau, alpha and `auto` beside a dense formulation that shares nothing with the
// library.
//
// A wrong answer, by more than ten tolerances times what the motion multiplies an error of its start by, is a failure;
// printed is how often each status came.
#include <gtest/gtest.h>

#include "oracles/random_seeds.hpp"
#include "scene/run_text.hpp"
#include "stress/cases.hpp"
#include "stress/dense_motion.hpp"
#include "stress/implicit_extrapolation.hpp"

namespace catena::testing {
namespace {

using Instants = std::vector<double>;

void make_light(RandomScene& random, int body, double part) {
  DenseMechanism::Body& dense = random.dense.bodies[static_cast<std::size_t>(body)];
  Json& entry = random.scene["bodies"]["b" + std::to_string(body)];
  for (const char* key : {"mass", "inertia"}) entry[key] = entry[key].get<double>() * part;
  dense = {entry["mass"].get<double>(), entry["inertia"].get<double>()};
}

// Springs damp their vibration within a few of its periods: else it would have to be followed.
void make_stiff(RandomScene& random) {
  const int bodies = static_cast<int>(random.dense.bodies.size()), count = 1 + random.pick(3);
  const double weight = 9.81 * double(random.dense.bodies[0].mass) / random.size;
  if (random.pick(2) == 0) make_light(random, random.pick(bodies), std::pow(10.0, -random.uniform(1, 6)));
  for (int k = 0; k < count; ++k) {
    const int j = random.pick(bodies), i = random.pick(bodies + 1) - 1;
    double mass = double(random.dense.bodies[static_cast<std::size_t>(j)].mass);
    if (i >= 0) mass = std::min(mass, double(random.dense.bodies[static_cast<std::size_t>(i)].mass));
    const double stiffness = weight * std::pow(10.0, random.uniform(2, 10)), part = random.uniform(0.3, 3);
    const int kind = random.pick(4);
    if (kind == 0) {
      random.add_relaxed(i, j, 0, stiffness / random.pace * std::pow(10.0, -random.uniform(1, 3)), true);
    } else {
      random.add_relaxed(i, j, stiffness, 2 * part * std::sqrt(stiffness * mass), kind != 1);
    }
  }
  random.set_moving();
}

/// Places at the instants; empty where the oracle gives up.
std::vector<Vector> stiff_motion(const RandomScene& random, const Vector& v0, const Instants& instants) {
  const auto kept = random.dense.independent_rows(0, random.q);
  const Eigen::Index n = random.dense.size();
  Vector scale(2 * n);
  for (Eigen::Index k = 0; k < n; ++k) {
    scale[k] = k % 3 == 2 ? 1 : Real(random.size);
    scale[n + k] = scale[k] * Real(random.pace);
  }
  const auto slope = [&](Real t, const Vector& q, const Vector& v) {
    return acceleration(random.dense, kept, t, q, v);
  };
  ImplicitExtrapolation motion(slope, random.q, v0, scale, 1e-6L / random.pace, 1e-13L);
  std::vector<Vector> places;
  for (const double t : instants) {
    if (!motion.go_to(t, 200)) return {};
    places.push_back(motion.q());
  }
  return places;
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
