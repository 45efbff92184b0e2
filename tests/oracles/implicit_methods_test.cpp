// radau and rattle beside closed forms: stiff linear chains by their matrix exponential, the order of fixed steps, the
// energy and the symmetry in time that rattle is there for.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <cmath>
#include <random>

#include "analysis/sanitized.hpp"
#include "catena/analysis/dynamics/implicit/radau.hpp"
#include "oracles/scene_text.hpp"
#include "references/dense.hpp"
#include "scene/run_text.hpp"

namespace catena::testing {
namespace {

TEST(RadauTableau, MeetsItsConditionsOfOrder) {
  const RadauTableau& table = radau_tableau();
  for (int k = 0; k < 5; ++k) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += table.a[2][i] * std::pow(table.c[i], k);
    EXPECT_NEAR(sum, 1.0 / (k + 1), 1e-15) << k;
  }
  const double blocks[3][3] = {
      {table.real, 0, 0}, {0, table.pair_real, -table.pair_imaginary}, {0, table.pair_imaginary, table.pair_real}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      double product = 0, basis = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        product += table.inverse[i][k] * table.basis[k][j];
        basis += table.basis[i][k] * blocks[k][j];
      }
      EXPECT_NEAR(product, basis, 1e-12 * std::abs(table.real)) << i << j;
    }
  }
}

/// Masses on a line, each tied to the one before by a spring and a damper: m x'' + C x' + K x = 0.
struct SpringChain {
  explicit SpringChain(unsigned seed) : random(seed) {
    std::uniform_real_distribution<double> uniform(0, 1);
    for (int k = 0; k < 3; ++k) {
      mass[k] = 0.5 + uniform(random);
      const double exponent = k == 1 ? 4 + 6 * uniform(random) : 2 * uniform(random);
      stiffness[k] = std::pow(10, exponent);
      // Stiff ones are damped: else their vibration would have to be followed.
      damping[k] = k == 1 ? 2 * std::sqrt(stiffness[k]) * (0.2 + uniform(random)) : 0.1 * uniform(random);
      place[k] = 0.2 * uniform(random) - 0.1;
    }
    // The stiff spring begins unstretched: what is looked at is the slow motion.
    place[1] = place[0];
    end = 1 + 2 * uniform(random);
  }
  std::string scene(const std::string& analysis) const {
    std::string bodies, constraints, forces;
    for (int k = 0; k < 3; ++k) {
      const std::string name = "m" + std::to_string(k), before = k == 0 ? "ground" : "m" + std::to_string(k - 1);
      bodies += (k ? ", \"" : "\"") + name + R"(": {"mass": )" + text_of(mass[k]) +
                R"(, "particle": true, "position": )" + pair_of(k + 1 + place[k], 0) + "}";
      constraints += (k ? ", " : "") + std::string(R"({"type": "absolute_y", "i": ")") + name + "\", \"value\": 0}";
      forces += (k ? ", " : "") + std::string(R"({"type": "spring_damper", "i": ")") + before + R"(", "j": ")" + name +
                R"(", "k": )" + text_of(stiffness[k]) + R"(, "c": )" + text_of(damping[k]) + R"(, "length": 1})";
    }
    return R"({"catena": 1, "bodies": {)" + bodies + R"(}, "constraints": [)" + constraints + R"(], "forces": [)" +
           forces + R"(], "outputs": ["m0.x", "m1.x", "m2.x"], "analyses": [)" + analysis + "]}";
  }
  Eigen::Vector3d exact(double t) const {
    // Its slow eigenvalues are known to epsilon times the fastest one squared.
    using Matrix = Eigen::Matrix<long double, 6, 6>;
    Matrix rates = Matrix::Zero();
    rates.topRightCorner<3, 3>().setIdentity();
    for (int k = 0; k < 3; ++k) {
      for (const auto& [column, values] : {std::pair(0, stiffness), std::pair(3, damping)}) {
        rates(3 + k, column + k) -= values[k] / mass[k];
        if (k > 0) {
          rates(3 + k, column + k - 1) += values[k] / mass[k];
          rates(2 + k, column + k - 1) -= values[k] / mass[k - 1];
          rates(2 + k, column + k) += values[k] / mass[k - 1];
        }
      }
    }
    const auto [values, vectors] = spectrum<long double>(rates);
    // Weights of the eigenvectors, complex, as the real and the imaginary part of the start.
    DenseMatrix<long double> parts(12, 12);
    parts << vectors.real(), -vectors.imag(), vectors.imag(), vectors.real();
    DenseVector<long double> start = DenseVector<long double>::Zero(12);
    for (int k = 0; k < 3; ++k) start[k] = place[k];
    const DenseVector<long double> weights = solve<long double>(parts, start);
    Eigen::Vector3d now = Eigen::Vector3d::Zero();
    for (int k = 0; k < 6; ++k) {
      const std::complex<long double> part =
          std::complex<long double>(weights[k], weights[6 + k]) *
          std::exp(values[static_cast<std::size_t>(k)] * static_cast<long double>(t));
      now += (part * vectors.col(k).head(3)).real().cast<double>();
    }
    return now;
  }
  std::mt19937 random;
  std::array<double, 3> mass{}, stiffness{}, damping{}, place{};
  double end = 1;
};

