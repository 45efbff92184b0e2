// Contacts, stops and cables: the gap in its own terms, its derivatives against differences, plans with and without.
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>

#include "catena/assembly/evaluate.hpp"
#include "catena/elements/all.hpp"
#include "catena/elements/gap_element.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

constexpr double step = 1e-6;

// Two bodies and one gap between them.
struct Pair {
  Model model;
  EvaluationWork work;
  std::unique_ptr<Evaluator> evaluator;
  std::vector<double> q;

  template <class E>
  explicit Pair(const E& gap) {
    model.add_body("a", {.position = {0.4, -0.3}, .angle = 0.6});
    model.add_body("b", {.position = {1.1, 0.9}, .angle = -0.8});
    model.add("gap", gap, 0, 1);
    evaluator = std::make_unique<Evaluator>(Plan::make(model, {.one_sided = true}), model, work);
    q = evaluator->given_configuration();
    evaluator->set_configuration(q);
  }
  double psi(const std::vector<double>& place) {
    evaluator->set_configuration(place);
    double value = 0;
    evaluator->phi({&value, 1});
    return value;
  }
  // Phi_q, dense over coordinates in plan order.
  std::array<double, 6> gradient(const std::vector<double>& place) {
    evaluator->set_configuration(place);
    const Plan& plan = evaluator->plan();
    std::vector<double> values(static_cast<std::size_t>(plan.trash_slot()) + 1);
    evaluator->start_jacobian(values);
    evaluator->jacobian(values);
    std::array<double, 6> dense{};
    for (std::size_t c = 0; c < 6; ++c) {
      for (int k = plan.jacobian.column_start[c]; k < plan.jacobian.column_start[c + 1]; ++k)
        dense[c] = values[static_cast<std::size_t>(k)];
    }
    return dense;
  }
  double measured() {
    evaluator->set_configuration(q);
    return evaluator->measure(0, {}, {}).value;
  }
};

void expect_exact_derivatives(Pair& pair) {
  const std::array<double, 6> exact = pair.gradient(pair.q);
  const double lambda[] = {1};
  ElementMatrix second{};
  int first = 0;
  pair.evaluator->visit_constraint_hessians(lambda, [&](int body_i, int, const ElementMatrix& m) {
    second = m;
    first = body_i;
  });
  for (std::size_t c = 0; c < 6; ++c) {
    std::vector<double> there = pair.q, here = pair.q;
    there[c] += step;
    here[c] -= step;
    EXPECT_NEAR(exact[c], (pair.psi(there) - pair.psi(here)) / (2 * step), 1e-8) << c;
    const std::array<double, 6> after = pair.gradient(there), before = pair.gradient(here);
    for (std::size_t d = 0; d < 6; ++d) {
      // Bodies may be numbered in the other order.
      const auto local = [&](std::size_t k) { return first == 0 ? k : (k + 3) % 6; };
      EXPECT_NEAR(second[6 * local(c) + local(d)], (after[d] - before[d]) / (2 * step), 1e-8) << c << " " << d;
    }
  }
}

Vec2<double> point_of(const Pair& pair, int body, const Vec2<double>& local) {
  return pair.model.frame(body).point(local);
}

TEST(GapElements, ContactOutsideAndInsideOfACircle) {
  const Vec2<double> centre{0.2, -0.1}, local{-0.1, 0.3};
  for (const int side : {1, -1}) {
    Contact<double> contact;
    contact.curve = Curve<double>::circle(centre, 0.5);
    contact.s_j = local;
    contact.radius = 0.05;
    contact.side = side;
    Pair pair(contact);
    const double apart = norm(point_of(pair, 1, local) - point_of(pair, 0, centre));
    EXPECT_NEAR(pair.psi(pair.q), side * (apart - 0.5) - 0.05, 1e-14);
    EXPECT_NEAR(pair.measured(), side * (apart - 0.5) - 0.05, 1e-14);
    expect_exact_derivatives(pair);
  }
}

