// Rows of numbers that go through the same operations side by side, in packs as wide as the registers of the processor
// at hand: right-hand sides that share a matrix, one a column.
//
//   y[r][p] += a x[c][p]        p = 0 ... width - 1, in steps of a pack; rows lie `width` numbers apart
//
// A kernel is a template on the pack; with_packs() runs it in pairs, which every 64-bit processor adds and multiplies
// at once, or in fours where it can. Products and sums are rounded one after the other in both: results are the same.
#pragma once

#include <cstddef>
#include <cstring>

namespace catena::packs {

using Pair = double __attribute__((vector_size(16)));

template <class P>
constexpr std::size_t lanes = sizeof(P) / sizeof(double);

template <class P>
inline void load(P& x, const double* from) {
  std::memcpy(&x, from, sizeof(P));
}
template <class P>
inline void store(const P& x, double* to) {
  std::memcpy(to, &x, sizeof(P));
}
/// out += a x.
template <class P>
inline void add(double* out, double a, const P& x) {
  P y;
  load(y, out);
  y += a * x;
  store(y, out);
}

#if defined(__x86_64__)
using Four = double __attribute__((vector_size(32)));

template <class Kernel>
[[gnu::target("avx2"), gnu::flatten]] void in_fours(const Kernel& kernel, std::size_t width) {
  for (std::size_t first = 0; first < width; first += lanes<Four>) kernel.template run<Four>(first);
}
#endif

template <class Kernel>
void in_pairs(const Kernel& kernel, std::size_t width) {
  for (std::size_t first = 0; first < width; first += lanes<Pair>) kernel.template run<Pair>(first);
}

/// Calls kernel.run<P>(first) for all columns; `width` is a multiple of four.
template <class Kernel>
void with_packs(const Kernel& kernel, std::size_t width) {
#if defined(__x86_64__)
  static const bool wide = __builtin_cpu_supports("avx2") != 0;
  if (wide) return in_fours(kernel, width);
#endif
  in_pairs(kernel, width);
}

}  // namespace catena::packs
