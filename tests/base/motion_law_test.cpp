// Motion laws: from rest to rest over the unit rise, smooth where their pieces meet, with the peaks of the handbook.
#include "catena/base/motion_law.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "catena/base/time_function.hpp"

namespace catena {
namespace {

constexpr double pi = std::numbers::pi;

Taylor<double> value(MotionLaw law, double u, Side side = Side::after) {
  return TimeFunction<double>::law(law, 0, 1, 0, 1).evaluate(u, side);
}

class Laws : public ::testing::TestWithParam<MotionLaw> {};

TEST_P(Laws, GoFromRestToRest) {
  const Taylor<double> first = value(GetParam(), 0, Side::after), last = value(GetParam(), 1, Side::before);
  EXPECT_NEAR(first.f, 0, 1e-15);
  EXPECT_NEAR(first.d, 0, 1e-15);
  EXPECT_NEAR(first.dd, 0, 1e-14);
  EXPECT_NEAR(last.f, 1, 1e-15);
  EXPECT_NEAR(last.d, 0, 1e-14);
  EXPECT_NEAR(last.dd, 0, 1e-13);
  EXPECT_EQ(value(GetParam(), 2).f, 1);
}

TEST_P(Laws, AreSmoothWherePiecesMeet) {
  const auto law = TimeFunction<double>::law(GetParam(), 0, 1, 0, 1);
  for (const double u : law.breakpoints(0, 1)) {
    const Taylor<double> before = law.evaluate(u, Side::before), after = law.evaluate(u, Side::after);
    EXPECT_NEAR(before.f, after.f, 1e-15);
    EXPECT_NEAR(before.d, after.d, 1e-14);
    EXPECT_NEAR(before.dd, after.dd, 1e-13);
  }
}

// Simpson's rule on s'' gives s', on s' gives s: the derivatives belong together. Its error is h^5 / 2880 times the
// fifth derivative of s, at most 1.1e4 (modified sine: (4 pi)^5 / (4 (4 + pi))), and the sixth, at most 1.4e5.
TEST_P(Laws, IntegrateToThemselves) {
  for (double u = 0; u < 0.999; u += 1.0 / 64) {
    const double h = 1.0 / 64;
    const Taylor<double> a = value(GetParam(), u, Side::after), m = value(GetParam(), u + h / 2),
                         b = value(GetParam(), u + h, Side::before);
    EXPECT_NEAR(b.d - a.d, h / 6 * (a.dd + 4 * m.dd + b.dd), h * h * h * h * h / 2880 * 1.4e5 + 1e-14);
    EXPECT_NEAR(b.f - a.f, h / 6 * (a.d + 4 * m.d + b.d), h * h * h * h * h / 2880 * 1.1e4 + 1e-15);
  }
}

TEST_P(Laws, AreSymmetric) {
  for (double u = 0.01; u < 0.5; u += 0.0137)
    EXPECT_NEAR(value(GetParam(), u).f + value(GetParam(), 1 - u).f, 1, 1e-14);
}

INSTANTIATE_TEST_SUITE_P(All, Laws,
                         ::testing::Values(MotionLaw::cycloidal, MotionLaw::poly345, MotionLaw::poly4567,
                                           MotionLaw::modified_trapezoid, MotionLaw::modified_sine));

TEST(MotionLaws, HaveThePeaksOfTheHandbook) {
  const auto peak = [](MotionLaw law) {
    double most = 0;
    for (double u = 0; u <= 1; u += 1e-4) most = std::max(most, std::abs(value(law, u).dd));
    return most;
  };
  EXPECT_NEAR(peak(MotionLaw::cycloidal), 2 * pi, 1e-6);
  EXPECT_NEAR(peak(MotionLaw::poly345), 10 / std::sqrt(3.0), 1e-6);
  EXPECT_NEAR(peak(MotionLaw::poly4567), 7.5132, 1e-4);
  EXPECT_NEAR(peak(MotionLaw::modified_trapezoid), 8 * pi / (2 + pi), 1e-12);
  EXPECT_NEAR(peak(MotionLaw::modified_sine), 4 * pi * pi / (4 + pi), 1e-6);
}

TEST(MotionLaws, ScaleAndShift) {
  const auto law = TimeFunction<double>::law(MotionLaw::cycloidal, 2, 6, 1, -3);
  EXPECT_EQ(law.evaluate(1).f, 1);
  EXPECT_NEAR(law.evaluate(4).f, -1, 1e-15);
  EXPECT_NEAR(law.evaluate(4).d, -4 * 2 / 4.0, 1e-15);
  EXPECT_EQ(law.evaluate(7).f, -3);
  EXPECT_THROW(TimeFunction<double>::law(MotionLaw::poly345, 1, 1, 0, 1), std::invalid_argument);
}

}  // namespace
}  // namespace catena
