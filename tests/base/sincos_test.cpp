// The vectorised sine and cosine: accuracy against long double, sameness of bits wherever an angle stands, and the
// angles that are special.
#include "catena/base/sincos.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <random>
#include <string_view>
#include <vector>

namespace catena {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

struct Errors {
  double absolute = 0, units = 0;  // units in the last place of the exact value
};

Errors errors(const std::vector<double>& angles) {
  std::vector<double> c(angles.size()), s(angles.size());
  sincos(angles, c, s);
  Errors worst;
  const auto compare = [&](double found, long double exact) {
    const auto error = static_cast<double>(std::abs(static_cast<long double>(found) - exact));
    const double size = std::abs(static_cast<double>(exact));
    worst.absolute = std::max(worst.absolute, error);
    worst.units = std::max(worst.units, error / (std::nextafter(size, infinity) - size));
  };
  for (std::size_t k = 0; k < angles.size(); ++k) {
    compare(c[k], std::cos(static_cast<long double>(angles[k])));
    compare(s[k], std::sin(static_cast<long double>(angles[k])));
  }
  return worst;
}

std::vector<double> random_angles(double largest, std::size_t count) {
  std::mt19937_64 generator(7);
  std::uniform_real_distribution<double> distribution(-largest, largest);
  std::vector<double> angles(count);
  for (double& a : angles) a = distribution(generator);
  return angles;
}

bool same_bits(double a, double b) {
  return __builtin_bit_cast(std::uint64_t, a) == __builtin_bit_cast(std::uint64_t, b);
}

/// Runs a test body with every instruction set of this machine.
template <class Body>
void with_each_instruction_set(const Body& body) {
  const std::string_view usual = sincos_instruction_set();
  for (const std::string_view name : {"avx512", "avx2", "baseline"}) {
    if (!select_sincos_instruction_set(name)) continue;
    SCOPED_TRACE(name);
    EXPECT_EQ(sincos_instruction_set(), name);
    body();
  }
  EXPECT_TRUE(select_sincos_instruction_set(usual));
}

TEST(Sincos, AccurateAtAllSizesOfAngle) {
  for (const double largest : {0.8, 3.2, 100.0, 1e5, 1e8, 1e300}) {
    with_each_instruction_set([&] {
      const Errors worst = errors(random_angles(largest, 20000));
      EXPECT_LT(worst.absolute, 1e-16) << largest;
      EXPECT_LT(worst.units, 1.0) << largest;
    });
  }
}

TEST(Sincos, AccurateNextToMultiplesOfARightAngle) {
  std::vector<double> angles;
  for (int k = -63600; k <= 63600; k += k > -100 && k < 100 ? 1 : 53) {
    double below = k * (std::numbers::pi / 2), above = below;
    for (int step = 0; step < 3; ++step) {
      angles.insert(angles.end(), {below, above});
      below = std::nextafter(below, -infinity);
      above = std::nextafter(above, infinity);
    }
  }
  with_each_instruction_set([&] { EXPECT_LT(errors(angles).units, 1.0); });
}

TEST(Sincos, AccurateWhereTheMethodChanges) {
  std::vector<double> angles;
  for (const double edge : {1e5, std::numbers::pi / 4, 3 * std::numbers::pi / 4}) {
    for (const double a : {std::nextafter(edge, 0.0), edge, std::nextafter(edge, infinity)}) {
      angles.insert(angles.end(), {a, -a});
    }
  }
  with_each_instruction_set([&] { EXPECT_LT(errors(angles).units, 1.0); });
}

TEST(Sincos, TinyAnglesAreTheirOwnSine) {
  const std::vector<double> angles = {0.0, 5e-324, -5e-324, 1e-310, std::numeric_limits<double>::min(), -1e-20, 1e-9};
  std::vector<double> c(angles.size()), s(angles.size());
  sincos(angles, c, s);
  for (std::size_t k = 0; k < angles.size(); ++k) {
    EXPECT_EQ(s[k], angles[k]);
    EXPECT_EQ(c[k], 1.0);
  }
}

TEST(Sincos, WhatIsNoAngleGivesNaNAndSpoilsNothingElse) {
  std::vector<double> angles(40, 0.5);
  angles[3] = std::numeric_limits<double>::quiet_NaN();
  angles[11] = infinity;
  angles[12] = -infinity;
  angles[20] = 1e17;
  std::vector<double> c(40), s(40);
  sincos(angles, c, s);
  for (std::size_t k = 0; k < angles.size(); ++k) {
    if (k == 3 || k == 11 || k == 12) {
      EXPECT_TRUE(std::isnan(c[k]) && std::isnan(s[k])) << k;
    } else if (k != 20) {
      EXPECT_TRUE(same_bits(c[k], c[0]) && same_bits(s[k], s[0])) << k;
    }
  }
  EXPECT_EQ(c[20], std::cos(1e17));
  EXPECT_EQ(s[20], std::sin(1e17));
}

TEST(Sincos, SameBitsWhereverTheAngleStands) {
  std::vector<double> angles = random_angles(50, 300);
  angles[77] = 3e6;  // sends its block through the slow path as well
  std::vector<double> c(angles.size()), s(angles.size());
  with_each_instruction_set([&] {
    sincos(angles, c, s);
    for (std::size_t k = 0; k < angles.size(); ++k) {
      double alone_c = 0, alone_s = 0;
      sincos(&angles[k], 1, 1, &alone_c, &alone_s);
      EXPECT_TRUE(same_bits(alone_c, c[k]) && same_bits(alone_s, s[k])) << k;
    }
  });
}

TEST(Sincos, InstructionSetsThatFuseGiveTheSameBits) {
  const std::vector<double> angles = random_angles(1000, 5000);
  std::vector<double> c(angles.size()), s(angles.size()), other_c(angles.size()), other_s(angles.size());
  sincos(angles, c, s);
  with_each_instruction_set([&] {
    sincos(angles, other_c, other_s);
    for (std::size_t k = 0; k < angles.size(); ++k) {
      if (sincos_instruction_set() == "baseline") {
        EXPECT_NEAR(c[k], other_c[k], 1.2e-16);
        EXPECT_NEAR(s[k], other_s[k], 1.2e-16);
      } else {
        EXPECT_TRUE(same_bits(c[k], other_c[k]) && same_bits(s[k], other_s[k])) << angles[k];
      }
    }
  });
  EXPECT_FALSE(select_sincos_instruction_set("no such set"));
}

TEST(Sincos, SymmetricToTheLastBit) {
  const std::vector<double> angles = random_angles(1000, 1000);
  std::vector<double> mirrored = angles, c(1000), s(1000), mirrored_c(1000), mirrored_s(1000);
  for (double& a : mirrored) a = -a;
  sincos(angles, c, s);
  sincos(mirrored, mirrored_c, mirrored_s);
  for (std::size_t k = 0; k < angles.size(); ++k) {
    EXPECT_TRUE(same_bits(c[k], mirrored_c[k]) && same_bits(s[k], -mirrored_s[k])) << angles[k];
  }
}

TEST(Sincos, InPlace) {
  std::vector<double> angles = random_angles(5, 200), c(200), s(200), sine(200);
  sincos(angles, c, s);
  sincos(angles, angles, sine);
  EXPECT_EQ(angles, c);
  EXPECT_EQ(sine, s);
}

TEST(Sincos, FramesOfEveryCount) {
  for (const std::size_t count : {1, 2, 7, 8, 9, 127, 128, 129, 1000}) {
    const std::vector<double> q = random_angles(20, 3 * count);
    std::vector<Frame<double>> frames(count + 1);
    frames.back().x = 123;
    update_frames(q, {frames.data(), count});
    std::vector<double> c(count), s(count);
    sincos(q.data() + 2, 3, count, c.data(), s.data());
    for (std::size_t b = 0; b < count; ++b) {
      EXPECT_EQ(frames[b].x, q[3 * b]);
      EXPECT_EQ(frames[b].y, q[3 * b + 1]);
      EXPECT_EQ(frames[b].phi, q[3 * b + 2]);
      EXPECT_TRUE(same_bits(frames[b].c, c[b]) && same_bits(frames[b].s, s[b])) << b;
      EXPECT_NEAR(frames[b].c, std::cos(q[3 * b + 2]), 2.3e-16);
    }
    EXPECT_EQ(frames.back().x, 123) << "wrote beyond the last frame";
  }
  update_frames({}, {});  // a scene without bodies: nothing to touch
}

}  // namespace
}  // namespace catena
