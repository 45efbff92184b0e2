#include "catena/linalg/kernels/kernel_info.hpp"

#include <suitesparse/cholmod.h>
#include <suitesparse/klu.h>

#include "catena/linalg/kernels/build_options.hpp"

#if CATENA_HAS_UMFPACK
#include <suitesparse/umfpack.h>
#endif
#if CATENA_HAS_SPQR
#include <suitesparse/SuiteSparseQR_definitions.h>
#endif

namespace catena {
namespace {

[[maybe_unused]] std::string versioned(const char* name, int main, int sub, int subsub) {
  return std::string(name) + ' ' + std::to_string(main) + '.' + std::to_string(sub) + '.' + std::to_string(subsub);
}

}  // namespace

std::string_view to_string(Kernel kernel) {
  switch (kernel) {
    case Kernel::automatic:
      return "automatic";
    case Kernel::klu:
      return "klu";
    case Kernel::cholmod:
      return "cholmod";
    case Kernel::umfpack:
      return "umfpack";
    case Kernel::spqr:
      return "spqr";
  }
  return "unknown kernel";
}

bool is_compiled_in(Kernel kernel) {
  if (kernel == Kernel::umfpack) return CATENA_HAS_UMFPACK;
  if (kernel == Kernel::spqr) return CATENA_HAS_SPQR;
  return true;
}

std::string kernel_summary() {
  std::string present = versioned("KLU", KLU_MAIN_VERSION, KLU_SUB_VERSION, KLU_SUBSUB_VERSION) + ", " +
                        versioned("CHOLMOD", CHOLMOD_MAIN_VERSION, CHOLMOD_SUB_VERSION, CHOLMOD_SUBSUB_VERSION);
  std::string absent;
#if CATENA_HAS_UMFPACK
  present += ", " + versioned("UMFPACK", UMFPACK_MAIN_VERSION, UMFPACK_SUB_VERSION, UMFPACK_SUBSUB_VERSION);
#else
  absent = "; without UMFPACK";
#endif
#if CATENA_HAS_SPQR
  present += ", " + versioned("SPQR", SPQR_MAIN_VERSION, SPQR_SUB_VERSION, SPQR_SUBSUB_VERSION);
#else
  absent += absent.empty() ? "; without SPQR" : " and SPQR";
#endif
  return present + absent;
}

}  // namespace catena
