// Random mechanisms whose motion or place of rest is known in closed form, as scenes, for the digits that their columns
// claim: each from the numbers of its scene as a double holds them, in 64 bits of mantissa.
//
//   slider-crank   x = r cos a + w,  w^2 = l^2 - r^2 sin^2 a,  a = a0 + a1 t      condition l / w: of the rod's line
//   pendulum       sin(theta / 2) = k cd(omega t, k),  omega^2 = m g c / (J + m c^2),  k = sin(theta0 / 2)
//   rod on spring  k_t (phi - rest) + m g c cos phi = 0
//   loaded rod     k_t (phi - rest) = P c cos phi along a path of P      rows are held against their own P
//   ball           y = r + v s - g s^2 / 2 between impacts, the speed e times as large after each
//
// Source of cd: L. M. Milne-Thomson in Abramowitz and Stegun, "Handbook of Mathematical Functions" (1964), 16.4.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace bench {

struct DigitsCase {
  std::string scene{};                 ///< its only analysis has columns that claim digits
  std::vector<std::string> columns{};  ///< those with exact values
  /// One value a column, at the instant of a row, or the value of a path's parameter.
  std::vector<long double> (*exact)(const DigitsCase& c, double t) = nullptr;
  std::vector<double> numbers{};  ///< of the scene, for `exact`
  double condition = 0;           ///< 0: not known
};

DigitsCase random_slider_crank(unsigned seed);
DigitsCase random_pendulum(unsigned seed, const char* method = "auto");
DigitsCase random_rod_on_spring(unsigned seed);
DigitsCase random_loaded_rod(unsigned seed);
DigitsCase random_bouncing_ball(unsigned seed);
/// The crank stands nearly across, and the rod is longer by a part of it.
DigitsCase slider_crank_near_dead_point(double part);

}  // namespace bench
