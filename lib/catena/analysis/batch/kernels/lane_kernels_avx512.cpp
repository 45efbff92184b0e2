#include "catena/analysis/batch/kernels/lane_kernel.hpp"
#include "catena/analysis/batch/kernels/lane_kernels.hpp"

namespace catena {

const LaneKernels lane_kernels_avx512 =
    make_lane_kernels<xsimd::batch<double, xsimd::default_arch>>("avx512", lane_static_kernels_avx512);

}  // namespace catena
