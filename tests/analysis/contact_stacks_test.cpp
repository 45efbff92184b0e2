// The complementarity problem of contacts of many places: boxes on two feet each, in stacks and in walls, with dense
// matrices made here. Answers keep the laws that they are asked for; stacks that are pushed tip and slide where statics
// says so.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "analysis/sanitized.hpp"
#include "catena/analysis/contact/problem/contact_problem.hpp"
#include "catena/analysis/contact/shared_forces.hpp"

namespace catena {
namespace {

using State = ContactProblem::State;

constexpr double weight = 9.81;  // of every box, N: mass 1

/// A foot of one box on another, or on the floor (-1): its place seen from both centres, normals along y.
struct Foot {
  int lower, upper;
  double x_lower, x_upper;
};

/// Boxes of width and height one; b are accelerations, D = J M^-1 J^T.
ContactProblem of_boxes(int boxes, const std::vector<Foot>& feet, double mu, double mu_static,
                        const std::vector<double>& push) {
  const std::size_t size = 2 * feet.size(), coordinates = static_cast<std::size_t>(3 * boxes);
  std::vector<double> J(size * coordinates, 0.0);
  ContactProblem problem(feet.size());
  for (std::size_t k = 0; k < feet.size(); ++k) {
    problem.place[k] = {.has_normal = true, .has_friction = mu_static > 0, .mu = mu, .mu_static = mu_static};
    const auto put = [&](int box, double sign, double x, double y) {
      if (box < 0) return;
      double* across = &J[2 * k * coordinates + static_cast<std::size_t>(3 * box)];
      double* along = across + coordinates;
      across[1] = sign;
      across[2] = sign * x;
      along[0] = sign;
      along[2] = -sign * y;
    };
    put(feet[k].upper, 1, feet[k].x_upper, -0.5);
    put(feet[k].lower, -1, feet[k].x_lower, 0.5);
  }
  const auto inverse = [](std::size_t c) { return c % 3 == 2 ? 6.0 : 1.0; };
  for (std::size_t r = 0; r < size; ++r) {
    for (std::size_t c = 0; c < coordinates; ++c) {
      const double force = c % 3 == 1 ? -weight : c % 3 == 0 ? push[c / 3] : 0;
      problem.b[r] += J[r * coordinates + c] * inverse(c) * force;
      problem.b_terms[r] += std::abs(J[r * coordinates + c] * inverse(c) * force);
      for (std::size_t s = 0; s < size; ++s)
        problem.D(r, s) += J[r * coordinates + c] * inverse(c) * J[s * coordinates + c];
    }
  }
  return problem;
}

std::vector<Foot> stack(int boxes) {
  std::vector<Foot> feet;
  for (int k = 0; k < boxes; ++k) {
    for (const double x : {-0.5, 0.5}) feet.push_back({k - 1, k, x, x});
  }
  return feet;
}

/// Rows of boxes, each laid over the gap of two below: four feet between neighbouring rows a box.
std::vector<Foot> wall(int rows, int columns, int& boxes) {
  std::vector<Foot> feet;
  std::vector<int> below;
  boxes = 0;
  for (int r = 0; r < rows; ++r) {
    std::vector<int> row;
    for (int c = 0; c + r < columns; ++c) row.push_back(boxes++);
    for (std::size_t c = 0; c < row.size(); ++c) {
      if (r == 0) {
        for (const double x : {-0.5, 0.5}) feet.push_back({-1, row[c], 0, x});
        continue;
      }
      feet.push_back({below[c], row[c], 0, -0.5});
      feet.push_back({below[c], row[c], 0.5, 0});
      feet.push_back({below[c + 1], row[c], -0.5, 0});
      feet.push_back({below[c + 1], row[c], 0, 0.5});
    }
    below = row;
  }
  return feet;
}

double rate_of(const ContactProblem& p, std::size_t row) {
  double w = p.b[row];
  for (std::size_t c = 0; c < p.x.size(); ++c) w += p.D(row, c) * p.x[c];
  return w;
}

void expect_to_keep_laws(const ContactProblem& p, double rounding) {
  for (std::size_t k = 0; k < p.place.size(); ++k) {
    const double normal = p.x[2 * k], along = p.x[2 * k + 1], open = rate_of(p, 2 * k), slip = rate_of(p, 2 * k + 1);
    EXPECT_GE(normal, -rounding) << k;
    EXPECT_GE(open, -rounding) << k;
    EXPECT_NEAR(normal * open, 0, rounding) << k;
    if (p.state[k] == State::sticks) {
      EXPECT_NEAR(slip, 0, rounding) << k;
      EXPECT_LE(std::abs(along), p.place[k].mu_static * normal + rounding) << k;
    }
    if (p.state[k] == State::slides) {
      EXPECT_NEAR(along, -p.place[k].mu * p.direction[k] * normal, rounding) << k;
      EXPECT_GE(slip * p.direction[k], -rounding) << k;
    }
    if (p.state[k] == State::open) {
      EXPECT_EQ(along, 0) << k;
    }
  }
}

TEST(ContactStacks, RandomPushesKeepTheLaws) {
  std::mt19937 engine(3);
  std::uniform_real_distribution<double> number(0, 1);
  for (int n = 0; n < testing::size_of_test(150, 30); ++n) {
    SCOPED_TRACE(n);
    int boxes = 4 + n % 17;
    const std::vector<Foot> feet = n % 3 == 2 ? wall(4, 4 + n % 4, boxes) : stack(boxes);
    std::vector<double> push(static_cast<std::size_t>(boxes));
    for (double& force : push) force = 12 * (number(engine) - 0.5);
    const double mu = 0.1 + 0.7 * number(engine), more = 1 + (n % 2) * 0.4 * number(engine);
    ContactProblem problem = of_boxes(boxes, feet, mu, more * mu, push);
    ASSERT_TRUE(problem.solve());
    expect_to_keep_laws(problem, 1e-6);
  }
}

/// The force on box k of n with which they give way: about the lower right edge of box j <= k it turns those from j on
/// where F (k - j + 1/2) > (n - j) g / 2, and it moves those from k on where F > mu (n - k) g.
double least_push(int boxes, int k, double mu) {
  double least = mu * (boxes - k) * weight;
  for (int j = 0; j <= k; ++j) least = std::min(least, (boxes - j) * weight / 2 / (k - j + 0.5));
  return least;
}

TEST(ContactStacks, TipsAndSlidesWhereStaticsSays) {
  std::mt19937 engine(4);
  std::uniform_real_distribution<double> number(0, 1);
  int held = 0, moved = 0;
  for (int n = 0; n < 120; ++n) {
    SCOPED_TRACE(n);
    const int boxes = 4 + n % 22, k = n % boxes;
    const double mu = 0.05 + 0.6 * number(engine);
    const double part = n % 2 == 0 ? 0.5 + 0.49 * number(engine) : 1.01 + 0.2 * number(engine);
    std::vector<double> push(static_cast<std::size_t>(boxes), 0.0);
    push[static_cast<std::size_t>(k)] = part * least_push(boxes, k, mu);
    ContactProblem problem = of_boxes(boxes, stack(boxes), mu, mu, push);
    ASSERT_TRUE(problem.solve());
    expect_to_keep_laws(problem, 1e-7);
    std::vector<std::size_t> point(problem.place.size());
    bool sticks = true;
    for (std::size_t p = 0; p < point.size(); ++p) {
      point[p] = p;
      sticks = sticks && problem.state[p] == State::sticks;
    }
    EXPECT_EQ(sticks, part < 1);
    (sticks ? held : moved)++;
    if (sticks) {
      SharedForces forces(problem, point);
      const auto normal = [&](std::size_t p) { return problem.x[2 * p]; };
      const auto along = [&](std::size_t p) { return problem.x[2 * p + 1]; };
      EXPECT_EQ(forces.places().size(), point.size());
      EXPECT_GT(forces.margin(normal, along), 0);
    }
  }
  EXPECT_GE(held, 50);
  EXPECT_GE(moved, 50);
}

// As the push grows from nothing the margin reaches zero where statics says that the stack gives way, with the forces
// of whatever share.
TEST(ContactStacks, TheMarginEndsWhereTheStackGivesWay) {
  for (const int boxes : {4, 8, 13, 20}) {
    for (const double mu : {0.1, 0.9}) {
      SCOPED_TRACE(std::to_string(boxes) + " boxes, mu " + std::to_string(mu));
      const int k = boxes / 2;
      const double least = least_push(boxes, k, mu);
      std::vector<double> push(static_cast<std::size_t>(boxes), 0.0);
      push[static_cast<std::size_t>(k)] = least / 2;
      ContactProblem problem = of_boxes(boxes, stack(boxes), mu, mu, push);
      ASSERT_TRUE(problem.solve());
      std::vector<std::size_t> point(problem.place.size());
      for (std::size_t p = 0; p < point.size(); ++p) point[p] = p;
      SharedForces forces(problem, point);
      // All forces are linear in the push: T of a side, N by the lever. One share for each box: half and half along.
      const auto margin_at = [&](double force) {
        std::vector<double> N, T;
        for (int j = 0; j < boxes; ++j) {
          const double above = (boxes - j) * weight, moment = j <= k ? force * (k - j + 0.5) : 0;
          for (const double side : {-1.0, 1.0}) {
            N.push_back(above / 2 + side * moment);
            T.push_back(j <= k ? -force / 2 : 0);
          }
        }
        return forces.margin([&](std::size_t p) { return N[p]; }, [&](std::size_t p) { return T[p]; });
      };
      EXPECT_GT(margin_at(0.999999 * least), 0);
      EXPECT_NEAR(margin_at(least), 0, 1e-9);
      EXPECT_LT(margin_at(1.000001 * least), 0);
    }
  }
}

}  // namespace
}  // namespace catena
