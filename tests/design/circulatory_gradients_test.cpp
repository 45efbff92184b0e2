// Derivatives of frequencies, and of the loads of divergence and of flutter, under a force that turns with its body:
// Ziegler's column of two rods against the roots of its 2 x 2 problem, differenced in long double.
//
//   M = L^2 [m + n, n; n, n]    K = [k + c - P L + g L (m + n), P L - c; -c, c + g L n]    angles of both rods
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "design/measured.hpp"
#include "oracles/scene_text.hpp"

namespace catena::testing {
namespace {

using Long = long double;
constexpr std::array<const char*, 7> column_parameters = {"L", "m", "n", "k", "c", "g", "P"};
using ZieglerColumn = std::array<Long, 7>;

/// Both omega2, the lesser first.
std::array<Long, 2> roots_of(const ZieglerColumn& column) {
  const auto& [L, m, n, k, c, g, P] = column;
  const Long k11 = k + c - P * L + g * L * (m + n), k12 = P * L - c, k21 = -c, k22 = c + g * L * n;
  const Long m11 = L * L * (m + n), m12 = L * L * n, m22 = m12;
  const Long a = m11 * m22 - m12 * m12, b = k11 * m22 + k22 * m11 - (k12 + k21) * m12, d = k11 * k22 - k12 * k21;
  const Long half = std::sqrt(b * b - 4 * a * d);
  return {(b - half) / (2 * a), (b + half) / (2 * a)};
}

/// P at which K is singular: without weights nothing but flutter ends the stability of the column.
std::array<Long, 1> load_of(const ZieglerColumn& column) {
  const auto& [L, m, n, k, c, g, P] = column;
  return {((k + c + g * L * (m + n)) * (c + g * L * n) - c * c) / (L * L * g * n)};
}

/// The lesser P at which both omega2 are one: where b^2 - 4 a d = 0 in roots_of().
std::array<Long, 1> flutter_of(const ZieglerColumn& column) {
  const auto& [L, m, n, k, c, g, P] = column;
  const Long m11 = L * L * (m + n), m12 = L * L * n, a = m11 * m12 - m12 * m12, k22 = c + g * L * n;
  // b = b0 + b1 P, d = d0 + d1 P
  const Long k0 = k + c + g * L * (m + n), b0 = k0 * m12 + k22 * m11 + 2 * c * m12, b1 = -2 * L * m12;
  const Long d0 = k0 * k22 - c * c, d1 = -L * k22 + L * c;
  const Long half = b0 * b1 - 2 * a * d1, root = std::sqrt(half * half - b1 * b1 * (b0 * b0 - 4 * a * d0));
  return {(-half - root) / (b1 * b1)};
}

template <std::size_t count>
std::array<Long, count> slope_of(std::array<Long, count> (*values_of)(const ZieglerColumn&),
                                 const ZieglerColumn& column, std::size_t p) {
  const Long h = 1e-4L * column[p];
  const auto moved = [&](Long by) {
    ZieglerColumn other = column;
    other[p] += by;
    return values_of(other);
  };
  const auto far_below = moved(-2 * h), below = moved(-h), above = moved(h), far_above = moved(2 * h);
  std::array<Long, count> slope{};
  for (std::size_t i = 0; i < count; ++i)
    slope[i] = (8 * (above[i] - below[i]) - (far_above[i] - far_below[i])) / (12 * h);
  return slope;
}

constexpr const char* modes = R"("type": "modes", "measures": {
    "low": {"field": "omega2[1]"}, "high": {"field": "omega2[2]"}, "omega": {"field": "omega[1]"}})";
constexpr const char* buckling = R"("type": "buckling", "parameter": "P", "count": 3, "measures": {
    "load": {"field": "loads[1]"}})";
constexpr const char* flutter = R"("type": "buckling", "parameter": "P", "count": 2, "measures": {
    "load": {"field": "flutter[1]"}})";

std::string scene_of(const ZieglerColumn& column, const char* analysis = modes) {
  std::string numbers, names;
  for (std::size_t p = 0; p < column.size(); ++p) {
    numbers +=
        (p > 0 ? ", \"" : "\"") + std::string(column_parameters[p]) + "\": " + text_of(static_cast<double>(column[p]));
    names += (p > 0 ? ", \"" : "\"") + std::string(column_parameters[p]) + "\"";
  }
  return R"({"catena": 1, "gravity": ["g", 0], "parameters": {)" + numbers + R"(},
  "bodies": {"one": {"mass": "m", "inertia": 0, "position": ["L", 0], "points": {"pin": ["=-L", 0]}},
             "two": {"mass": "n", "inertia": 0, "position": ["=2*L", 0], "points": {"pin": ["=-L", 0]}}},
  "constraints": [{"type": "revolute", "i": "ground", "j": "one.pin"}, {"type": "revolute", "i": "one", "j": "two.pin"}],
  "forces": [{"type": "torsion_spring", "i": "ground", "j": "one", "k": "k"},
             {"type": "torsion_spring", "i": "one", "j": "two", "k": "c"},
             {"type": "point_force", "i": "two", "force": ["=-P", 0], "frame": "body"}],
  "analyses": [{"type": "sensitivity", "parameters": [)" +
         names + R"(], "of": {)" + analysis + "}}]}";
}

/// All but the load; g between these.
ZieglerColumn random_column(RandomNumbers& random, double least_g, double most_g) {
  const std::array<std::array<double, 2>, 6> range = {
      {{0.5, 2}, {0.5, 3}, {0.5, 3}, {5, 30}, {5, 30}, {least_g, most_g}}};
  ZieglerColumn column{};
  for (std::size_t p = 0; p < range.size(); ++p) column[p] = random(range[p][0], range[p][1]);
  return column;
}

TEST(CirculatoryGradients, OfZieglersColumn) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    ZieglerColumn column = random_column(random, 0, 3);
    column[6] = random(0.1, 0.6) * static_cast<double>(std::min(column[3], column[4]) / column[0]);
    const TextRun run = run_text(scene_of(column));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const std::array<Long, 2> roots = roots_of(column);
    const std::array<const char*, 2> names = {"low", "high"};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto root = static_cast<double>(roots[i]);
      EXPECT_NEAR(value(run, names[i]), root, 1e-11 * root);
      for (std::size_t p = 0; p < column.size(); ++p) {
        const auto exact = static_cast<double>(slope_of(roots_of, column, p)[i]);
        const double size = std::max(std::abs(exact), root / static_cast<double>(column[p]));
        EXPECT_NEAR(gradient(run, names[i], p), exact, 1e-10 * size) << names[i] << " " << column_parameters[p];
        if (i == 0) {
          EXPECT_NEAR(gradient(run, "omega", p), exact / (2 * std::sqrt(root)), 1e-10 * size);
        }
      }
    }
  }
}

