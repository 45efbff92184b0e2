#include "catena/analysis/batch/kernels/lane_kernel.hpp"
#include "catena/analysis/batch/kernels/lane_kernels.hpp"

namespace catena {

const LaneKernels lane_kernels_baseline =
    make_lane_kernels<xsimd::batch<double, xsimd::default_arch>>("baseline", lane_static_kernels_baseline);

}  // namespace catena
