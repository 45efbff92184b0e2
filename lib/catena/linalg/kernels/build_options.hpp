// Which optional kernels are compiled in; the build sets both, 1 or 0. For the .cpp files of this folder only.
#pragma once

#ifndef CATENA_HAS_UMFPACK
#define CATENA_HAS_UMFPACK 1
#endif

#ifndef CATENA_HAS_SPQR
#define CATENA_HAS_SPQR 1
#endif