TEST(GapElements, ContactOnTheLeftOfALine) {
  Contact<double> contact;
  contact.curve = Curve<double>::line({0.1, 0}, {2, 0});
  contact.s_j = {0.3, 0.2};
  Pair pair(contact);
  const Frame<double> a = pair.model.frame(0);
  EXPECT_NEAR(pair.psi(pair.q), a.to_local(point_of(pair, 1, {0.3, 0.2}) - a.origin()).y, 1e-14);
  expect_exact_derivatives(pair);
}

TEST(GapElements, StretchesOfRopesTouchTheirCircles) {
  for (const double radius_i : {0.0, 0.3, -0.2}) {
    for (const double radius_j : {0.0, 0.25, -0.3}) {
      Rope<double> rope;
      rope.s_i = {0.3, 0.1};
      rope.s_j = {-0.2, 0.4};
      rope.radius_i = radius_i;
      rope.radius_j = radius_j;
      rope.turn_i = 0.15;
      rope.turn_j = -0.4;
      rope.length = 3;
      rope.direction = {std::cos(0.9), std::sin(0.9)};
      rope.angle = 0.9;
      Pair pair(rope);
      const Frame<double> a = pair.model.frame(0), b = pair.model.frame(1);
      const Vec2<double> h = point_of(pair, 1, rope.s_j) - point_of(pair, 0, rope.s_i);
      const Vec2<double> u = rope.unit(h);
      EXPECT_NEAR(norm(u), 1, 1e-14);
      // The line passes both centres at their radii, on the left of its direction.
      EXPECT_NEAR(dot(perpendicular(u), h), radius_j - radius_i, 1e-14);
      const double expected = dot(u, h) + (radius_i - radius_j) * std::atan2(u.y, u.x) + 0.15 * a.phi - 0.4 * b.phi;
      EXPECT_NEAR(pair.psi(pair.q), 3 - expected, 1e-14);
      EXPECT_NEAR(pair.measured(), 3 - expected, 1e-14);
      expect_exact_derivatives(pair);
    }
  }
}

TEST(GapElements, CableIsSmoothWhereItsEndsMeet) {
  Cable<double> cable{{0.3, 0.1}, {-0.2, 0.4}, 1.7};
  Pair pair(cable);
  const double apart = norm(point_of(pair, 1, {-0.2, 0.4}) - point_of(pair, 0, {0.3, 0.1}));
  EXPECT_NEAR(pair.measured(), 1.7 - apart, 1e-14);
  EXPECT_NEAR(pair.psi(pair.q), (1.7 * 1.7 - apart * apart) / 3.4, 1e-14);
  expect_exact_derivatives(pair);
  // Taut, its slope is that of the distance.
  Cable<double> taut{{0.3, 0.1}, {-0.2, 0.4}};
  Pair stretched(taut);
  EXPECT_NEAR(stretched.psi(stretched.q), 0, 1e-14);
  const std::array<double, 6> slope = stretched.gradient(stretched.q);
  EXPECT_NEAR(std::hypot(slope[0], slope[1]), 1, 1e-14);
  Cable<double> together{
      {0.3, 0.1}, pair.model.frame(1).to_local(point_of(pair, 0, {0.3, 0.1}) - pair.model.frame(1).origin()), 1};
  Pair met(together);
  EXPECT_NEAR(met.measured(), 1, 1e-14);
  for (double x : met.gradient(met.q)) EXPECT_NEAR(x, 0, 1e-14);
}

