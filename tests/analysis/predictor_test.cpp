// Prediction from earlier instants: exact for polynomials, and no worse where two instants lie close together.
#include "catena/analysis/kinematics/course/predictor.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace catena::testing {
namespace {

using Cubic = std::array<double, 4>;

double value(const Cubic& c, double t) { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
double rate(const Cubic& c, double t) { return c[1] + t * (2 * c[2] + t * 3 * c[3]); }
double acceleration(const Cubic& c, double t) { return 2 * c[2] + 6 * t * c[3]; }

/// Records the cubic at t with its derivatives up to `derivatives`.
void push(Predictor& predictor, const Cubic& c, double t, int derivatives) {
  const double q = value(c, t), qd = rate(c, t), qdd = acceleration(c, t);
  const std::span<const double> none;
  predictor.push(t, {&q, 1}, derivatives > 0 ? std::span(&qd, 1) : none, derivatives > 1 ? std::span(&qdd, 1) : none);
}

constexpr Cubic cubic{0.3, -1.2, 0.7, 0.4};

TEST(Predictor, IsExactForCubics) {
  for (const int derivatives : {0, 1, 2}) {
    SCOPED_TRACE(derivatives);
    Predictor predictor(1);
    for (const double t : {0.0, 0.1, 0.25, 0.3}) push(predictor, cubic, t, derivatives);
    double q = 0, qd = 0, qdd = 0;
    ASSERT_TRUE(predictor.predict(0.4, {&q, 1}, {&qd, 1}, {&qdd, 1}));
    EXPECT_NEAR(q, value(cubic, 0.4), 1e-13);
    EXPECT_NEAR(qd, rate(cubic, 0.4), 1e-12);
    EXPECT_NEAR(qdd, acceleration(cubic, 0.4), 1e-10);
  }
}

// A row asked for just before an event leaves two instants that differ by next to nothing: the difference of their
// rounding errors must not be carried ahead. One instant alone predicts to its Taylor remainder.
TEST(Predictor, OfTwoInstantsCloseTogetherTakesOne) {
  for (const int derivatives : {0, 1, 2}) {
    for (const double gap : {1e-3, 1e-6, 1e-9, 1e-12, 1e-15}) {
      SCOPED_TRACE(::testing::Message() << derivatives << " derivatives, gap " << gap);
      Predictor predictor(1);
      for (const double t : {-0.5, 0.0, 1.0 - gap, 1.0}) push(predictor, cubic, t, derivatives);
      const double ahead = 1.1;
      double q = 0;
      ASSERT_TRUE(predictor.predict(ahead, {&q, 1}, {}, {}));
      // Without derivatives a parabola through three instants is left, of error c3 (t - a)(t - b)(t - c).
      const double left_out = derivatives == 0 ? 0.4 * 1.6 * 1.1 * 0.1 : 0;
      EXPECT_NEAR(q, value(cubic, ahead), left_out * (1 + 1e-3) + 1e-6);
    }
  }
}

// Six instants without rates: of a motion that is smooth for the steps the error is that of order six, of one that is
// not that of order four, which is the smaller one then.
TEST(Predictor, TakesSixInstantsWhereThatIsBetter) {
  for (const double step : {0.1, 0.3, 1.3, 1.6}) {
    SCOPED_TRACE(step);
    Predictor predictor(3);
    std::array<double, 7> q{};
    for (std::size_t k = 0; k < q.size(); ++k) q[k] = std::sin(step * static_cast<double>(k) + 0.4);
    for (std::size_t k = 0; k + 1 < q.size(); ++k) {
      const std::array<double, 3> place{q[k], -q[k], 2 * q[k]};
      predictor.push(step * static_cast<double>(k), place, {}, {});
    }
    const double four = 4 * q[5] - 6 * q[4] + 4 * q[3] - q[2];
    const double six = 6 * q[5] - 15 * q[4] + 20 * q[3] - 15 * q[2] + 6 * q[1] - q[0];
    std::array<double, 3> found{};
    ASSERT_TRUE(predictor.predict(step * 6, found, {}, {}));
    const double expected = step < 1 ? six : four;
    EXPECT_NEAR(found[0], expected, 1e-12);
    EXPECT_NEAR(found[1], -expected, 1e-12);
    EXPECT_NEAR(found[2], 2 * expected, 1e-12);
    if (step < 1) {
      EXPECT_LT(std::abs(six - q[6]), 0.2 * std::abs(four - q[6]));
    } else {
      EXPECT_LT(std::abs(four - q[6]), std::abs(six - q[6]));
    }
  }
}

// Exact for polynomials of the fifth degree, at instants that are not equally far apart as well.
TEST(Predictor, OfSixInstantsIsExactForQuintics) {
  const auto quintic = [](double t) { return 0.2 + t * (1.1 + t * (-0.4 + t * (0.3 + t * (0.02 - t * 0.01)))); };
  Predictor predictor(1);
  for (const double t : {0.0, 0.13, 0.2, 0.31, 0.4, 0.55}) {
    const double q = quintic(t);
    predictor.push(t, {&q, 1}, {}, {});
  }
  double q = 0;
  ASSERT_TRUE(predictor.predict(0.7, {&q, 1}, {}, {}));
  EXPECT_NEAR(q, quintic(0.7), 1e-13);
}

TEST(Predictor, KnowsNothingAtFirst) {
  Predictor predictor(1);
  double q = 7;
  EXPECT_FALSE(predictor.predict(1, {&q, 1}, {}, {}));
  EXPECT_EQ(q, 7);
}

}  // namespace
}  // namespace catena::testing
