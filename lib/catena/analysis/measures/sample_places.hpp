// Where a part of a motion is sampled, and the weights of polynomials through the samples.
//
//   p(x) = sum f_k prod_j (x - x_j) / (x_k - x_j)        x in [-1, 1]: -1, the nodes, 1
//
// Source: R. Piessens et al., QUADPACK (1983), for the nodes; J.-P. Berrut, L. N. Trefethen, SIAM Rev. 46 (2004) 501.
// Private to measures.
#pragma once

#include <array>
#include <cstddef>

namespace catena::sample_places {

// Of [-1, 1]: the nodes of Kronrod's extension of Gauss' rule with three nodes, and half its weights.
inline constexpr std::array<double, 7> places = {
    -0.960491268708020283423507092629080, -0.774596669241483377035853079956480,
    -0.434243749346802558002071502844628, 0.0,
    0.434243749346802558002071502844628,  0.774596669241483377035853079956480,
    0.960491268708020283423507092629080};
inline constexpr std::array<double, 7> half_weights = {
    0.104656226026467265193823857192073 / 2, 0.268488089868333440728569280666710 / 2,
    0.401397414775962222905051818618432 / 2, 0.450916538658474142345110087045571 / 2,
    0.401397414775962222905051818618432 / 2, 0.268488089868333440728569280666710 / 2,
    0.104656226026467265193823857192073 / 2};
/// Between two neighbouring samples, in parts of the length.
inline constexpr double widest_gap = places[4] / 2;
// Samples of a part that the quartic goes through (both ends, three nodes), and those that it must foretell.
inline constexpr std::array<std::size_t, 5> known = {0, 2, 4, 6, 8};
inline constexpr std::array<std::size_t, 4> foretold = {1, 3, 5, 7};

inline double place_of(std::size_t sample) { return sample == 0 ? -1 : sample == 8 ? 1 : places[sample - 1]; }

/// The barycentric weights of the samples of a part, up to a factor.
inline std::array<double, 9> barycentric_weights() {
  std::array<double, 9> weights{};
  for (std::size_t k = 0; k < weights.size(); ++k) {
    weights[k] = 1;
    for (std::size_t j = 0; j < weights.size(); ++j) {
      if (j != k) weights[k] /= place_of(k) - place_of(j);
    }
  }
  return weights;
}

/// Weights of the samples in the coefficient of degree seven, of all but the one in the middle, and of degree eight, as
/// one of Chebyshev's polynomial: divided differences over 2^6 and 2^7.
inline std::array<std::array<double, 9>, 2> highest_weights() {
  std::array<std::array<double, 9>, 2> weights{};
  for (std::size_t k = 0; k < 9; ++k) {
    double without = 1;
    for (std::size_t j = 0; j < 9; ++j) {
      if (j != k && j != 4) without /= place_of(k) - place_of(j);
    }
    weights[0][k] = k == 4 ? 0 : without / 64;
    weights[1][k] = k == 4 ? without / 128 : without / (128 * (place_of(k) - place_of(4)));
  }
  return weights;
}

/// The quartic's weights of the known samples at the foretold ones (Lagrange).
inline std::array<std::array<double, 5>, 4> foretelling_weights() {
  std::array<std::array<double, 5>, 4> weights{};
  for (std::size_t f = 0; f < foretold.size(); ++f) {
    const double x = place_of(foretold[f]);
    for (std::size_t k = 0; k < known.size(); ++k) {
      double w = 1;
      for (std::size_t j = 0; j < known.size(); ++j) {
        if (j != k) w *= (x - place_of(known[j])) / (place_of(known[k]) - place_of(known[j]));
      }
      weights[f][k] = w;
    }
  }
  return weights;
}

}  // namespace catena::sample_places
