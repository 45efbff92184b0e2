// Derivatives of buckling loads where laws of state act, against the roots of a quadratic, by complex steps.
//
//   F_u = -k u + s w + P (u + b w) - a u^3        F_w = -c w - r u + g P w        det(-dF/d(u, w)) = 0 at u = w = 0:
//
//   g P^2 - (c + g k - r b) P + k c + r s = 0
#include <gtest/gtest.h>

#include <array>
#include <complex>

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
         names + R"(], "of": {"type": "buckling", "parameter": "P", "count": 2, "measures": {
      "first": {"field": "loads[1]"}, "second": {"field": "loads[2]"}}}}]})";
}

TEST(LawBuckling, OfTwoWeightsThatALoadPushesAway) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    // r s < 0: both loads are real; the second differs from the first by more than its half.
    constexpr std::array<std::array<double, 2>, 7> range = {
        {{10, 20}, {0.5, 4}, {-0.05, 0.05}, {30, 50}, {-3, -0.5}, {0.6, 1.2}, {-2, 2}}};
    LawColumn column{};
    for (std::size_t p = 0; p < range.size(); ++p) column[p] = random(range[p][0], range[p][1]);
    const std::array<Complex, 2> loads = loads_of(column);
    const TextRun run = run_text(scene_of(column));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
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

}  // namespace
}  // namespace catena::testing
