// Derivatives of buckling loads where laws of state act, against the roots of a quadratic, by complex steps.
//
//   F_u = -k u + s w + P (u + b w) - a u^3        F_w = -c w - r u + g P w        det(-dF/d(u, w)) = 0 at u = w = 0:
//
//   g P^2 - (c + g k - r b) P + k c + r s = 0
//
// Flutter sets in where omega2 meet: (k - c - (1 - g) P)^2 = 4 r (s + b P), r < 0, so for s + b P < 0 alone. `count`
// is that of both kinds, nearest first.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <vector>

#include "design/measured.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

using Complex = std::complex<double>;
using LawColumn = std::array<Complex, 7>;
constexpr std::array<const char*, 7> column_parameters = {"k", "s", "b", "c", "r", "g", "a"};

/// Both loads, the lesser first.
std::array<Complex, 2> loads_of(const LawColumn& column) {
  const auto& [k, s, b, c, r, g, a] = column;
  const Complex half = (c + g * k - r * b) / (2.0 * g), root = std::sqrt(half * half - (k * c + r * s) / g);
  return {half - root, half + root};
}

/// Loads at which omega2 meet above zero, as the load goes away from 1; nearest first.
std::vector<double> flutter_of(const LawColumn& column) {
  const auto real = [&](std::size_t p) { return column[p].real(); };
  const double k = real(0), s = real(1), b = real(2), c = real(3), r = real(4), g = real(5), u = 1 - g;
  // u^2 P^2 - 2 (u (k - c) + 2 r b) P + (k - c)^2 - 4 r s
  const double half = (u * (k - c) + 2 * r * b) / (u * u), rest = ((k - c) * (k - c) - 4 * r * s) / (u * u);
  std::vector<double> loads;
  for (const double sign : {-1.0, 1.0}) {
    const double load = half + sign * std::sqrt(std::max(half * half - rest, 0.0));
    // Between the roots the values are a pair.
    const bool sets_in = (load > 1) == (sign < 0);
    if (half * half > rest && sets_in && k + c - (1 + g) * load > 0) loads.push_back(load);
  }
  std::sort(loads.begin(), loads.end(), [](double x, double y) { return std::abs(x - 1) < std::abs(y - 1); });
  return loads;
}

std::string scene_of(const LawColumn& column) {
  std::string numbers, names;
  for (std::size_t p = 0; p < column.size(); ++p) {
    numbers += ", \"" + std::string(column_parameters[p]) + "\": " + text_of(column[p].real());
    names += (p > 0 ? ", \"" : "\"") + std::string(column_parameters[p]) + "\"";
  }
  const std::string particle = R"({"mass": 1, "particle": true, "position": [0, 0]})";
  return R"({"catena": 1, "parameters": {"P": 1)" + numbers + R"(}, "bodies": {"u": )" + particle + R"(, "w": )" +
         particle + R"(}, "constraints": [{"type": "absolute_y", "i": "u", "value": 0},
      {"type": "absolute_y", "i": "w", "value": 0}],
    "forces": [{"type": "point_force", "i": "u", "force": ["=-k*u.x + s*w.x + P*(u.x + b*w.x) - a*u.x^3", 0]},
               {"type": "point_force", "i": "w", "force": ["=-c*w.x - r*u.x + g*P*w.x", 0]}],
    "analyses": [{"type": "sensitivity", "parameters": [)" +
         names + R"(], "of": {"type": "buckling", "parameter": "P", "count": 4, "measures": {
      "first": {"field": "loads[1]"}, "second": {"field": "loads[2]"}}}}]})";
}

TEST(LawBuckling, OfTwoWeightsThatALoadPushesAway) {
  for (unsigned seed = 1; seed <= 60; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    // r s < 0: both loads are real; the second differs from the first by more than its half.
    constexpr std::array<std::array<double, 2>, 7> range = {
        {{10, 20}, {0.5, 4}, {-0.05, 0.05}, {40, 80}, {-3, -0.5}, {0.5, 1.2}, {-2, 2}}};
    LawColumn column{};
    for (std::size_t p = 0; p < range.size(); ++p) column[p] = random(range[p][0], range[p][1]);
    const std::array<Complex, 2> loads = loads_of(column);
    const TextRun run = run_text(scene_of(column));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const std::vector<double> flutter = flutter_of(column), found = field<std::vector<double>>(run, "flutter");
    ASSERT_EQ(found.size(), flutter.size());
    for (std::size_t i = 0; i < flutter.size(); ++i) EXPECT_NEAR(found[i], flutter[i], 1e-8 * std::abs(flutter[i]));
    const std::array<const char*, 2> names = {"first", "second"};
    for (std::size_t i = 0; i < 2; ++i) {
      EXPECT_NEAR(value(run, names[i]), loads[i].real(), 1e-10 * loads[i].real()) << names[i];
      for (std::size_t p = 0; p < column.size(); ++p) {
        LawColumn beside = column;
        beside[p] += Complex(0, 1e-30);
        const double slope = loads_of(beside)[i].imag() / 1e-30;
        EXPECT_NEAR(gradient(run, names[i], p), slope, 1e-10 * std::max(std::abs(slope), loads[i].real()))
            << names[i] << " " << column_parameters[p];
      }
    }
  }
}

// Two weights alone, whose loads are k and c: as far apart, and from the given one, as they may be, on both sides.
TEST(LawBuckling, LoadsFarFromTheGivenOne) {
  for (const double unit : {1e-6, 1.0, 1e6}) {
    for (const double sign : {1.0, -1.0}) {
      for (const double apart : {2.0, 1e2, 1e4, 1e6}) {
        const double k = sign * unit, c = k * apart;
        SCOPED_TRACE(::testing::Message() << k << " " << c);
        const std::string particle = R"({"mass": 1, "particle": true, "position": [0, 0]})";
        const auto force = [sign](const std::string& body, double load) {
          const std::string stiffness = "(-" + text_of(load) + (sign > 0 ? " + P" : " - P") + ")";
          return R"({"type": "point_force", "i": ")" + body + R"(", "force": ["=)" + stiffness + "*" + body +
                 R"(.x", 0]})";
        };
        const TextRun run = run_text(R"({"catena": 1, "parameters": {"P": 0.1}, "bodies": {"u": )" + particle +
                                     R"(, "w": )" + particle +
                                     R"(}, "constraints": [{"type": "absolute_y", "i": "u", "value": 0},
              {"type": "absolute_y", "i": "w", "value": 0}], "forces": [)" +
                                     force("u", unit) + ", " + force("w", unit * apart) +
                                     R"(], "analyses": [{"type": "buckling", "parameter": "P", "count": 2}]})");
        if (unit < 1) {
          // Pushed beyond its load already.
          EXPECT_EQ(run.analysis().report.ok(), sign < 0);
          if (sign > 0) continue;
        }
        ASSERT_TRUE(run.analysis().report.ok()) << run.analysis().report.message;
        const auto loads = field<std::vector<double>>(run, "loads");
        // Beyond what is searched there is a warning that says how far that is.
        ASSERT_GE(loads.size(), apart <= 1e2 ? 2u : 1u);
        EXPECT_NEAR(loads[0], k, 1e-9 * std::max(0.1, std::abs(k)));
        EXPECT_EQ(warns(run, "there are only 1 such values within"), loads.size() == 1);
        if (loads.size() == 1) continue;
        EXPECT_NEAR(loads[1], c, 1e-9 * std::max(0.1, std::abs(c)));
      }
    }
  }
}

}  // namespace
}  // namespace catena::testing
