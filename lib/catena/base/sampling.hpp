// Points of a design of experiments in the unit cube: which values of many parameters are tried.
//
//   random   independent, uniform
//   latin    n points, in every direction one in each of n equal strips
//   sobol    a (t, s)-sequence in base 2: point k is the exclusive or of direction numbers by the Gray code of k
//
// Point k depends on the seed alone, not on the order of calls nor on the thread: random and latin take their numbers
// from (seed, k) by a counter-based generator. The first point of Sobol's sequence, the corner, is left out. Source: S.
// Joe and F. Kuo, Constructing Sobol sequences with better two-dimensional projections, SIAM J. Sci. Comput. 30 (2008);
// McKay, Beckman, Conover (1979); Steele, Lea, Flood, Fast splittable generators (2014).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace catena {

enum class Sampling : unsigned char { sobol, latin, random };

class SamplePoints {
 public:
  /// Directions that Sobol's sequence has.
  static constexpr int most_sobol_directions = 21;

  /// std::invalid_argument for fewer than one point or direction, and for more directions than a sequence has.
  SamplePoints(Sampling kind, std::int64_t points, int directions, std::uint64_t seed);

  std::int64_t points() const { return points_; }
  /// The coordinates of point k = 0 ... points - 1, each in (0, 1); size directions.
  void point(std::int64_t k, std::span<double> out) const;

 private:
  Sampling kind_;
  std::int64_t points_;
  int directions_;
  std::uint64_t seed_;
  std::vector<std::int64_t> strips_;      // of a latin square: strip of point k in direction d at d points + k
  std::vector<std::uint32_t> direction_;  // Sobol's numbers, 32 a direction
};

/// The value that a normal variable of mean 0 and deviation 1 stays below with probability p in (0, 1); relative
/// error below 1e-14. Source: Acklam's rational start, one step of Halley's method on erfc.
double normal_quantile(double p);

}  // namespace catena
