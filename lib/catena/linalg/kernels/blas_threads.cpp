#include "catena/linalg/kernels/blas_threads.hpp"

#if CATENA_HAS_OPENBLAS
extern "C" void openblas_set_num_threads(int count);
#endif

namespace catena {

void use_single_threaded_blas() {
#if CATENA_HAS_OPENBLAS
  [[maybe_unused]] static const bool once = (openblas_set_num_threads(1), true);
#endif
}

}  // namespace catena
