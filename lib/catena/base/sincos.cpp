#include "catena/base/sincos.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstdint>
#include <iterator>

// Where multiplications and additions are fused is written below, not left to the compiler: it could decide differently
// for the vectors and for the remainder of a loop, and a value would depend on its place in the array.
#if defined(__clang__)
#pragma STDC FP_CONTRACT OFF
#else
#pragma GCC optimize("fp-contract=off")
#endif

#if defined(__x86_64__) && !defined(__AVX512F__)
#define CATENA_DISPATCH 1
#else
#define CATENA_DISPATCH 0
#endif

namespace catena {
namespace {

#if defined(__FMA__) || defined(__AVX512F__) || defined(__aarch64__)
constexpr bool baseline_fuses = true;
#else
constexpr bool baseline_fuses = false;
#endif

// A block stays in the L1 cache between gathering, evaluating and scattering.
constexpr std::size_t block_size = 128;

// n < 2^17 keeps n times the 33-bit parts of pi/2 exact, and the error of the third part below 1 unit of r's last
// place.
constexpr double largest_reduced = 1e5;

/// a b + c, rounded once if `fused`.
template <bool fused>
[[gnu::always_inline]] inline double multiply_add(double a, double b, double c) {
  if constexpr (fused) return __builtin_fma(a, b, c);
  return a * b + c;
}

/// p0 + z (p1 + z (... + z p5)).
template <bool fused>
[[gnu::always_inline]] inline double horner(double z, double p0, double p1, double p2, double p3, double p4,
                                            double p5) {
  double sum = multiply_add<fused>(z, p5, p4);
  sum = multiply_add<fused>(z, sum, p3);
  sum = multiply_add<fused>(z, sum, p2);
  sum = multiply_add<fused>(z, sum, p1);
  return multiply_add<fused>(z, sum, p0);
}

/// Branch-free, and made of operations that every vector unit has, hence the bit masks in place of choices.
template <bool fused>
[[gnu::always_inline]] inline void sincos_one(double angle, double& cosine, double& sine) {
  constexpr double two_over_pi = 0x1.45f306dc9c883p-1;
  constexpr double half_pi_1 = 0x1.921fb544p+0;        // the first 33 bits of pi/2,
  constexpr double half_pi_2 = 0x1.0b4611a6p-34;       // the next 33,
  constexpr double half_pi_3 = 0x1.3198a2e037073p-69;  // and 53 more
  constexpr double to_integer = 0x1.8p52;              // adding it rounds; n then stands in the lowest bits
  const double shifted = angle * two_over_pi + to_integer;
  const double n = shifted - to_integer;
  const double coarse = multiply_add<fused>(-n, half_pi_1, angle);  // exact, fused or not
  const double r = multiply_add<fused>(-n, half_pi_2, coarse);      // an exact product, rounded by the sum
  const double lost = multiply_add<fused>(-n, half_pi_2, coarse - r);
  const double tail = multiply_add<fused>(-n, half_pi_3, lost);  // r + tail is the reduced angle to 2^-100

  const double z = r * r;
  const double sin_series =
      horner<fused>(z, -1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04,
                    2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10);
  const double cos_series =
      horner<fused>(z, 4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05,
                    -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11);
  const double half_z = 0.5 * z;
  const double head = 1.0 - half_z;
  const double sin_r = r + multiply_add<fused>(r * z, sin_series, tail * head);
  const double small = multiply_add<fused>(z * z, cos_series, -(r * tail));
  const double cos_r = head + (((1.0 - head) - half_z) + small);

  // Quarter turns: odd n swaps the two; bit 1 of n is the sign of the sine, bit 1 of n + 1 that of the cosine.
  const std::uint64_t quarter = __builtin_bit_cast(std::uint64_t, shifted);
  const std::uint64_t swap = 0 - (quarter & 1);
  const std::uint64_t s_bits = __builtin_bit_cast(std::uint64_t, sin_r);
  const std::uint64_t c_bits = __builtin_bit_cast(std::uint64_t, cos_r);
  const std::uint64_t difference = (s_bits ^ c_bits) & swap;
  sine = __builtin_bit_cast(double, (s_bits ^ difference) ^ ((quarter & 2) << 62));
  cosine = __builtin_bit_cast(double, (c_bits ^ difference) ^ (((quarter + 1) & 2) << 62));
}

/// Angles gathered from the caller's layout, with their results.
struct Block {
  alignas(64) double angle[block_size];
  alignas(64) double cosine[block_size];
  alignas(64) double sine[block_size];
};

/// True if the block's first `groups` groups of 8 lie within the reduction (a NaN's bits exceed those of any number).
template <bool fused>
[[gnu::always_inline]] inline bool sincos_block(Block& block, std::size_t groups) {
  const auto limit = __builtin_bit_cast(std::uint64_t, largest_reduced);
  std::uint64_t beyond = 0;
  for (std::size_t k = 0; k < 8 * groups; ++k) {
    sincos_one<fused>(block.angle[k], block.cosine[k], block.sine[k]);
    beyond |= limit - (__builtin_bit_cast(std::uint64_t, block.angle[k]) & 0x7fffffffffffffffU);
  }
  return (beyond >> 63) == 0;
}

using Kernel = bool (*)(Block&, std::size_t);

bool kernel_baseline(Block& block, std::size_t groups) { return sincos_block<baseline_fuses>(block, groups); }

#if CATENA_DISPATCH
[[gnu::target("avx2,fma")]] bool kernel_avx2(Block& block, std::size_t groups) {
  return sincos_block<true>(block, groups);
}
[[gnu::target("avx512f")]] bool kernel_avx512(Block& block, std::size_t groups) {
  return sincos_block<true>(block, groups);
}
#endif

struct Choice {
  std::string_view name;
  Kernel kernel;
  bool (*supported)();
};

/// Best first.
constexpr Choice choices[] = {
#if CATENA_DISPATCH
    {"avx512", kernel_avx512, [] { return __builtin_cpu_supports("avx512f") != 0; }},
    {"avx2", kernel_avx2, [] { return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0; }},
#endif
    {"baseline", kernel_baseline, [] { return true; }}};

const Choice* best_choice() {
#if CATENA_DISPATCH
  __builtin_cpu_init();
#endif
  return std::ranges::find_if(choices, [](const Choice& choice) { return choice.supported(); });
}

std::atomic<const Choice*>& chosen() {
  static std::atomic<const Choice*> choice = best_choice();
  return choice;
}

/// Gathers `count` angles and evaluates them; the last group is filled up with zeros. Angles beyond the reduction are
/// done again by libm, each on its own.
void evaluate(Kernel kernel, const double* angle, std::size_t stride, std::size_t count, Block& block) {
  const std::size_t groups = (count + 7) / 8;
  for (std::size_t k = 0; k < count; ++k) block.angle[k] = angle[k * stride];
  for (std::size_t k = count; k < 8 * groups; ++k) block.angle[k] = 0;
  if (kernel(block, groups)) return;
  for (std::size_t k = 0; k < count; ++k) {
    if (std::abs(block.angle[k]) <= largest_reduced) continue;
    block.cosine[k] = std::cos(block.angle[k]);
    block.sine[k] = std::sin(block.angle[k]);
  }
}

}  // namespace

void sincos(const double* angle, std::size_t stride, std::size_t count, double* cosine, double* sine) {
  const Kernel kernel = chosen().load(std::memory_order_relaxed)->kernel;
  Block block;
  for (std::size_t first = 0; first < count; first += block_size) {
    const std::size_t part = std::min(block_size, count - first);
    evaluate(kernel, angle + first * stride, stride, part, block);
    std::copy_n(block.cosine, part, cosine + first);
    std::copy_n(block.sine, part, sine + first);
  }
}

void sincos(std::span<const double> angle, std::span<double> cosine, std::span<double> sine) {
  sincos(angle.data(), 1, angle.size(), cosine.data(), sine.data());
}

void update_frames(std::span<const double> q, std::span<Frame<double>> frames) {
  const Kernel kernel = chosen().load(std::memory_order_relaxed)->kernel;
  Block block;
  for (std::size_t first = 0; first < frames.size(); first += block_size) {
    const std::size_t count = std::min(block_size, frames.size() - first);
    const double* pose = q.data() + 3 * first;
    evaluate(kernel, pose + 2, 3, count, block);
    Frame<double>* frame = &frames[first];
    for (std::size_t k = 0; k < count; ++k) {
      frame[k] = {pose[3 * k], pose[3 * k + 1], block.angle[k], block.cosine[k], block.sine[k]};
    }
  }
}

std::string_view sincos_instruction_set() { return chosen().load()->name; }

bool select_sincos_instruction_set(std::string_view name) {
  const Choice* choice = std::ranges::find(choices, name, &Choice::name);
  if (choice == std::end(choices) || !choice->supported()) return false;
  chosen() = choice;
  return true;
}

}  // namespace catena
