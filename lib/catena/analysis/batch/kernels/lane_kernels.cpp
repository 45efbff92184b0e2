#include "catena/analysis/batch/kernels/lane_kernels.hpp"

#include <atomic>

// 0 where a build has the kernels for any processor alone.
#ifndef CATENA_LANES_DISPATCH
#define CATENA_LANES_DISPATCH 1
#endif

namespace catena {
namespace {

bool is_supported([[maybe_unused]] const LaneKernels& kernels) {
#if CATENA_LANES_DISPATCH
  if (&kernels == &lane_kernels_avx512) return __builtin_cpu_supports("avx512f") != 0;
  if (&kernels == &lane_kernels_avx2) return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
#endif
  return true;
}

/// Best first.
constexpr const LaneKernels* all_kernels[] = {
#if CATENA_LANES_DISPATCH
    &lane_kernels_avx512, &lane_kernels_avx2,
#endif
    &lane_kernels_baseline};

const LaneKernels* best() {
  for (const LaneKernels* kernels : all_kernels) {
    if (is_supported(*kernels)) return kernels;
  }
  return &lane_kernels_baseline;
}

std::atomic<const LaneKernels*>& in_use() {
  static std::atomic<const LaneKernels*> kernels = best();
  return kernels;
}

}  // namespace

const LaneKernels& lane_kernels() { return *in_use().load(std::memory_order_relaxed); }

bool select_lane_kernels(std::string_view name) {
  for (const LaneKernels* kernels : all_kernels) {
    if (name != kernels->name || !is_supported(*kernels)) continue;
    in_use().store(kernels, std::memory_order_relaxed);
    return true;
  }
  return false;
}

}  // namespace catena
