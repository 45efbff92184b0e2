// Failed designs: all of them are given again, in order, while memory holds a megabyte.
#include "catena/results/failure_list.hpp"

#include <gtest/gtest.h>

namespace catena::testing {
namespace {

std::string reason_of(std::int64_t k) {
  return "constraint " + std::to_string(k % 17) + std::string(static_cast<std::size_t>(k % 101), '.');
}

TEST(FailureList, HoldsAMegabyteAndGivesAll) {
  FailureList list({"a", "b"}, [](std::int64_t k, std::span<double> out) {
    out[0] = static_cast<double>(k) / 3;
    out[1] = -static_cast<double>(k);
  });
  constexpr std::int64_t many = 40'000;
  const auto check = [&](std::int64_t size) {
    std::int64_t k = 0;
    list.for_each([&](const FieldRecord& record) {
      EXPECT_EQ(record.size(), 5u);
      EXPECT_EQ(std::get<std::int64_t>(record[0].second), 2 * k + 1);
      EXPECT_EQ(record[1].first, "a");
      EXPECT_EQ(std::get<double>(record[1].second), static_cast<double>(2 * k) / 3);
      EXPECT_EQ(std::get<double>(record[2].second), -static_cast<double>(2 * k));
      EXPECT_EQ(std::get<std::string>(record[3].second), k % 2 ? "singular" : "not_assembled");
      EXPECT_EQ(std::get<std::string>(record[4].second), reason_of(k));
      ++k;
      return !::testing::Test::HasFailure();
    });
    EXPECT_EQ(k, size);
    EXPECT_EQ(list.size(), size);
  };
  std::size_t most = 0;
  for (std::int64_t k = 0; k < many; ++k) {
    list.add(2 * k, k % 2 ? Status::singular : Status::not_assembled, reason_of(k));
    most = std::max(most, list.bytes_held());
    if (k == many / 2) check(k + 1);  // it can be read and goes on
  }
  check(many);
  EXPECT_GT(most, FailureList::most_bytes / 2) << "nothing was moved to a file: the test is too small";
  EXPECT_LE(most, FailureList::most_bytes);
}

}  // namespace
}  // namespace catena::testing
