// The manual's table of statuses has a line for each of them.
#include <gtest/gtest.h>

#include "catena/base/status.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

TEST(Manual, HasALineForEveryStatus) {
  const std::string manual = read_file(std::string(CATENA_DATA_DIR) + "/../apps/manual/statuses.md");
  ASSERT_FALSE(manual.empty());
  for (int k = 0; k <= static_cast<int>(Status::refused); ++k) {
    const std::string name(to_string(static_cast<Status>(k)));
    EXPECT_NE(manual.find("\n| `" + name + "` |"), std::string::npos) << name;
  }
}

}  // namespace
}  // namespace catena::testing
