// Functions of time made from design parameters: their derivatives with respect to these, and the data that define no
// function.
#include <gtest/gtest.h>

#include <cmath>
#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include "catena/base/time_function.hpp"

namespace catena {
namespace {

using F = TimeFunction<double>;
using D = Dual<double, 4>;
using FD = TimeFunction<D>;
using Table = std::vector<double>;

F table(const Table& t, const Table& value, SplineEnd end) { return F::spline(t, value, end); }

template <class Make>
std::string refusal(const Make& make) {
  try {
    make();
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

/// Derivatives with respect to four design parameters against central differences of functions of plain numbers.
template <class MakeDual, class MakePlain>
void expect_design_derivatives(const MakeDual& dual, const MakePlain& plain, const std::vector<double>& p) {
  std::vector<D> parameters;
  for (std::size_t k = 0; k < 4; ++k) parameters.push_back(D::variable(p[k], static_cast<int>(k)));
  const FD f = dual(parameters);
  const double h = 1e-5;
  for (const double t : {0.11, 0.77, 1.37, 1.9}) {
    const Taylor<D> found = f.evaluate(t);
    for (std::size_t k = 0; k < 4; ++k) {
      SCOPED_TRACE(::testing::Message() << "parameter " << k << " at " << t);
      std::vector<double> more = p, less = p;
      more[k] += h;
      less[k] -= h;
      const Taylor<double> difference = (plain(more).evaluate(t) - plain(less).evaluate(t)) / Taylor<double>(2 * h);
      EXPECT_NEAR(found.f.d[k], difference.f, 1e-7);
      EXPECT_NEAR(found.d.d[k], difference.d, 1e-6);
      EXPECT_NEAR(found.dd.d[k], difference.dd, 1e-5);
    }
    const Taylor<double> value = plain(p).evaluate(t);
    EXPECT_NEAR(found.f.v, value.f, 1e-13 * (1 + std::abs(value.f)));
    EXPECT_NEAR(found.d.v, value.d, 1e-13 * (1 + std::abs(value.d)));
    EXPECT_NEAR(found.dd.v, value.dd, 1e-13 * (1 + std::abs(value.dd)));
  }
}

TEST(TimeFunctionDesign, DesignDerivatives) {
  expect_design_derivatives([](const std::vector<D>& p) { return FD::polynomial(p); },
                            [](const Table& p) { return F::polynomial(p); }, {1, -2, 0.5, 0.25});
  expect_design_derivatives([](const std::vector<D>& p) { return FD::harmonic(p[0], p[1], p[2], p[3]); },
                            [](const Table& p) { return F::harmonic(p[0], p[1], p[2], p[3]); }, {1.5, 2, 0.25, 0.5});
  for (const int order : {3, 5}) {
    expect_design_derivatives([&](const std::vector<D>& p) { return FD::step(p[0], p[1], p[2], p[3], order); },
                              [&](const Table& p) { return F::step(p[0], p[1], p[2], p[3], order); },
                              {0.2, 1.6, -1, 3});
  }
  for (const SplineEnd end : {SplineEnd::natural, SplineEnd::clamped, SplineEnd::periodic}) {
    expect_design_derivatives(
        [&](const std::vector<D>& p) {
          const std::vector<D> t = {0, 0.5 + p[0], 1.2, 2.0 + p[1]}, value = {1.0, p[2], p[3], 1.0};
          return FD::spline(t, value, end);
        },
        [&](const Table& p) {
          return table({0, 0.5 + p[0], 1.2, 2.0 + p[1]}, {1, p[2], p[3], 1}, end);
        },
        {0, 0, 2, -1});
  }
  expect_design_derivatives(
      [](const std::vector<D>& p) {
        return FD::product({FD::harmonic(p[0], p[1]), FD::sum({FD(p[2]), FD::step(0.0, p[3], 0.0, 1.0, 5)})});
      },
      [](const Table& p) {
        return F::product({F::harmonic(p[0], p[1]), F::sum({F(p[2]), F::step(0, p[3], 0, 1, 5)})});
      },
      {1.5, 2, 0.25, 2.5});
}

TEST(TimeFunctionDesign, CallbacksHaveNoDesignDerivatives) {
  const FD f = FD::custom([](double t) { return Taylor<double>(t * t, 2 * t, 2); });
  const Taylor<D> at = f.evaluate(3);
  EXPECT_EQ(at.f.v, 9);
  EXPECT_EQ(at.d.v, 6);
  EXPECT_EQ(at.dd.v, 2);
  EXPECT_EQ(at.f.d[0], 0);
}

TEST(TimeFunctionDesign, RefusesWhatIsNoFunction) {
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::nan("");
  EXPECT_EQ(refusal([] { return F::step(1, 1, 0, 1, 3); }), "step: t1 = 1 must be later than t0 = 1");
  EXPECT_EQ(refusal([] { return F::step(2, 1.5, 0, 1, 3); }), "step: t1 = 1.5 must be later than t0 = 2");
  EXPECT_EQ(refusal([] { return F::step(0, 1, 0, 1, 4); }), "step: order must be 3 or 5, is 4");
  EXPECT_EQ(refusal([&] { return F::step(0, infinity, 0, 1, 5); }), "step: t1 is not finite");
  EXPECT_EQ(refusal([&] { return F::harmonic(1, nan); }), "harmonic: omega is not finite");
  EXPECT_EQ(refusal([&] { return F::polynomial(Table{1, nan}); }), "polynomial: coefficient[1] is not finite");
  EXPECT_EQ(refusal([] {
              return table({0, 1, 1}, {0, 1, 2}, SplineEnd::natural);
            }),
            "spline: knots must increase, but knot[2] = 1 follows 1");
  EXPECT_EQ(refusal([] {
              return table({0, 1}, {0, 1}, SplineEnd::periodic);
            }),
            "spline: periodic, but it starts at 0 and ends at 1");
  EXPECT_EQ(refusal([] { return F::sum({}); }), "sum: needs at least one term");
  EXPECT_EQ(refusal([] { return F::product({}); }), "product: needs at least one factor");
  EXPECT_EQ(refusal([] { return F::custom({}); }), "custom function of time: the callback is empty");
  EXPECT_EQ(refusal([] {
              return F::custom([](double) { return Taylor<double>(); }, {1, 0});
            }),
            "custom function of time: breakpoints must increase");
}

}  // namespace
}  // namespace catena