TEST(Radau, StiffChainsMoveAsTheirMatrixExponentialSays) {
  for (unsigned seed = 1; seed <= size_of_test(60u, 8u); ++seed) {
    SCOPED_TRACE(seed);
    const SpringChain chain(seed);
    const double tolerance = std::pow(10, -4.0 - seed % 6);
    const TextRun run = run_text(chain.scene(R"({"type": "dynamics", "method": "radau", "digits": false, "until": )" +
                                             text_of(chain.end) + R"(, "every": )" + text_of(chain.end / 7) +
                                             R"(, "tolerance": )" + text_of(tolerance) + "}"));
    ASSERT_TRUE(run.analysis().report.ok()) << run.outcome.error_text << run.analysis().report.message;
    const std::vector<double> t = run.column("t");
    for (std::size_t row = 0; row < t.size(); ++row) {
      const Eigen::Vector3d exact = chain.exact(t[row]);
      for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(run.column("m" + std::to_string(k) + ".x")[row], k + 1 + exact[k], 10 * tolerance) << row;
      }
    }
    // A vibration of 1e6 /s would take explicit steps 10^6.
    EXPECT_LE(run.analysis().report.counters.steps, 1500);
  }
}

TEST(Auto, GoesOverToImplicitStepsWhereStiffnessAsksForThem) {
  int implicit = 0;
  for (unsigned seed = size_of_test(1u, 19u); seed <= 24; ++seed) {
    SCOPED_TRACE(seed);
    SpringChain chain(seed);
    chain.end = 3;
    const TextRun run =
        run_text(chain.scene(R"({"type": "dynamics", "digits": false, "until": 3, "every": 0.5, "tolerance": 1e-7})"));
    ASSERT_TRUE(run.analysis().report.ok()) << run.outcome.error_text << run.analysis().report.message;
    const std::vector<double> t = run.column("t");
    for (std::size_t row = 0; row < t.size(); ++row) {
      const Eigen::Vector3d exact = chain.exact(t[row]);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(run.column("m" + std::to_string(k) + ".x")[row], k + 1 + exact[k], 1e-6);
    }
    // Explicit steps are bound by some five times the shortest time constant.
    const double fastest = chain.damping[1] * (1 / chain.mass[0] + 1 / chain.mass[1]);
    const bool turned = field<std::string>(run, "method") == "rk8, radau";
    EXPECT_TRUE(turned || fastest < 2e5) << fastest;
    EXPECT_FALSE(turned && fastest < 1e3) << fastest;
    EXPECT_LE(run.analysis().report.counters.steps, 8000);
    implicit += turned;
  }
  EXPECT_GE(implicit, size_of_test(5, 1));
}

