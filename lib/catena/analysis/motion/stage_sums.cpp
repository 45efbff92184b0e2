// Two forms of one loop: in pairs of numbers, as every 64-bit processor has them, and in fours where it can.
#include "catena/analysis/motion/stage_sums.hpp"

#include <cstring>

#include "catena/linalg/kernels/lanes.hpp"
#include "catena/linalg/kernels/packs.hpp"

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

StageWeights weights_of(const StageSum& sum, const Tableau& table) {
  std::array<double, 12> of_q{}, of_v{};
  StageWeights weights;
  for (const StageTerm& outer : sum) {
    weights.way += outer.weight;
    of_v[static_cast<std::size_t>(outer.stage)] += outer.weight;
    for (const StageTerm& inner : table.a[static_cast<std::size_t>(outer.stage)])
      of_q[static_cast<std::size_t>(inner.stage)] += outer.weight * inner.weight;
  }
  for (std::size_t s = 0; s < of_q.size(); ++s) {
    if (of_q[s] == 0 && of_v[s] == 0) continue;
    const std::size_t k = weights.terms++;
    weights.stage[k] = static_cast<int>(s);
    weights.of_q[k] = of_q[s];
    weights.of_v[k] = of_v[s];
  }
  return weights;
}

struct SecondOrderKernel {
  const SecondOrderSum& sum;
  std::span<const int> rows;
  std::size_t width;
  double *q, *v;

  template <class P>
  void run(std::size_t first) const {
    for (const int row : rows) {
      const std::size_t i = static_cast<std::size_t>(row) * width + first;
      P place, rate, slope;
      packs::load(place, sum.q + i);
      packs::load(rate, sum.v + i);
      place += sum.way * rate;
      for (std::size_t k = 0; k < sum.terms; ++k) {
        packs::load(slope, sum.slope[k] + i);
        place += sum.of_q[k] * slope;
        rate += sum.of_v[k] * slope;
      }
      packs::store(place, q + i);
      packs::store(rate, v + i);
    }
  }
};

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

const std::array<StageWeights, 13>& second_order_weights() {
  static const std::array<StageWeights, 13> weights = [] {
    std::array<StageWeights, 13> of{};
    const Tableau& table = dormand_prince_8();
    for (std::size_t s = 0; s + 1 < of.size(); ++s) of[s] = weights_of(table.a[s], table);
    of.back() = weights_of(table.b, table);
    return of;
  }();
  return weights;
}

void add_weighted_rows(const SecondOrderSum& sum, std::span<const int> rows, std::size_t width, double* q, double* v) {
  packs::with_packs(SecondOrderKernel{sum, rows, width, q, v}, width);
}

void detail::add_weighted(const Weighted& sum, std::size_t size, double* out) {
#if defined(__x86_64__)
  static const bool wide = __builtin_cpu_supports("avx2") != 0;
  if (wide) return add_avx2(sum, size, out);
#endif
  add_weighted_baseline(sum, size, out);
}

}  // namespace catena
