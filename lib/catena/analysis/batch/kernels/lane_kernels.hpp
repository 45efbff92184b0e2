// The kernels of a batch for the instruction sets of this build, and the choice among them when the program runs.
#pragma once

#include <string_view>

#include "catena/analysis/batch/kernels/lane_static_code.hpp"

namespace catena {

extern const LaneKernels lane_kernels_baseline, lane_kernels_avx2, lane_kernels_avx512;
extern const LaneStaticKernels lane_static_kernels_baseline, lane_static_kernels_avx2, lane_static_kernels_avx512;

/// Those in use: of the widest instruction set that this processor has.
const LaneKernels& lane_kernels();

/// Uses "avx512", "avx2" or "baseline" from now on, in all threads; false if this machine or build does not have it.
/// For tests and benchmarks.
bool select_lane_kernels(std::string_view name);

}  // namespace catena
