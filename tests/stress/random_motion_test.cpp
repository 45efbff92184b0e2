// Random mechanisms of all joints and forces: what dynamics and kinematics answer against a dense formulation that
// shares nothing with the library (dense_mechanism.hpp).
//
// An answer `ok` that is wrong is a failure: an error of more than a hundred times the tolerance, multiplied by as much
// as the motion multiplies an error of its start. Printed is how many are within ten times, and how often each other
// status came.
#include <gtest/gtest.h>

#include "oracles/random_seeds.hpp"
#include "references/dense.hpp"
#include "scene/run_text.hpp"
#include "stress/cases.hpp"
#include "stress/dense_motion.hpp"

namespace catena::testing {
namespace {

/// Largest difference of places, in sizes and radians.
double difference(const RandomScene& random, const Vector& dense, const TextRun& run, std::size_t row) {
  double most = 0;
  for (std::size_t b = 0; b < random.dense.bodies.size(); ++b) {
    const std::string name = "b" + std::to_string(b);
    const Eigen::Index k = 3 * static_cast<Eigen::Index>(b);
    const auto compare = [&](const char* column, Real value, double scale) {
      const std::vector<double> values = run.column(name + column);
      most = row < values.size() ? std::max(most, std::abs(double(values[row] - value)) / scale) : 1e300;
    };
    compare(".x", dense[k], random.size);
    compare(".y", dense[k + 1], random.size);
    compare(".angle", dense[k + 2], 1);
  }
  return most;
}

std::string describe(const RandomScene& random) {
  std::string text;
  for (const std::string& type : random.types) text += type + " ";
  return text;
}

/// What is wrong with an answer that is not `ok`: no words, or words from inside.
std::string dishonest(const AnalysisReport& report) {
  if (report.message.empty()) return "no message";
  for (const char* internal : {"std::", "vector", "map::at", "basic_string"}) {
    if (report.message.find(internal) != std::string::npos) return report.message;
  }
  return "";
}

/// Of methods, with tolerances of 10^-first ... 10^-(first + 2 step).
struct MethodsInTrial {
  std::vector<std::string> methods;
  int first, step;
};

std::string dynamics_fault(unsigned seed, const MethodsInTrial& trial, std::map<std::string, int>& seen) {
  RandomScene random(seed, RandomScene::Forces::moving);
  random.set_moving();
  const std::string method =
      trial.methods[static_cast<std::size_t>(random.pick(static_cast<int>(trial.methods.size())))];
  const double tolerance = std::pow(10.0, -trial.step * random.pick(3) - trial.first);
  const double until = random.uniform(0.3, 2) / random.pace;
  random.scene["analyses"] = {{{"type", "dynamics"},
                               {"until", until},
                               {"every", until / 2},
                               {"method", method},
                               {"tolerance", tolerance},
                               {"max_steps", 100000}}};
  keep_scene("dynamics", seed, random.scene.dump(1));
  const TextRun run = run_text(random.scene.dump());
  const std::string which = method + " " + std::to_string(tolerance) + " " + describe(random);
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text + which;
  const AnalysisReport& report = run.analysis().report;
  ++seen[std::string(to_string(report.status))];
  if (!report.ok()) {
    show_refusal(seed, report.message + " " + which);
    return dishonest(report);
  }
  const std::vector<double> instants{until / 2, until};
  const std::vector<Vector> known = dense_motion(random, random.v, instants);
  if (known.empty()) return ++seen["(not compared)"], "";
  const double error = std::max(difference(random, known[0], run, 1), difference(random, known[1], run, 2));
  if (error <= 10 * tolerance) return ++seen["(within 10)"], "";
  const double allowed = tolerance * growth(random, instants, known[1]);
  if (error <= 10 * allowed) return ++seen["(within 10 x growth)"], "";
  if (error <= 100 * allowed) return ++seen["(within 100 x growth)"], "";
  return "error " + std::to_string(std::log10(error)) + " allowed " + std::to_string(std::log10(allowed)) +
         " (log10) " + which;
}

/// Velocities that rows and drivers determine; empty where they do not.
Vector driven_velocity(const DenseMechanism& dense, Real t, const Vector& q) {
  const Vector zero = Vector::Zero(dense.size());
  const std::vector<Jet> phi = dense.residuals(t, q, zero, zero);
  Vector right(static_cast<Eigen::Index>(phi.size()));
  for (std::size_t k = 0; k < phi.size(); ++k) right[static_cast<Eigen::Index>(k)] = -phi[k].d;
  return solve<Real>(dense.jacobian(t, q), right);
}

// Drivers are added until nothing is free; only mechanisms without redundant rows are taken, whose equations are
// square.
std::string kinematics_fault(unsigned seed, std::map<std::string, int>& seen) {
  RandomScene random(seed, RandomScene::Forces::moving);
  DenseMechanism& dense = random.dense;
  for (int tries = 0; static_cast<Eigen::Index>(dense.rows.size()) < dense.size() && tries < 40; ++tries) {
    random.add_driver();
    if (dense.independent_rows(0, random.q).size() == dense.rows.size()) continue;
    dense.rows.pop_back();
    random.scene["drivers"].erase(random.scene["drivers"].size() - 1);
  }
  const auto count = static_cast<Eigen::Index>(dense.rows.size());
  if (count != dense.size() || dense.independent_rows(0, random.q).size() != dense.rows.size())
    return ++seen["(not square)"], "";
  const double until = random.uniform(0.1, 1) / random.pace;
  random.scene["analyses"] = {{{"type", "inverse_dynamics"}, {"until", until}, {"every", until / 2}}};
  random.scene["outputs"] = Json::array();
  for (std::size_t b = 0; b < dense.bodies.size(); ++b) {
    for (const char* column : {".x", ".y", ".angle", ".vx", ".vy", ".omega", ".ax", ".ay", ".alpha"})
      random.scene["outputs"].push_back("b" + std::to_string(b) + column);
  }
  for (std::size_t d = 0; d < random.scene["drivers"].size(); ++d)
    random.scene["outputs"].push_back("d" + std::to_string(d) + ".power");
  for (std::size_t d = 0; d < random.scene["drivers"].size(); ++d)
    random.scene["drivers"][d]["name"] = "d" + std::to_string(d);
  const TextRun run = run_text(random.scene.dump());
  if (run.outcome.exit_code > 1) return "not valid: " + run.outcome.error_text + describe(random);
  const AnalysisReport& report = run.analysis().report;
  ++seen[std::string(to_string(report.status))];
  // Places from velocities, integrated.
  Vector scale(dense.size());
  for (Eigen::Index k = 0; k < dense.size(); ++k) scale[k] = k % 3 == 2 ? 1 : Real(random.size);
  const auto slope = [&](Real t, const Vector& q) { return driven_velocity(dense, t, q); };
  Extrapolation motion(slope, random.q, scale, 0.02L / random.pace, 1e-14L);
  const bool arrives = motion.go_to(until, 150);
  if (!report.ok()) {
    // Velocities grow without bound towards a dead point: nothing integrates them beyond it.
    if (report.status == Status::lock_up && arrives) return "no dead point is there: " + report.message;
    return dishonest(report);
  }
  if (!arrives) return ++seen["(not compared)"], "";
  const Vector q = motion.y(), v = driven_velocity(dense, until, q), zero = Vector::Zero(dense.size());
  // Accelerations, and the power of the drivers: what moves masses against loads.
  Matrix jacobian = dense.jacobian(until, q);
  const std::vector<Jet> phi = dense.residuals(until, q, v, zero);
  Vector right(count);
  for (Eigen::Index k = 0; k < count; ++k) right[k] = -phi[static_cast<std::size_t>(k)].dd;
  const Vector a = solve<Real>(jacobian, right), forces = dense.forces(until, q, v);
  const Real power = v.dot(dense.masses().cwiseProduct(a) - forces);
  for (Eigen::Index k = 2; k < count; k += 3) jacobian.col(k) /= dense.length;
  for (Eigen::Index k = 0; k < count; ++k) jacobian.row(k).normalize();
  const double condition = double(ReferenceFactors<Real>(jacobian).inverse().cwiseAbs().maxCoeff());
  // Rounding of double in the places, multiplied by the condition once for each derivative.
  const double place = 1e-10 * condition, rate = place * condition, second = rate * condition;
  double speed = random.pace, most_power = std::abs(double(power));
  for (Eigen::Index k = 0; k < count; ++k) speed = std::max(speed, double(std::abs(v[k]) / scale[k]));
  for (Eigen::Index k = 0; k < count; ++k)
    most_power += double(std::abs(v[k]) * (dense.masses()[k] * std::abs(a[k]) + std::abs(forces[k])));
  const std::size_t last = run.column("b0.x").size() - 1;
  static const char* const columns[] = {".x", ".y", ".angle", ".vx", ".vy", ".omega", ".ax", ".ay", ".alpha"};
  for (Eigen::Index k = 0; k < count; ++k) {
    const std::string name = "b" + std::to_string(k / 3);
    const double errors[] = {
        double(run.column(name + columns[k % 3])[last] - q[k]) / double(scale[k]) / place,
        double(run.column(name + columns[3 + k % 3])[last] - v[k]) / double(scale[k]) / rate / speed,
        double(run.column(name + columns[6 + k % 3])[last] - a[k]) / double(scale[k]) / second / speed / speed};
    for (int order = 0; order < 3; ++order) {
      if (!(std::abs(errors[order]) <= 1))
        return "derivative " + std::to_string(order) + " of " + name + columns[k % 3] + " is wrong by " +
               std::to_string(errors[order]) + " of what is allowed; condition " + std::to_string(condition) + " " +
               describe(random);
    }
  }
  double given = 0;
  for (std::size_t d = 0; d < random.scene["drivers"].size(); ++d)
    given += run.column("d" + std::to_string(d) + ".power")[last];
  // What the joints' redundant rows do not change: the sum over all drivers.
  const double allowed = most_power * 1e-10 * condition * condition;
  if (!(std::abs(given - double(power)) <= allowed))
    return "the power of the drivers is wrong by " + std::to_string(given - double(power)) + ", allowed " +
           std::to_string(allowed) + " " + describe(random);
  return ++seen["(compared)"], "";
}

TEST(RandomMotion, DynamicsIsThatOfADenseFormulation) {
  std::map<std::string, int> seen;
  const MethodsInTrial trial{{"auto", "rk8", "rk5", "adams", "baumgarte", "partitioning"}, 6, 2};
  expect_no_fault(first_case(), last_case(2000), [&](unsigned seed) { return dynamics_fault(seed, trial, seen); });
  print_shares("dynamics of random mechanisms", seen);
}

TEST(RandomMotion, ImplicitMethodsMoveAsADenseFormulation) {
  std::map<std::string, int> seen;
  const MethodsInTrial radau{{"radau"}, 3, 3}, alpha{{"alpha"}, 3, 1};
  expect_no_fault(first_case(), last_case(1000), [&](unsigned seed) { return dynamics_fault(seed, radau, seen); });
  expect_no_fault(first_case(), last_case(500), [&](unsigned seed) { return dynamics_fault(seed, alpha, seen); });
  print_shares("radau and alpha of random mechanisms", seen);
}

TEST(RandomMotion, DrivenOnesMoveAsTheirVelocitiesIntegrated) {
  std::map<std::string, int> seen;
  expect_no_fault(first_case(), last_case(2000), [&](unsigned seed) { return kinematics_fault(seed, seen); });
  print_shares("kinematics of random mechanisms", seen);
}

}  // namespace
}  // namespace catena::testing
