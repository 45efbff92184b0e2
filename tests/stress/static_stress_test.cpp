// Static equilibrium by the thousand: random spring networks and linkages, random starts of chains, mechanisms that
// balance wherever they stand. Every answer is checked without the solver: forces by the residual of the equilibrium
// equations, stability by the energies of configurations nearby, or against a closed form.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <map>

#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "oracles/balanced_mechanisms.hpp"
#include "oracles/random_statics.hpp"
#include "oracles/static_reference.hpp"
#include "stress/cases.hpp"

namespace catena {
namespace {

/// Largest of V_q + Phi_q^T lambda beside the largest force in it; springs are known to 1e-12 of their stiffness times
/// 1 m.
double force_left(Equilibrium& analysis) {
  Evaluator& evaluator = analysis.evaluator();
  const Plan& plan = analysis.plan();
  evaluator.set_configuration(analysis.q());
  std::vector<double> loads(static_cast<std::size_t>(plan.coordinates())), rest(loads.size(), 0.0);
  evaluator.applied_forces(rest, loads);
  std::vector<double> jacobian(static_cast<std::size_t>(plan.trash_slot()) + 1);
  evaluator.start_jacobian(jacobian);
  evaluator.jacobian(jacobian);
  double largest = 0, size = 1e-300;
  evaluator.visit_stiffness({}, [&](int, int, const auto& matrix) {
    for (int k = 0; k < 6; ++k) size = std::max(size, 1e-3 * std::abs(matrix[static_cast<std::size_t>(7 * k)]));
  });
  for (int c = 0; c < plan.columns; ++c) {
    double sum = -loads[static_cast<std::size_t>(plan.coordinate[static_cast<std::size_t>(c)])];
    size = std::max(size, std::abs(sum));
    for (int k = plan.jacobian.column_start[static_cast<std::size_t>(c)];
         k < plan.jacobian.column_start[static_cast<std::size_t>(c) + 1]; ++k) {
      const double part =
          jacobian[static_cast<std::size_t>(k)] *
          analysis.lambda()[static_cast<std::size_t>(plan.jacobian.row_index[static_cast<std::size_t>(k)])];
      sum += part;
      size = std::max(size, std::abs(part));
    }
    largest = std::max(largest, std::abs(sum));
  }
  return largest / size;
}

/// How much the energy of assembled configurations nearby falls short of the one found, at worst (0: nowhere lower).
double lower_nearby(Equilibrium& analysis, unsigned seed) {
  Evaluator& evaluator = analysis.evaluator();
  Assembler assembler(evaluator);
  std::mt19937 random(seed);
  const std::vector<double> found(analysis.q().begin(), analysis.q().end());
  evaluator.set_configuration(found);
  const double energy = evaluator.potential_energy();
  double worst = 0;
  for (int trial = 0; trial < 12; ++trial) {
    std::vector<double> q = found;
    for (int c = 0; c < analysis.plan().columns; ++c) {
      q[static_cast<std::size_t>(analysis.plan().coordinate[static_cast<std::size_t>(c)])] +=
          1e-4 * (static_cast<double>(random()) / 2147483648.0 - 1);
    }
    if (!assembler.assemble(q, 1e-14).ok()) continue;
    evaluator.set_configuration(q);
    worst = std::max(worst, energy - evaluator.potential_energy());
  }
  evaluator.set_configuration(found);
  return worst;
}

void check_many(bool linkages, int count) {
  std::map<std::string, int> outcomes;
  int failed = 0;
  for (unsigned seed = testing::first_case(); seed <= testing::last_case(count); ++seed) {
    testing::RandomStatics random(seed);
    Equilibrium analysis(linkages ? random.linkage() : random.network());
    const EquilibriumReport report = analysis.solve();
    ++outcomes[std::string(to_string(report.status))];
    if (!report.ok()) {
      ++failed;
      if (failed <= 20) std::printf("seed %u: %s\n", seed, report.message.c_str());
      continue;
    }
    EXPECT_LE(force_left(analysis), 1e-9) << seed;
    EXPECT_TRUE(report.stable || report.neutral) << seed;
    if (!report.stable) continue;
    EXPECT_LE(lower_nearby(analysis, seed), 1e-11 * (1 + std::abs(report.energy))) << seed;
  }
  testing::print_shares(linkages ? "linkages" : "networks", outcomes);
  EXPECT_LE(failed, testing::stress_cases(count) / 100);
}

TEST(RandomStatics, SpringNetworks) { check_many(false, 5000); }

TEST(RandomStatics, LinkagesWithSprings) { check_many(true, 5000); }

TEST(RandomStatics, AThousandChainsFromRandomAngles) {
  const double tension = testing::reference_values("discrete_catenary").at("N100").at("horizontal_tension_H");
  for (unsigned seed = 1; seed <= 1000; ++seed) {
    Equilibrium chain(testing::hanging_chain(
        100, seed % 2 ? testing::ChainStart::random_walk : testing::ChainStart::scattered, 1000 + seed));
    const EquilibriumReport report = chain.solve();
    ASSERT_TRUE(report.ok()) << seed << ": " << report.message;
    EXPECT_TRUE(report.stable) << seed;
    EXPECT_NEAR(chain.lambda()[0], tension, 1e-12 * tension) << seed;
  }
}

TEST(BalancedMechanisms, StayWhereTheyStand) {
  testing::expect_to_stay(testing::first_case(1001), testing::stress_cases(4000));
}

TEST(BalancedMechanisms, AreUnstableAMillionthShort) {
  testing::expect_unstable_when_short(testing::first_case(1001), testing::stress_cases(3000));
}

TEST(BalancedMechanisms, LetAPendulumBesideThemFall) {
  testing::expect_a_pendulum_to_fall(testing::first_case(1001), testing::stress_cases(3000));
}

}  // namespace
}  // namespace catena
