#include "catena/analysis/batch/kernels/lane_kernels.hpp"
#include "catena/analysis/batch/kernels/lane_static_kernel.hpp"

namespace catena {

const LaneStaticKernels lane_static_kernels_avx2 =
    make_lane_static_kernels<xsimd::batch<double, xsimd::default_arch>>();

}  // namespace catena