// A stiff hold that lets go within 1 ms: afterwards explicit steps are the longer ones. Beside the implicit midpoint
// rule while it lets go, and a cosine afterwards.
TEST(Auto, GoesBackToExplicitSteps) {
  double x0 = 0.3 * 1e9 / (1e9 + 9), v0 = 0;
  constexpr int parts = 400'000;
  constexpr double h = 0.001 / parts;
  for (int k = 0; k < parts; ++k) {
    const double holds = 1 - (k + 0.5) / parts, stiffness = 9 + 1e9 * holds;
    const double v =
        (2 * v0 + h * (1e9 * holds * 0.3 - stiffness * x0)) / (2 + h * h * stiffness / 2 + h * 6e4 * holds);
    x0 += h * v;
    v0 = 2 * v - v0;
  }
  const auto steps = [&](const std::string& method) {
    const TextRun run = run_text(
        R"json({"catena": 1, "bodies": {"m": {"mass": 1, "particle": true, "position": [0.3, 0]}},
        "constraints": [{"type": "absolute_y", "i": "m", "value": 0}],
        "forces": [{"type": "point_force", "i": "m", "force": ["=-9*m.x - max(0, min(1, (2.001 - t)*1000))*(1e9*(m.x - 0.3) + 6e4*m.vx)", 0]}],
        "outputs": ["m.x"], "analyses": [{"type": "dynamics", "digits": false, "until": 200, "every": 20,
          "tolerance": 1e-10)json" +
        method + "}]}");
    EXPECT_TRUE(run.analysis().report.ok()) << run.outcome.error_text << run.analysis().report.message;
    const double turned = 3 * (run.last("t") - 2.001);
    EXPECT_NEAR(run.last("m.x"), x0 * std::cos(turned) + v0 / 3 * std::sin(turned), 1e-9);
    return run.analysis().report.counters.steps;
  };
  EXPECT_LT(2 * steps(""), steps(R"(, "method": "radau")"));
}

std::string double_pendulum(const std::string& analyses, double turn = 0, double damping = 0) {
  return R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
    "one": {"rod": {"from": [0, 0], "to": [0.5, 0]}, "mass": 1, "angular_velocity": )" +
         text_of(turn) + R"(}, "two": {"rod": {"from": [0.5, 0], "to": [0.5, -0.4]}, "mass": 0.7}},
    "constraints": [{"type": "revolute", "i": "ground", "j": "one.from", "c": )" +
         text_of(damping) + R"(}, {"type": "revolute", "i": "one.to", "j": "two.from"}],
    "outputs": ["one.angle", "two.angle", "one.omega", "two.omega", "energy.total"], "analyses": [)" +
         analyses + "]}";
}

double angle_by(const std::string& method, double step, double damping) {
  const TextRun run =
      run_text(double_pendulum(R"({"type": "dynamics", "digits": false, "method": ")" + method +
                                   R"(", "at": 0.48, "tolerance": 1e-12, "step": )" + text_of(step) + "}",
                               1, damping));
  EXPECT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  return run.last("two.angle");
}

// Differences of steps that are halved fall by 2 to the power of the order.
TEST(FixedSteps, HaveTheirOrder) {
  for (const double damping : {0.0, 0.5}) {
    SCOPED_TRACE(damping);
    for (const auto& [method, order, step] :
         {std::tuple("radau", 5, 0.016), std::tuple("alpha", 2, 0.001), std::tuple("rattle", 2, 0.004)}) {
      const double whole = angle_by(method, step, damping), half = angle_by(method, step / 2, damping),
                   quarter = angle_by(method, step / 4, damping);
      EXPECT_NEAR(std::log2(std::abs(whole - half) / std::abs(half - quarter)), order, 0.35) << method;
    }
  }
}