TEST(CirculatoryGradients, OfALoadOfDivergence) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    ZieglerColumn column = random_column(random, 5, 30);
    column[6] = 0.1L;
    const TextRun run = run_text(scene_of(column, buckling));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const auto load = static_cast<double>(load_of(column)[0]);
    EXPECT_NEAR(value(run, "load"), load, 1e-9 * load);
    for (std::size_t p = 0; p < column.size(); ++p) {
      const auto exact = static_cast<double>(slope_of(load_of, column, p)[0]);
      EXPECT_NEAR(gradient(run, "load", p), exact, 1e-8 * load / static_cast<double>(column[p]))
          << column_parameters[p];
    }
  }
}

TEST(CirculatoryGradients, OfALoadOfFlutter) {
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    ZieglerColumn column = random_column(random, 0, 1);
    column[6] = 0.1L;
    const TextRun run = run_text(scene_of(column, flutter));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text << run.analysis().report.message;
    const auto load = static_cast<double>(flutter_of(column)[0]);
    EXPECT_NEAR(value(run, "load"), load, 1e-9 * load);
    for (std::size_t p = 0; p < column.size(); ++p) {
      const auto exact = static_cast<double>(slope_of(flutter_of, column, p)[0]);
      EXPECT_NEAR(gradient(run, "load", p), exact, 1e-8 * load / static_cast<double>(column[p]))
          << column_parameters[p];
    }
  }
}

/// Of the pair omega2 +- i b: omega2, b, and growth + i omega, whose square is -(omega2 - i b); zeros where both are
/// real.
std::array<Long, 4> pair_of(const ZieglerColumn& column) {
  const auto& [L, m, n, k, c, g, P] = column;
  const Long m11 = L * L * (m + n), m12 = L * L * n, a = m11 * m12 - m12 * m12, k22 = c + g * L * n;
  const Long k11 = k + c - P * L + g * L * (m + n), k12 = P * L - c;
  const Long b = k11 * m12 + k22 * m11 - (k12 - c) * m12, d = k11 * k22 + k12 * c;
  if (b * b >= 4 * a * d) return {};
  const Long omega2 = b / (2 * a), imaginary = std::sqrt(4 * a * d - b * b) / (2 * a);
  const Long size = std::hypot(omega2, imaginary);
  return {omega2, -imaginary, std::sqrt((size - omega2) / 2), std::sqrt((size + omega2) / 2)};
}

constexpr const char* pairs = R"("type": "modes", "measures": {"square": {"field": "omega2[1]"},
    "b": {"field": "omega2_imaginary[1]"}, "rise": {"field": "growth[1]"}, "pace": {"field": "omega[1]"},
    "square_other": {"field": "omega2[2]"}, "b_other": {"field": "omega2_imaginary[2]"}})";

TEST(CirculatoryGradients, OfPairsThatFlutter) {
  int compared = 0;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    SCOPED_TRACE(seed);
    RandomNumbers random(seed);
    ZieglerColumn column = random_column(random, 0, 1);
    // As the scene has it, in double precision.
    column[6] = static_cast<double>(flutter_of(column)[0] * random(1.1, 1.5));
    const std::array<Long, 4> exact = pair_of(column);
    if (!(-exact[1] > 0.1L * std::abs(exact[0]))) continue;
    const TextRun run = run_text(scene_of(column, pairs));
    ASSERT_EQ(run.outcome.exit_code, 0) << run.outcome.error_text;
    const std::array<const char*, 4> names = {"square", "b", "rise", "pace"};
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto size = static_cast<double>(i < 2 ? std::hypot(exact[0], exact[1]) : std::hypot(exact[2], exact[3]));
      EXPECT_NEAR(value(run, names[i]), static_cast<double>(exact[i]), 1e-11 * size) << names[i];
      for (std::size_t p = 0; p < column.size(); ++p) {
        const auto slope = static_cast<double>(slope_of(pair_of, column, p)[i]);
        const double unit = std::max(std::abs(slope), size / static_cast<double>(column[p]));
        EXPECT_NEAR(gradient(run, names[i], p), slope, 1e-10 * unit) << names[i] << " " << column_parameters[p];
        ++compared;
        if (i > 1) continue;
        const double other = gradient(run, std::string(names[i]) + "_other", p);
        EXPECT_NEAR(other, i == 0 ? slope : -slope, 1e-10 * unit);
      }
    }
  }
  EXPECT_GT(compared, 100);
}

}  // namespace
}  // namespace catena::testing
