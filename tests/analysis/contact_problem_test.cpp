// The complementarity problem of contacts: every answer keeps the laws that it was asked for, at random places on
// random bodies; small ones against what can be written down.
#include "catena/analysis/contact/problem/contact_problem.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace catena {
namespace {

using State = ContactProblem::State;

/// Places on one rigid body of mass 1 and inertia 0.02: normals and tangents at random, D = J M^-1 J^T.
ContactProblem random_problem(std::mt19937& engine, std::size_t places, double mu) {
  std::uniform_real_distribution<double> number(-1, 1);
  std::vector<double> J(6 * places);
  ContactProblem problem(places);
  for (std::size_t k = 0; k < places; ++k) {
    const double x = 0.2 * number(engine), y = -0.1;
    const double rows[6] = {0, 1, x, 1, 0, -y};
    std::copy(rows, rows + 6, J.begin() + static_cast<std::ptrdiff_t>(6 * k));
    problem.place[k] = {.has_normal = true, .has_friction = mu > 0, .mu = mu, .mu_static = 1.3 * mu};
    problem.b[2 * k] = -1 + number(engine);
    problem.b[2 * k + 1] = 2 * number(engine);
  }
  const double inverse[3] = {1, 1, 50};
  for (std::size_t r = 0; r < 2 * places; ++r) {
    for (std::size_t c = 0; c < 2 * places; ++c) {
      double sum = 0;
      for (std::size_t n = 0; n < 3; ++n) sum += J[3 * r + n] * inverse[n] * J[3 * c + n];
      problem.D(r, c) = sum;
    }
  }
  return problem;
}

double rate(const ContactProblem& p, std::size_t row) {
  double w = p.b[row];
  for (std::size_t c = 0; c < p.x.size(); ++c) w += p.D(row, c) * p.x[c];
  return w;
}

void expect_laws(const ContactProblem& p) {
  constexpr double rounding = 1e-9;
  for (std::size_t k = 0; k < p.place.size(); ++k) {
    const double normal = p.x[2 * k], along = p.x[2 * k + 1], open = rate(p, 2 * k), slip = rate(p, 2 * k + 1);
    EXPECT_GE(normal, -rounding);
    EXPECT_GE(open, -rounding);
    EXPECT_NEAR(normal * open, 0, rounding);
    if (!p.place[k].has_friction) continue;
    if (p.state[k] == State::sticks) {
      EXPECT_NEAR(slip, 0, rounding);
      EXPECT_LE(std::abs(along), p.place[k].mu_static * normal + rounding);
    }
    if (p.state[k] == State::slides) {
      EXPECT_NEAR(along, -p.place[k].mu * p.direction[k] * normal, rounding);
      EXPECT_GE(slip * p.direction[k], -rounding);
    }
    if (p.state[k] == State::open) {
      EXPECT_EQ(along, 0);
    }
  }
}

TEST(ContactProblem, KeepsTheLawsWithoutFriction) {
  std::mt19937 engine(1);
  for (int n = 0; n < 300; ++n) {
    SCOPED_TRACE(n);
    ContactProblem problem = random_problem(engine, 1 + static_cast<std::size_t>(n) % 6, 0);
    ASSERT_TRUE(problem.solve());
    expect_laws(problem);
  }
}

TEST(ContactProblem, KeepsTheLawsWithFriction) {
  std::mt19937 engine(2);
  int solved = 0;
  for (int n = 0; n < 300; ++n) {
    SCOPED_TRACE(n);
    ContactProblem problem = random_problem(engine, 1 + static_cast<std::size_t>(n) % 2, 0.05 + 0.002 * n / 2);
    if (!problem.solve()) continue;
    ++solved;
    expect_laws(problem);
  }
  EXPECT_GE(solved, 290);
}

TEST(ContactProblem, ABlockOnTwoCornersSharesItsWeight) {
  // Corners at +-0.1, weight 10: without friction half of it each.
  ContactProblem problem(2);
  for (std::size_t r = 0; r < 2; ++r) {
    problem.b[2 * r] = -10;
    for (std::size_t c = 0; c < 2; ++c) problem.D(2 * r, 2 * c) = 1 + (r == c ? 0.5 : -0.5);
  }
  ASSERT_TRUE(problem.solve());
  EXPECT_NEAR(problem.x[0], 5, 1e-13);
  EXPECT_NEAR(problem.x[2], 5, 1e-13);
}

TEST(ContactProblem, RedundantPlacesTakeTheLeast) {
  ContactProblem problem(3);
  for (std::size_t r = 0; r < 3; ++r) {
    problem.b[2 * r] = -6;
    for (std::size_t c = 0; c < 3; ++c) problem.D(2 * r, 2 * c) = 1;
  }
  ASSERT_TRUE(problem.solve());
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(problem.x[2 * k], 2, 1e-12);
}

TEST(ContactProblem, TellsAWedgedPlace) {
  ContactProblem problem(1);
  problem.place[0] = {.has_normal = true, .has_friction = true, .mu = 2, .mu_static = 2, .slip = 1};
  problem.b = {-1, 1};
  problem.D(0, 0) = problem.D(1, 1) = 1;
  problem.D(0, 1) = problem.D(1, 0) = 0.8;  // D_nn < mu D_tn
  EXPECT_FALSE(problem.solve());
}

}  // namespace
}  // namespace catena