// Of a vibration with a thousand radians a step each step leaves the part rho; the slow motion is followed.
TEST(Alpha, LeavesOfFastVibrationsWhatRhoSays) {
  for (const double rho : {0.9, 0.95, 0.98}) {
    const TextRun run = run_text(
        R"({"catena": 1, "bodies": {"m": {"mass": 1, "particle": true, "position": [0.001, 0]}},
        "forces": [{"type": "bushing", "i": "ground", "j": "m", "kx": 1e10, "ky": 1e10}], "outputs": ["m.x"],
        "analyses": [{"type": "dynamics", "digits": false, "method": "alpha", "step": 0.01, "rho": )" +
        text_of(rho) + R"(, "until": 2, "every": 0.01}]})");
    ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
    // All three roots of the method tend to -rho: the square of the number of steps stands before, up to log(25)/140.
    const std::vector<double> x = run.column("m.x");
    const auto largest = [&](std::size_t row) {
      double size = 0;
      for (std::size_t k = row; k <= row + 20; ++k) size = std::max(size, std::abs(x.at(k)));
      return size;
    };
    const double part = std::log(largest(180) / largest(40)) / 140;
    EXPECT_GT(part, std::log(rho)) << rho;
    EXPECT_LT(part, std::log(rho) + 0.026) << rho;
  }
}

TEST(Alpha, StiffChainsMoveWithinItsTolerance) {
  for (unsigned seed = 1; seed <= size_of_test(24u, 4u); ++seed) {
    SCOPED_TRACE(seed);
    const SpringChain chain(seed);
    const TextRun run = run_text(chain.scene(R"({"type": "dynamics", "method": "alpha", "digits": false, "until": )" +
                                             text_of(chain.end) + R"(, "every": )" + text_of(chain.end / 7) +
                                             R"(, "tolerance": 1e-6})"));
    ASSERT_TRUE(run.analysis().report.ok()) << run.outcome.error_text << run.analysis().report.message;
    const std::vector<double> t = run.column("t");
    for (std::size_t row = 0; row < t.size(); ++row) {
      const Eigen::Vector3d exact = chain.exact(t[row]);
      for (int k = 0; k < 3; ++k) EXPECT_NEAR(run.column("m" + std::to_string(k) + ".x")[row], k + 1 + exact[k], 1e-5);
    }
  }
}

// Symmetric in time: with velocities turned round it goes back the way it came, to rounding.
TEST(Rattle, GoesBackTheWayItCame) {
  const TextRun run = run_text(
      double_pendulum(R"({"type": "dynamics", "digits": false, "method": "rattle", "step": 0.01, "at": [0, 1.5]})", 2));
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  const double l = 0.5, a = run.last("one.angle"), b = run.last("two.angle");
  const TextRun back = run_text(
      R"({"catena": 1, "gravity": [0, -9.81], "bodies": {
    "one": {"rod": {"from": [0, 0], "to": )" +
      pair_of(l * std::cos(a), l * std::sin(a)) + R"(}, "mass": 1, "angular_velocity": )" +
      text_of(-run.last("one.omega")) + R"(}, "two": {"rod": {"from": )" + pair_of(l * std::cos(a), l * std::sin(a)) +
      R"(, "to": )" + pair_of(l * std::cos(a) + 0.4 * std::cos(b), l * std::sin(a) + 0.4 * std::sin(b)) +
      R"(}, "mass": 0.7, "angular_velocity": )" + text_of(-run.last("two.omega")) +
      R"(}}, "constraints": [{"type": "revolute", "i": "ground", "j": "one.from"},
      {"type": "revolute", "i": "one.to", "j": "two.from"}], "outputs": ["one.angle", "two.angle", "one.omega"],
      "analyses": [{"type": "dynamics", "digits": false, "method": "rattle", "step": 0.01, "at": [0, 1.5]}]})");
  ASSERT_TRUE(back.analysis().report.ok()) << back.analysis().report.message;
  EXPECT_NEAR(std::remainder(back.last("one.angle") - run.first("one.angle"), 2 * std::acos(-1)), 0, 1e-10);
  EXPECT_NEAR(std::remainder(back.last("two.angle") - run.first("two.angle"), 2 * std::acos(-1)), 0, 1e-10);
  EXPECT_NEAR(back.last("one.omega"), -run.first("one.omega"), 1e-9);
}

TEST(Rattle, KeepsEnergyWithinABound) {
  const TextRun run = run_text(double_pendulum(
      R"({"type": "dynamics", "digits": false, "method": "rattle", "step": 0.01, "until": 100, "every": 0.05})"));
  ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
  const std::vector<double> energy = run.column("energy.total");
  double early = 0, late = 0;
  for (std::size_t k = 0; k < energy.size(); ++k) {
    double& part = 2 * k < energy.size() ? early : late;
    part = std::max(part, std::abs(energy[k] - energy[0]));
  }
  EXPECT_GT(early, 1e-6);
  EXPECT_LT(late, 1.5 * early);
  EXPECT_LT(late, 0.02 * 9.81);
}

TEST(Rattle, AsksForAStep) {
  const TextRun run = run_text(double_pendulum(R"({"type": "dynamics", "method": "rattle", "until": 1, "every": 1})"));
  EXPECT_EQ(run.outcome.exit_code, 3);
  EXPECT_NE(run.outcome.error_text.find("\"step\""), std::string::npos) << run.outcome.error_text;
}

TEST(ImplicitMethods, HaveNoDerivatives) {
  for (const std::string method : {"radau", "alpha", "rattle"}) {
    const TextRun run = run_text(
        R"({"catena": 1, "parameters": {"k": 20}, "bodies": {"m": {"mass": 1, "particle": true, "position": [1, 0]}},
        "forces": [{"type": "spring_damper", "i": "ground", "j": "m", "k": "k", "length": 0.9}],
        "analyses": [{"type": "sensitivity", "parameters": ["k"], "of": {"type": "dynamics", "step": 0.01, "method": ")" +
        method + R"(", "until": 0.1, "every": 0.1, "measures": {"x": {"final": "m.x"}}}}]})");
    EXPECT_NE(run.outcome.exit_code, 0);
    EXPECT_NE((run.outcome.error_text + run.analysis().report.message).find("method " + method), std::string::npos)
        << run.outcome.error_text << run.analysis().report.message;
  }
}

}  // namespace
}  // namespace catena::testing
