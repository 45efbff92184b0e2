// The derivative rules of Dual and Taylor, the harmonic function and the splines against 50-digit arithmetic: central
// differences with a step of 1e-12 are there exact to more digits than a double has.
#if __has_include(<boost/multiprecision/cpp_dec_float.hpp>)

#include <gtest/gtest.h>

#include <array>
#include <boost/multiprecision/cpp_dec_float.hpp>
#include <cmath>
#include <cstddef>
#include <vector>

#include "catena/base/dual.hpp"
#include "catena/base/spline.hpp"
#include "catena/base/taylor.hpp"
#include "catena/base/time_function.hpp"

namespace catena {
namespace {

using boost::multiprecision::cpp_dec_float;
// Without expression templates: `auto` in the functions under test is then a number.
using Exact = boost::multiprecision::number<cpp_dec_float<50>, boost::multiprecision::et_off>;
using Nested = Dual<Dual<double, 1>, 1>;

const Exact step("1e-12");

/// f, f', f'' of any function of one variable at the double x.
template <class F>
std::array<double, 3> exact_derivatives(const F& f, double x) {
  const Exact before = f(Exact(x) - step), at = f(Exact(x)), after = f(Exact(x) + step);
  return {static_cast<double>(at), static_cast<double>((after - before) / (2 * step)),
          static_cast<double>((after - 2 * at + before) / (step * step))};
}

/// Dual and Taylor must give them to a few units in the last place of the terms that make them up.
template <class F>
void expect_exact(const char* name, const F& f, std::initializer_list<double> places, double tolerance = 4e-15) {
  for (const double x : places) {
    SCOPED_TRACE(::testing::Message() << name << " at " << x);
    const std::array<double, 3> exact = exact_derivatives(f, x);
    const Nested dual = f(Nested(Dual<double, 1>(x, {1.0}), {Dual<double, 1>(1.0)}));
    const Taylor<double> taylor = f(Taylor<double>(x, 1.0, 0.0));
    for (const std::array<double, 3>& found :
         {std::array<double, 3>{dual.v.v, dual.d[0].v, dual.d[0].d[0]}, {taylor.f, taylor.d, taylor.dd}}) {
      for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(found[k], exact[k], tolerance * (1 + std::abs(exact[k]))) << k;
    }
    EXPECT_NEAR(dual.v.d[0], exact[1], tolerance * (1 + std::abs(exact[1])));
  }
}

/// The same for functions that Taylor does not have.
template <class F>
void expect_exact_dual(const char* name, const F& f, std::initializer_list<double> places, double tolerance = 4e-15) {
  for (const double x : places) {
    SCOPED_TRACE(::testing::Message() << name << " at " << x);
    const std::array<double, 3> exact = exact_derivatives(f, x);
    const Nested dual = f(Nested(Dual<double, 1>(x, {1.0}), {Dual<double, 1>(1.0)}));
    EXPECT_NEAR(dual.v.v, exact[0], tolerance * (1 + std::abs(exact[0])));
    EXPECT_NEAR(dual.d[0].v, exact[1], tolerance * (1 + std::abs(exact[1])));
    EXPECT_NEAR(dual.d[0].d[0], exact[2], tolerance * (1 + std::abs(exact[2])));
  }
}

TEST(HighPrecision, ElementaryFunctionsOfBothScalars) {
  using std::abs, std::atan2, std::cos, std::exp, std::log, std::sin, std::sqrt, std::tanh;
  expect_exact("sin", [](auto x) { return sin(x); }, {-7.0, -0.3, 0.0, 1.5, 3.2});
  expect_exact("cos", [](auto x) { return cos(x); }, {-7.0, -0.3, 0.0, 1.5, 3.2});
  expect_exact("exp", [](auto x) { return exp(x); }, {-5.0, 0.0, 1.0, 3.5});
  expect_exact("log", [](auto x) { return log(x); }, {0.25, 1.0, 7.0});
  expect_exact("sqrt", [](auto x) { return sqrt(x); }, {0.25, 1.0, 7.0});
  expect_exact("tanh", [](auto x) { return tanh(x); }, {-2.0, -0.1, 0.0, 0.6, 4.0});
  expect_exact("abs", [](auto x) { return abs(x * x * x); }, {-1.3, 0.7});
  expect_exact("atan2", [](auto x) { return atan2(x * x - decltype(x)(2.0), x + decltype(x)(0.25)); },
               {-3.0, -1.0, 0.5, 2.0});
  expect_exact("quotient", [](auto x) { return (x * x + decltype(x)(1.0)) / (x - decltype(x)(2.5)); },
               {-1.0, 0.0, 1.75, 4.0});
  expect_exact(
      "composite", [](auto x) { return sin(exp(x) * x) / sqrt(decltype(x)(1.0) + x * x) - x; }, {-1.0, 0.0, 1.25},
      4e-14);
}

TEST(HighPrecision, ElementaryFunctionsOfDualAlone) {
  using std::acos, std::asin, std::atan, std::pow, std::tan;
  expect_exact_dual("tan", [](auto x) { return tan(x); }, {-1.0, 0.0, 0.5, 2.5});
  expect_exact_dual("asin", [](auto x) { return asin(x); }, {-0.75, 0.0, 0.5});
  expect_exact_dual("acos", [](auto x) { return acos(x); }, {-0.75, 0.0, 0.5});
  expect_exact_dual("atan", [](auto x) { return atan(x); }, {-3.0, 0.0, 0.5});
  expect_exact_dual("constant exponent", [](auto x) { return pow(x, decltype(x)(2.5)); }, {0.5, 3.0});
  expect_exact_dual("negative base", [](auto x) { return pow(x, decltype(x)(3.0)); }, {-1.5, 0.5});
  expect_exact_dual("constant base", [](auto x) { return pow(decltype(x)(1.75), x); }, {-1.0, 0.0, 2.0});
  expect_exact_dual("both vary", [](auto x) { return pow(x, x - decltype(x)(1.0)); }, {0.5, 1.0, 2.0});
}

TEST(HighPrecision, Harmonic) {
  const double amplitude = 0.35, omega = 31.25, phase = -0.7, offset = 2.0;
  const TimeFunction<double> f = TimeFunction<double>::harmonic(amplitude, omega, phase, offset);
  const auto exact = [&](const Exact& t) { return Exact(offset + amplitude * sin(omega * t + phase)); };
  for (const double t : {0.0, 0.013, 1.0, 7.77}) {
    const std::array<double, 3> expected = exact_derivatives(exact, t);
    const Taylor<double> found = f.evaluate(t);
    // Rounding the angle, up to 243 rad, to a double costs 1.5e-14 of the amplitude.
    const double relative = 3e-14 * amplitude;
    EXPECT_NEAR(found.f, expected[0], relative + 4e-16);
    EXPECT_NEAR(found.d, expected[1], relative * omega);
    EXPECT_NEAR(found.dd, expected[2], relative * omega * omega);
  }
}

/// Second derivatives of a spline by elimination on the full matrix in 50 digits: h[k-1] M[k-1] + ... as in spline.hpp.
std::vector<Exact> exact_second_derivatives(const std::vector<double>& x, const std::vector<double>& y, SplineEnd end) {
  const std::size_t n = x.size() - 1;
  std::vector<std::vector<Exact>> a(n + 1, std::vector<Exact>(n + 2, Exact(0)));
  const auto h = [&](std::size_t k) { return Exact(x[k + 1]) - Exact(x[k]); };
  const auto chord = [&](std::size_t k) { return Exact((Exact(y[k + 1]) - Exact(y[k])) / h(k)); };
  for (std::size_t k = 1; k < n; ++k) {
    a[k][k - 1] = h(k - 1);
    a[k][k] = 2 * (h(k - 1) + h(k));
    a[k][k + 1] = h(k);
    a[k][n + 1] = 6 * (chord(k) - chord(k - 1));
  }
  if (end == SplineEnd::natural) {
    a[0][0] = a[n][n] = 1;
  } else if (end == SplineEnd::clamped) {
    a[0][0] = 2 * h(0), a[0][1] = h(0), a[0][n + 1] = 6 * chord(0);
    a[n][n] = 2 * h(n - 1), a[n][n - 1] = h(n - 1), a[n][n + 1] = -6 * chord(n - 1);
  } else {
    a[0][0] += 2 * (h(0) + h(n - 1)), a[0][1] += h(0), a[0][n - 1] += h(n - 1),
        a[0][n + 1] = 6 * (chord(0) - chord(n - 1));
    a[n][0] = 1, a[n][n] = -1;
  }
  for (std::size_t p = 0; p <= n; ++p) {
    std::size_t pivot = p;
    for (std::size_t i = p; i <= n; ++i) pivot = abs(a[i][p]) > abs(a[pivot][p]) ? i : pivot;
    std::swap(a[p], a[pivot]);
    for (std::size_t i = 0; i <= n; ++i) {
      if (i == p) continue;
      const Exact factor = a[i][p] / a[p][p];
      for (std::size_t j = p; j <= n + 1; ++j) a[i][j] -= factor * a[p][j];
    }
  }
  std::vector<Exact> m;
  for (std::size_t k = 0; k <= n; ++k) m.push_back(a[k][n + 1] / a[k][k]);
  return m;
}

TEST(HighPrecision, SplinesOfEveryEnd) {
  const std::vector<double> x = {-1.0, -0.75, 0.1, 0.2, 1.9, 2.0, 3.5}, y = {2.0, 1.5, -0.3, 0.4, 0.9, 0.8, 2.0};
  for (const std::size_t points : {std::size_t{3}, std::size_t{7}}) {
    std::vector<double> knots(x.begin(), x.begin() + static_cast<long>(points)),
        values(y.begin(), y.begin() + static_cast<long>(points));
    values.back() = values.front();
    for (const SplineEnd end : {SplineEnd::natural, SplineEnd::clamped, SplineEnd::periodic}) {
      SCOPED_TRACE(::testing::Message() << points << " points, end " << static_cast<int>(end));
      const std::vector<Exact> m = exact_second_derivatives(knots, values, end);
      const Spline<double> spline(knots, values, end);
      for (std::size_t k = 0; k + 1 < points; ++k) {
        const Exact h = Exact(knots[k + 1]) - knots[k];
        for (const double part : {0.0, 0.125, 0.5, 0.9}) {
          const double at = knots[k] + part * (knots[k + 1] - knots[k]);
          const Exact v = (Exact(at) - knots[k]) / h, u = 1 - v;
          const Exact value =
              u * values[k] + v * values[k + 1] + h * h / 6 * ((u * u * u - u) * m[k] + (v * v * v - v) * m[k + 1]);
          const Exact slope =
              (Exact(values[k + 1]) - values[k]) / h + h / 6 * ((3 * v * v - 1) * m[k + 1] - (3 * u * u - 1) * m[k]);
          const Exact second = u * m[k] + v * m[k + 1], third = (m[k + 1] - m[k]) / h;
          const SplineValue<double> found = spline.evaluate(at);
          // Values of order 1 over intervals of 0.1 and second derivatives up to 200: rounding in these proportions.
          EXPECT_NEAR(found.f, static_cast<double>(value), 1e-14);
          EXPECT_NEAR(found.d1, static_cast<double>(slope), 1e-13);
          EXPECT_NEAR(found.d2, static_cast<double>(second), 1e-12);
          EXPECT_NEAR(found.d3, static_cast<double>(third), 2e-11);
        }
      }
    }
  }
}

}  // namespace
}  // namespace catena

#endif
