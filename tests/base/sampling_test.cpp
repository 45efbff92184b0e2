// Designs of experiments: strips are met once, Sobol's points are spread better than chance in every pair of
// directions, points do not depend on the order in which they are asked for.
#include "catena/base/sampling.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

namespace catena {
namespace {

std::vector<std::vector<double>> points_of(Sampling kind, std::int64_t n, int directions, std::uint64_t seed = 1) {
  const SamplePoints points(kind, n, directions, seed);
  std::vector<std::vector<double>> all(static_cast<std::size_t>(n),
                                       std::vector<double>(static_cast<std::size_t>(directions)));
  for (std::int64_t k = n; k-- > 0;) points.point(k, all[static_cast<std::size_t>(k)]);
  return all;
}

TEST(Sampling, LatinMeetsEveryStripOnce) {
  for (const std::int64_t n : {1, 2, 7, 100}) {
    const auto points = points_of(Sampling::latin, n, 5);
    for (std::size_t d = 0; d < 5; ++d) {
      std::set<int> strips;
      for (const auto& p : points) strips.insert(static_cast<int>(p[d] * static_cast<double>(n)));
      EXPECT_EQ(strips.size(), static_cast<std::size_t>(n));
    }
  }
}

// The first 2^m points of the sequence, its corner included, meet each of 2^m strips once: here without the corner.
TEST(Sampling, SobolMeetsEveryDyadicStripOnce) {
  const int directions = SamplePoints::most_sobol_directions;
  const auto points = points_of(Sampling::sobol, 1023, directions);
  for (std::size_t d = 0; d < static_cast<std::size_t>(directions); ++d) {
    std::set<int> strips{0};
    for (const auto& p : points) strips.insert(static_cast<int>(p[d] * 1024));
    EXPECT_EQ(strips.size(), 1024u) << d;
  }
}

// In pairs of directions 16 x 16 boxes hold four of 1024 points on average; a random design leaves 1.8 % of them empty.
TEST(Sampling, SobolFillsBoxesOfMostPairs) {
  const auto points = points_of(Sampling::sobol, 1023, 12);
  int empty = 0, pairs = 0;
  for (std::size_t a = 0; a < 12; ++a) {
    for (std::size_t b = 0; b < a; ++b) {
      std::set<int> boxes;
      for (const auto& p : points) boxes.insert(static_cast<int>(p[a] * 16) * 16 + static_cast<int>(p[b] * 16));
      empty += 256 - static_cast<int>(boxes.size());
      ++pairs;
    }
  }
  EXPECT_LT(empty, 0.018 * 256 * pairs);
}

// x y over the unit square has the mean 1/4: the error of Sobol's points is that of n^-1 (log n)^2, not of n^-1/2.
TEST(Sampling, SobolIntegratesBetterThanChance) {
  const auto points = points_of(Sampling::sobol, 4095, 2);
  double sum = 0;
  for (const auto& p : points) sum += p[0] * p[1];
  EXPECT_NEAR(sum / 4095, 0.25, 2e-4);
}

TEST(Sampling, RandomPointsLookUniformAndDependOnTheSeed) {
  const auto points = points_of(Sampling::random, 20000, 3), others = points_of(Sampling::random, 20000, 3, 2);
  for (std::size_t d = 0; d < 3; ++d) {
    double mean = 0, square = 0;
    for (const auto& p : points) mean += p[d], square += p[d] * p[d];
    // Four deviations of the mean of 20000.
    EXPECT_NEAR(mean / 20000, 0.5, 4 * std::sqrt(1.0 / 12 / 20000));
    EXPECT_NEAR(square / 20000, 1.0 / 3, 4 * std::sqrt(4.0 / 45 / 20000));
  }
  EXPECT_NE(points[0][0], others[0][0]);
  EXPECT_EQ(points, points_of(Sampling::random, 20000, 3));
}

TEST(Sampling, RefusesWhatIsNoDesign) {
  EXPECT_THROW(SamplePoints(Sampling::random, 0, 1, 1), std::invalid_argument);
  EXPECT_THROW(SamplePoints(Sampling::latin, 1, 0, 1), std::invalid_argument);
  EXPECT_THROW(SamplePoints(Sampling::sobol, 10, 22, 1), std::invalid_argument);
}

TEST(NormalQuantile, InvertsTheProbability) {
  for (double p = 1e-12; p < 1; p = p < 0.01 ? p * 3 : p + 0.0073) {
    const double x = normal_quantile(p);
    EXPECT_NEAR(0.5 * std::erfc(-x / std::sqrt(2.0)), p, 4e-16 + 1e-13 * p) << p;
  }
  EXPECT_NEAR(normal_quantile(0.975), 1.959963984540054, 1e-14);
  EXPECT_EQ(normal_quantile(0.5), 0);
}

}  // namespace
}  // namespace catena
