// Every text that the fuzzers keep, through what they go through: tests/fuzz/entry_points.hpp says what must hold.
#include <gtest/gtest.h>

#include <filesystem>

#include "fuzz/entry_points.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {
namespace {

void replay(const std::string& name, void (*read)(std::string_view)) {
  const std::filesystem::path corpus = std::filesystem::path(CATENA_DATA_DIR) / "../tests/fuzz/corpus" / name;
  int texts = 0;
  for (const auto& entry : std::filesystem::directory_iterator(corpus)) {
    ++texts;
    EXPECT_NO_THROW(read(read_file(entry.path().string()))) << entry.path();
  }
  EXPECT_GT(texts, 1) << corpus;
}

TEST(FuzzCorpus, ScenesEndWithAModelOrAnError) { replay("scene", read_any_scene); }
TEST(FuzzCorpus, ExpressionsEndWithAValueOrAnError) { replay("expression", read_any_expression); }
TEST(FuzzCorpus, QuantitiesEndWithAValueOrAnError) { replay("quantity", read_any_quantity); }
TEST(FuzzCorpus, CheckpointsEndWithAStateOrAnError) { replay("checkpoint", read_any_checkpoint); }
TEST(FuzzCorpus, TablesEndWithNumbersOrAnError) { replay("table", read_any_table); }

}  // namespace
}  // namespace catena::testing
