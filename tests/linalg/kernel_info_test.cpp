#include "catena/linalg/kernels/kernel_info.hpp"

#include <gtest/gtest.h>

namespace catena {
namespace {

TEST(KernelInfo, NamesEveryOptionalKernelAsPresentOrMissing) {
  const std::string summary = kernel_summary();
  EXPECT_EQ(summary.rfind("KLU ", 0), 0u) << summary;
  EXPECT_NE(summary.find("CHOLMOD "), std::string::npos);
  const std::size_t missing = summary.find("without");
  EXPECT_EQ(summary.find("UMFPACK") < missing, is_compiled_in(Kernel::umfpack)) << summary;
  EXPECT_EQ(summary.find("SPQR") < missing, is_compiled_in(Kernel::spqr)) << summary;
}

TEST(KernelInfo, HasOneNameForEveryKernel) {
  EXPECT_EQ(to_string(Kernel::automatic), "automatic");
  EXPECT_EQ(to_string(Kernel::klu), "klu");
  EXPECT_EQ(to_string(Kernel::cholmod), "cholmod");
  EXPECT_EQ(to_string(Kernel::umfpack), "umfpack");
  EXPECT_EQ(to_string(Kernel::spqr), "spqr");
  EXPECT_TRUE(is_compiled_in(Kernel::automatic));
}

}  // namespace
}  // namespace catena