TEST(GapElements, StopsOfAnglesSlidesAndDistances) {
  Stop<double> stop;
  stop.s_i = {0.3, 0.1};
  stop.s_j = {-0.2, 0.4};
  stop.axis_i = {3, 4};
  const Vec2<double> h{-0.2, 0.4};
  for (const StopQuantity quantity : {StopQuantity::angle, StopQuantity::slide, StopQuantity::distance}) {
    stop.quantity = quantity;
    Stop<double> low = stop, high = stop, both = stop;
    low.min = both.min = -2;
    high.max = both.max = 3;
    Pair one(low), other(high), two(both);
    const Vec2<double> span = point_of(one, 1, h) - point_of(one, 0, {0.3, 0.1});
    const double u = quantity == StopQuantity::angle   ? -0.8 - 0.6
                     : quantity == StopQuantity::slide ? dot(one.model.frame(0).axis(Vec2<double>{0.6, 0.8}), span)
                                                       : norm(span);
    EXPECT_NEAR(one.measured(), u + 2, 1e-14);
    EXPECT_NEAR(other.measured(), 3 - u, 1e-14);
    EXPECT_NEAR(two.measured(), std::min(u + 2, 3 - u), 1e-14);
    EXPECT_NEAR(two.psi(two.q), (u + 2) * (3 - u) / 5, 1e-14);
    EXPECT_EQ(one.evaluator->plan().row_is_angle[0], quantity == StopQuantity::angle);
    for (Pair* pair : {&one, &other, &two}) expect_exact_derivatives(*pair);
  }
}

TEST(GapElements, BadParametersAreNamed) {
  Model model;
  model.add_body("a", {});
  const auto message = [&](const auto& element) -> std::string {
    try {
      model.add("", element, ground, 0);
    } catch (const ModelError& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_NE(message(Stop<double>{}).find("needs \"min\" or \"max\""), std::string::npos);
  Stop<double> crossed;
  crossed.min = 2;
  crossed.max = 1;
  EXPECT_NE(message(crossed).find("\"min\" must be below \"max\""), std::string::npos);
  EXPECT_NE(message(Cable<double>{}).find("length above zero"), std::string::npos);
  EXPECT_NE(message(Contact<double>{}).find("no curve"), std::string::npos);
}

TEST(GapElements, PlansRefuseWhatTheyWouldTakeForEquations) {
  Model model;
  model.add_body("a", {});
  model.add("rope", Cable<double>{{}, {}, 1}, ground, 0);
  try {
    Plan::make(model);
    FAIL();
  } catch (const ModelError& error) {
    EXPECT_NE(std::string(error.what()).find("cable \"rope\" is one-sided"), std::string::npos);
  }
  EXPECT_EQ(Plan::make(model, {.released_elements = model.gaps()})->rows, 0);
  EXPECT_EQ(Plan::make(model, {.one_sided = true})->gap_rows, std::vector<int>{0});
}

TEST(GapElements, RowsThatAreLeftOutAreZero) {
  Model model;
  model.add_body("a", {.position = {0.5, 0.2}});
  model.add_body("b", {.position = {2, 1}});
  model.add("", Cable<double>{{}, {0.1, 0.2}, 1}, ground, 0);
  model.add("", Cable<double>{{0.3, 0.2}, {0.1, -0.4}, 2}, 0, 1);
  EvaluationWork work;
  Evaluator evaluator(Plan::make(model, {.one_sided = true}), model, work);
  evaluator.set_configuration(evaluator.given_configuration());
  const Plan& plan = evaluator.plan();
  std::vector<double> values(static_cast<std::size_t>(plan.trash_slot()) + 1), phi(2);
  evaluator.start_jacobian(values);
  const int out[] = {1};
  evaluator.leave_out(out);
  evaluator.jacobian(values);
  evaluator.phi(phi);
  EXPECT_NE(phi[0], 0);
  EXPECT_EQ(phi[1], 0);
  for (int k = 0; k < plan.jacobian.entries(); ++k) {
    const auto slot = static_cast<std::size_t>(k);
    EXPECT_EQ(values[slot] == 0, plan.jacobian.row_index[slot] == 1) << k;
  }
  evaluator.leave_out({});
  evaluator.phi(phi);
  EXPECT_NE(phi[1], 0);
}

}  // namespace
}  // namespace catena
