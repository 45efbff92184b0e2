// BLAS, which UMFPACK and SPQR call on small dense fronts, is kept on the calling thread: threads of its own cost more
// than such fronts, and catena's parallelism is one set of handles per thread.
#pragma once

namespace catena {

/// Takes effect for the whole process, once; only OpenBLAS has such a switch, with another BLAS nothing happens.
void use_single_threaded_blas();

}  // namespace catena
