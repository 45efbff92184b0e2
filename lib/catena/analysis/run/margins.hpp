// Margins of decisions that are not about rounding (run/thresholds.hpp): how different two sizes must be to be of
// different kind, how far a linearisation is trusted, what a difference is taken over. Each stands here once.
#pragma once

namespace catena::thresholds {

/// Half of the digits of a number: how well a double root, the bottom of a parabola or a quantity that is compared by
/// its square is known, the root of rounding.
inline constexpr double half_the_digits = 1e-8;

/// A thousandth: small beside one, and large beside what tolerances, differences and rounding leave. It decides where
/// one of two sizes is near one and the other, if it is not, far below: what lies between is of no importance.
inline constexpr double slight = 1e-3;

/// Half a power of ten: a size below this part of another is clearly the smaller one, though both are of one order.
inline constexpr double clearly_less = 0.3;

/// Of the correction before it: one that leaves more gains less than a digit, and asks for new factors.
inline constexpr double a_digit = 0.1;

/// Rad: further no linearisation goes. Half a radian bends a cosine by an eighth; beyond, linkages change their
/// assembly mode and a singular position in between could be missed.
inline constexpr double longest_turn = 0.5;

/// Of a step of central differences: near the third root of epsilon, 6e-6, rounding and the third derivative make
/// errors of one size.
inline constexpr double difference = 1e-5;

}  // namespace catena::thresholds
