// Motion laws of cams and drivers: how a rise from 0 to 1 goes over the unit of time, u = 0 ... 1.
//
//   cycloidal            s'' = 2 pi sin(2 pi u)                             continuous acceleration, peak 6.28
//   poly345              10 u^3 - 15 u^4 + 6 u^5                            peak 5.77
//   poly4567             35 u^4 - 84 u^5 + 70 u^6 - 20 u^7                  continuous jerk, peak 7.51
//   modified_trapezoid   quarter sine, constant, half cosine, constant, quarter sine       peak 8 pi / (2 + pi) = 4.89
//   modified_sine        quarter sine of 4 pi u, half sine of 4 pi u / 3, quarter sine     peak 4 pi^2 / (4 + pi)
//   = 5.53
//
// Each is made of pieces s = c0 + c1 v + c2 v^2 + c3 v^3 ... + a sin(w v + p), v = u - start, at whose ends s, s' and
// s'' are continuous. Speeds and accelerations are 0 at both ends. Dimensionless; never singular. Source: R. L. Norton,
// Cam Design and Manufacturing Handbook, chapters 2 and 3.
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <string_view>

namespace catena {

enum class MotionLaw : unsigned char { cycloidal, poly345, poly4567, modified_trapezoid, modified_sine };

/// The names used in scenes, in the order of the enumeration.
inline constexpr std::array<std::string_view, 5> motion_laws{"cycloidal", "poly345", "poly4567", "modified_trapezoid",
                                                             "modified_sine"};

/// One piece of a law.
struct MotionLawPiece {
  double start;                                ///< u where it begins
  std::array<double, 8> power;                 ///< c0, c1, ...
  double amplitude = 0, omega = 0, phase = 0;  ///< of the sine

  template <class T>
  T rise(const T& u) const {
    using std::sin;
    const T v = u - T(start);
    T sum(power.back());
    for (std::size_t k = power.size() - 1; k-- > 0;) sum = sum * v + T(power[k]);
    return amplitude == 0 ? sum : sum + T(amplitude) * sin(T(omega) * v + T(phase));
  }
};

struct MotionLawPieces {
  std::array<MotionLawPiece, 5> piece;
  std::size_t count;
};

/// A law that is one polynomial of u, c0 + c1 u + ...
inline MotionLawPieces polynomial_law(const std::array<double, 8>& power) { return {{MotionLawPiece{0, power}}, 1}; }

/// 3 u^2 - 2 u^3: a step whose acceleration is not zero at its ends.
inline MotionLawPieces cubic_step() { return polynomial_law({0, 0, 3, -2}); }

inline MotionLawPieces motion_law_pieces(MotionLaw law) {
  constexpr double pi = std::numbers::pi;
  switch (law) {
    case MotionLaw::cycloidal:
      return {{MotionLawPiece{0, {0, 1}, -1 / (2 * pi), 2 * pi, 0}}, 1};
    case MotionLaw::poly345:
      return polynomial_law({0, 0, 0, 10, -15, 6});
    case MotionLaw::poly4567:
      return polynomial_law({0, 0, 0, 0, 35, -84, 70, -20});
    case MotionLaw::modified_sine: {
      const double a = 1 / (4 * (4 + pi)), c = pi / (4 + pi);
      return {{MotionLawPiece{0, {0, c}, -a, 4 * pi, 0},
               {0.125, {8 * a + c / 8, c}, -9 * a, 4 * pi / 3, pi / 2},
               {0.875, {16 * a + c * 7 / 8, c}, -a, 4 * pi, 3.5 * pi}},
              3};
    }
    case MotionLaw::modified_trapezoid:
      break;
  }
  // Integrated piece by piece from the acceleration: b sin(w v + p), or constant.
  const double peak = 8 * pi / (2 + pi);
  struct Part {
    double start, constant, sine, phase;
  };
  constexpr std::array<Part, 5> parts{
      Part{0, 0, 1, 0}, {0.125, 1, 0, 0}, {0.375, 0, 1, pi / 2}, {0.625, -1, 0, 0}, {0.875, 0, -1, pi / 2}};
  MotionLawPieces result{{}, parts.size()};
  double s = 0, speed = 0;
  for (std::size_t k = 0; k < parts.size(); ++k) {
    const Part& part = parts[k];
    const double w = 4 * pi, a = -part.sine * peak / (w * w);
    MotionLawPiece& piece = result.piece[k] = {part.start, {}, a, w, part.phase};
    piece.power[0] = s - a * std::sin(part.phase);
    piece.power[1] = speed - a * w * std::cos(part.phase);
    piece.power[2] = part.constant * peak / 2;
    const double v = (k + 1 < parts.size() ? parts[k + 1].start : 1) - part.start;
    s = piece.power[0] + v * (piece.power[1] + v * piece.power[2]) + a * std::sin(w * v + part.phase);
    speed = piece.power[1] + 2 * v * piece.power[2] + a * w * std::cos(w * v + part.phase);
  }
  return result;
}

}  // namespace catena
