#include "catena/base/sampling.hpp"

#include <array>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <string>
#include <utility>

namespace catena {
namespace {

// Sixty-four well mixed bits from any (splitmix64).
std::uint64_t mix(std::uint64_t x) {
  x += 0x9e3779b97f4a7c15u;
  x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
  x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
  return x ^ (x >> 31);
}

std::uint64_t bits(std::uint64_t seed, std::uint64_t k, std::uint64_t direction) {
  return mix(mix(mix(seed) ^ k) ^ direction);
}

/// In (0, 1): the middle of one of 2^53 cells.
double uniform(std::uint64_t x) { return (static_cast<double>(x >> 11) + 0.5) * 0x1p-53; }

/// Primitive polynomials and first direction numbers of the directions after the first one.
struct SobolRow {
  int degree;
  std::uint32_t inner;                 // inner coefficients of the polynomial
  std::array<std::uint32_t, 7> first;  // m_1 ... m_degree, odd, m_i < 2^i
};
constexpr std::array<SobolRow, 20> sobol_rows{{{1, 0, {1}},
                                               {2, 1, {1, 3}},
                                               {3, 1, {1, 3, 1}},
                                               {3, 2, {1, 1, 1}},
                                               {4, 1, {1, 1, 3, 3}},
                                               {4, 4, {1, 3, 5, 13}},
                                               {5, 2, {1, 1, 5, 5, 17}},
                                               {5, 4, {1, 1, 5, 5, 5}},
                                               {5, 7, {1, 1, 7, 11, 19}},
                                               {5, 11, {1, 1, 5, 1, 1}},
                                               {5, 13, {1, 1, 1, 3, 11}},
                                               {5, 14, {1, 3, 5, 5, 31}},
                                               {6, 1, {1, 3, 3, 9, 7, 49}},
                                               {6, 13, {1, 1, 1, 15, 21, 21}},
                                               {6, 16, {1, 3, 1, 13, 27, 49}},
                                               {6, 19, {1, 1, 1, 15, 7, 5}},
                                               {6, 22, {1, 3, 1, 15, 13, 25}},
                                               {6, 25, {1, 1, 5, 5, 19, 61}},
                                               {7, 1, {1, 3, 7, 11, 23, 15, 103}},
                                               {7, 4, {1, 3, 7, 13, 13, 15, 69}}}};

std::vector<std::uint32_t> sobol_directions(int directions) {
  std::vector<std::uint32_t> v(32 * static_cast<std::size_t>(directions));
  for (std::size_t i = 0; i < 32; ++i) v[i] = 1u << (31 - i);
  for (std::size_t d = 1; d < static_cast<std::size_t>(directions); ++d) {
    const SobolRow& row = sobol_rows[d - 1];
    const auto s = static_cast<std::size_t>(row.degree);
    std::uint32_t* own = v.data() + 32 * d;
    for (std::size_t i = 0; i < s; ++i) own[i] = row.first[i] << (31 - i);
    for (std::size_t i = s; i < 32; ++i) {
      own[i] = own[i - s] ^ (own[i - s] >> s);
      for (std::size_t k = 1; k < s; ++k) {
        if ((row.inner >> (s - 1 - k)) & 1) own[i] ^= own[i - k];
      }
    }
  }
  return v;
}

}  // namespace

SamplePoints::SamplePoints(Sampling kind, std::int64_t points, int directions, std::uint64_t seed)
    : kind_(kind), points_(points), directions_(directions), seed_(seed) {
  if (points < 1 || directions < 1) throw std::invalid_argument("a design needs at least one point and one parameter");
  if (kind == Sampling::sobol) {
    if (directions > most_sobol_directions) {
      throw std::invalid_argument("Sobol's sequence is made for at most " + std::to_string(most_sobol_directions) +
                                  " parameters, there are " + std::to_string(directions) + ": take latin or random");
    }
    if (points >= (std::int64_t{1} << 32))
      throw std::invalid_argument("Sobol's sequence has 2^32 points, more are asked for");
    direction_ = sobol_directions(directions);
  }
  if (kind == Sampling::latin) {
    // A permutation of the strips for each direction (Fisher and Yates).
    const auto n = static_cast<std::size_t>(points);
    strips_.resize(n * static_cast<std::size_t>(directions));
    for (std::size_t d = 0; d < static_cast<std::size_t>(directions); ++d) {
      std::int64_t* strip = strips_.data() + d * n;
      std::iota(strip, strip + n, std::int64_t{0});
      for (std::size_t k = n; k-- > 1;) std::swap(strip[k], strip[bits(~seed, k, d) % (k + 1)]);
    }
  }
}

void SamplePoints::point(std::int64_t k, std::span<double> out) const {
  const auto number = static_cast<std::uint64_t>(k);
  for (std::size_t d = 0; d < static_cast<std::size_t>(directions_); ++d) {
    switch (kind_) {
      case Sampling::random:
        out[d] = uniform(bits(seed_, number, d));
        break;
      case Sampling::latin: {
        const auto n = static_cast<std::size_t>(points_);
        out[d] =
            (static_cast<double>(strips_[d * n + number]) + uniform(bits(seed_, number, d))) / static_cast<double>(n);
        break;
      }
      case Sampling::sobol: {
        const std::uint64_t place = number + 1, gray = place ^ (place >> 1);
        std::uint32_t x = 0;
        for (std::uint64_t rest = gray; rest != 0; rest &= rest - 1)
          x ^= direction_[32 * d + static_cast<std::size_t>(std::countr_zero(rest))];
        // The middle of the smallest cell, never 0 or 1.
        out[d] = (static_cast<double>(x) + 0.5) * 0x1p-32;
        break;
      }
    }
  }
}

double normal_quantile(double p) {
  constexpr std::array<double, 6> a{-39.69683028665376, 220.9460984245205,  -275.9285104469687,
                                    138.3577518672690,  -30.66479806614716, 2.506628277459239};
  constexpr std::array<double, 5> b{-54.47609879822406, 161.5858368580409, -155.6989798598866, 66.80131188771972,
                                    -13.28068155288572};
  constexpr std::array<double, 6> c{-0.007784894002430293, -0.3223964580411365, -2.400758277161838,
                                    -2.549732539343734,    4.374664141464968,   2.938163982698783};
  constexpr std::array<double, 4> d{0.007784695709041462, 0.3224671290700398, 2.445134137142996, 3.754408661907416};
  // Where the middle formula hands over to that of the tails.
  constexpr double tail = 0.02425;
  const auto horner = [](const auto& k, double x) {
    double sum = 0;
    for (const double coefficient : k) sum = sum * x + coefficient;
    return sum;
  };
  const double lower = p < 0.5 ? p : 1 - p;
  double x = 0;
  if (lower < tail) {
    const double q = std::sqrt(-2 * std::log(lower));
    x = horner(c, q) / (horner(d, q) * q + 1);
  } else {
    const double q = lower - 0.5, r = q * q;
    x = horner(a, r) * q / (horner(b, r) * r + 1);
  }
  const double error = 0.5 * std::erfc(-x / std::numbers::sqrt2) - lower;
  const double u = error * std::sqrt(2 * std::numbers::pi) * std::exp(x * x / 2);
  x -= u / (1 + x * u / 2);
  return p < 0.5 ? x : -x;
}

}  // namespace catena
