// Modes of random chains of particles on a line, tied to the ground or free, whose springs differ by up to twelve
// orders of magnitude, against bisection by Sturm's sequence in extended precision.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "catena/analysis/stability/modes.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

struct ParticleChain {
  std::vector<double> mass;       ///< n
  std::vector<double> stiffness;  ///< n + 1: to the ground, between neighbours, to the ground; 0: no spring
};

std::shared_ptr<Model> model_of(const ParticleChain& chain) {
  auto model = std::make_shared<Model>();
  const int n = static_cast<int>(chain.mass.size());
  const auto spring = [&](double k, int i, int j, double ground_x) {
    if (k == 0) return;
    SpringDamper<double> s;
    s.k = k;
    s.length = 1;
    (i == ground ? s.s_i : s.s_j) = {i == ground || j == ground ? ground_x : 0, 0};
    model->add_force("", s, i, j);
  };
  for (int b = 0; b < n; ++b) {
    const int body = model->add_body("p" + std::to_string(b), {.mass = chain.mass[b], .position = {1.0 + b, 0}});
    model->bodies[body].particle = true;
    model->add("", AbsoluteY<double>{}, body, ground, 0.0);
    spring(chain.stiffness[b], b == 0 ? ground : b - 1, b, 0);
  }
  spring(chain.stiffness[n], n - 1, ground, n + 1.0);
  return model;
}

/// Eigenvalues of M^-1/2 K M^-1/2, ascending.
std::vector<double> exact_values(const ParticleChain& chain) {
  const std::size_t n = chain.mass.size();
  const auto& k = chain.stiffness;
  long double high = 0;
  for (std::size_t b = 0; b < n; ++b)
    high = std::max(high, 2 * (static_cast<long double>(k[b]) + k[b + 1]) / chain.mass[b]);
  high = high * (high > 0 ? 2 : 0) + 1;
  // Negative pivots of K - x M.
  const auto below = [&](long double x) {
    std::size_t count = 0;
    long double pivot = 1;
    for (std::size_t b = 0; b < n; ++b) {
      const long double beside = b > 0 ? k[b] : 0.0;
      pivot = static_cast<long double>(k[b]) + k[b + 1] - x * chain.mass[b] - beside * beside / pivot;
      if (pivot == 0) pivot = -1e-300L;
      count += pivot < 0;
    }
    return count;
  };
  std::vector<double> values;
  for (std::size_t m = 0; m < n; ++m) {
    long double least = 0, most = high;
    for (int step = 0; step < 200; ++step) {
      // Geometrically, once a lower bound is known.
      const long double middle = least > 1e-12L * high ? std::sqrt(least * most) : (least + most) / 2;
      (below(middle) > m ? most : least) = middle;
    }
    values.push_back(static_cast<double>(most));
  }
  return values;
}

TEST(ModesOfChains, AreAllThereWhateverTheSprings) {
  std::mt19937 random(2024);
  const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
  for (int trial = 0; trial < 600; ++trial) {
    const int n = 2 + static_cast<int>(random() % 6);
    const double orders = std::vector<double>{0, 2, 6, 9, 12}[trial % 5];
    ParticleChain chain;
    for (int b = 0; b < n; ++b) chain.mass.push_back(std::pow(10, uniform(-1, 1)));
    for (int b = 0; b <= n; ++b) chain.stiffness.push_back(std::pow(10, uniform(0, orders)) * uniform(1, 2));
    const bool free = trial % 3 == 0;
    if (free || trial % 3 == 1) chain.stiffness.back() = 0;
    if (free) chain.stiffness.front() = 0;

    Modes modes(model_of(chain), {}, {.count = n});
    const ModesReport report = modes.run();
    ASSERT_TRUE(report.ok()) << trial << ": " << report.message;
    ASSERT_EQ(report.omega2.size(), static_cast<std::size_t>(n)) << trial;
    const std::vector<double> exact = exact_values(chain);
    const double largest = exact.back();
    for (int m = 0; m < n; ++m) {
      // The entries of K are rounded: springs below 1e-16 of their neighbour's are lost in them.
      EXPECT_NEAR(report.omega2[m], exact[m], 1e-9 * exact[m] + 3e-15 * largest)
          << trial << ", mode " << m + 1 << " of " << n << (free ? ", free" : "") << ", " << orders << " orders";
      for (int other = 0; other < m; ++other) {
        double product = 0, own = 0, others = 0;
        const std::vector<double>&u = report.shapes[m], &v = report.shapes[other];
        for (int b = 0; b < n; ++b) {
          product += chain.mass[b] * u[2 * b] * v[2 * b];
          own += chain.mass[b] * u[2 * b] * u[2 * b];
          others += chain.mass[b] * v[2 * b] * v[2 * b];
        }
        EXPECT_LE(std::abs(product), 1e-4 * std::sqrt(own * others)) << trial << ", modes " << other << " and " << m;
      }
    }
  }
}

}  // namespace
}  // namespace catena
