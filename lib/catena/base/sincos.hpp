// Cosine and sine of many angles at once, several times faster than one libm call each.
//
//   n = round(2 angle / pi)    r = angle - n pi/2, pi/2 in three parts (Cody and Waite)    |r| <= pi/4
//   sin r = r + r^3 S(r^2)     cos r = 1 - r^2/2 + r^4 C(r^2)                              (fdlibm's minimax S, C)
//
// Accuracy, |angle| <= 1e5: absolute error below 1e-16, and within 1 unit in the last place of the result; c^2 + s^2
// differs from 1 by at most 3e-16. Larger angles go to libm one by one; NaN and infinity give NaN.
// One angle, one result: the code has no branch and says itself where it fuses multiplications with additions, so that
// a value does not depend on its place in the array, nor on the vector length chosen when the program starts:
// renumbering the bodies changes no bit. Processors without fused multiply-add (x86-64 before 2013) may differ in the
// last bit. Source: fdlibm k_sin.c and k_cos.c (Sun Microsystems, 1993).
#pragma once

#include <cstddef>
#include <span>
#include <string_view>

#include "catena/base/frame.hpp"

namespace catena {

/// Writes cos(angle[k * stride]) to cosine[k] and sin to sine[k], k = 0 ... count - 1. Angles in radians.
/// The outputs may be the input array itself (stride 1), not overlap it otherwise.
void sincos(const double* angle, std::size_t stride, std::size_t count, double* cosine, double* sine);

/// The same for a contiguous array; `cosine` and `sine` have the length of `angle`.
void sincos(std::span<const double> angle, std::span<double> cosine, std::span<double> sine);

/// Fills `frames[b]` from q = [x, y, phi] of body after body (length 3 frames.size()).
void update_frames(std::span<const double> q, std::span<Frame<double>> frames);

/// The instruction set in use: "avx512", "avx2" or "baseline" (the one that the compiler assumes).
std::string_view sincos_instruction_set();

/// Uses `name` from now on, in all threads; false if this machine or build does not have it. For tests and benchmarks.
bool select_sincos_instruction_set(std::string_view name);

}  // namespace catena
