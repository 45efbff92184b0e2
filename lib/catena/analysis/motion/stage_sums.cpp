// Two forms of one loop: in pairs of numbers, as every 64-bit processor has them, and in fours where it can.
#include "catena/analysis/motion/stage_sums.hpp"

#include <cstring>

#include "catena/linalg/kernels/lanes.hpp"

namespace catena {
namespace {

using Weighted = detail::WeightedVectors;

/// From number i on, one by one.
void add_rest(const Weighted& sum, std::size_t i, std::size_t size, double* out) {
  for (; i < size; ++i) {
    double x = sum.from ? sum.from[i] : 0;
    for (std::size_t t = 0; t < sum.terms; ++t) x += sum.weight[t] * sum.vector[t][i];
    out[i] = x;
  }
}

#if defined(__x86_64__)
// Products and sums are rounded one after the other here, too: results are those of any other processor.
[[gnu::target("avx2")]] void add_avx2(const Weighted& sum, std::size_t size, double* out) {
  using Four = double __attribute__((vector_size(32)));
  const auto* const vector = sum.vector.data();
  const auto* const weight = sum.weight.data();
  std::size_t i = 0;
  for (; i + 8 <= size; i += 8) {
    Four x{}, y{}, k;
    if (sum.from) {
      std::memcpy(&x, sum.from + i, sizeof x);
      std::memcpy(&y, sum.from + i + 4, sizeof y);
    }
    for (std::size_t t = 0; t < sum.terms; ++t) {
      std::memcpy(&k, vector[t] + i, sizeof k);
      x += weight[t] * k;
      std::memcpy(&k, vector[t] + i + 4, sizeof k);
      y += weight[t] * k;
    }
    std::memcpy(out + i, &x, sizeof x);
    std::memcpy(out + i + 4, &y, sizeof y);
  }
  add_rest(sum, i, size, out);
}
#endif

}  // namespace

void detail::add_weighted_baseline(const Weighted& sum, std::size_t size, double* out) {
  constexpr std::size_t count = Lanes::count;
  std::size_t i = 0;
  for (; i + 2 * count <= size; i += 2 * count) {
    Lanes x = sum.from ? Lanes::load(sum.from + i) : Lanes(),
          y = sum.from ? Lanes::load(sum.from + i + count) : Lanes();
    for (std::size_t t = 0; t < sum.terms; ++t) {
      x += sum.weight[t] * Lanes::load(sum.vector[t] + i);
      y += sum.weight[t] * Lanes::load(sum.vector[t] + i + count);
    }
    x.store(out + i);
    y.store(out + i + count);
  }
  add_rest(sum, i, size, out);
}

void detail::add_weighted(const Weighted& sum, std::size_t size, double* out) {
#if defined(__x86_64__)
  static const bool wide = __builtin_cpu_supports("avx2") != 0;
  if (wide) return add_avx2(sum, size, out);
#endif
  add_weighted_baseline(sum, size, out);
}

}  // namespace catena
