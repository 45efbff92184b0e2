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

TEST(Predictor, KnowsNothingAtFirst) {
  Predictor predictor(1);
  double q = 7;
  EXPECT_FALSE(predictor.predict(1, {&q, 1}, {}, {}));
  EXPECT_EQ(q, 7);
}

}  // namespace
}  // namespace catena::testing
