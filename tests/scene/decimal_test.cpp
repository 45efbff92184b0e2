// Decimal numbers as every place of a scene reads them.
#include "catena/scene/numbers/decimal.hpp"

#include <gtest/gtest.h>

namespace catena {
namespace {

TEST(Decimal, ReadsTheNumberAtTheBeginning) {
  EXPECT_EQ(read_decimal("-0.5mm").value, -0.5);
  EXPECT_EQ(read_decimal("-0.5mm").length, 4u);
  EXPECT_EQ(read_decimal("12e3)").value, 12000);
  EXPECT_EQ(read_decimal("x").length, 0u);
  EXPECT_EQ(read_decimal("").length, 0u);
}

TEST(Decimal, TooSmallIsZeroAndTooLargeIsSaid) {
  for (const char* small : {"1e-400", "-1e-99999999999999999999", "0.000001e-350", "1E-400"}) {
    const Decimal number = read_decimal(small);
    EXPECT_EQ(number.value, 0) << small;
    EXPECT_FALSE(number.too_large) << small;
    EXPECT_EQ(number.length, std::string_view(small).size());
  }
  const std::string zeros(400, '0');
  for (const std::string& large : {std::string("1e400"), std::string("-1e+400"), "1" + zeros + "e-20", "1" + zeros,
                                   std::string("1e99999999999999999999")}) {
    EXPECT_TRUE(read_decimal(large).too_large) << large;
  }
  EXPECT_FALSE(read_decimal("0." + zeros + "1").too_large);
  EXPECT_EQ(read_decimal("0." + zeros + "1e300").value, 1e-101);
}

}  // namespace
}  // namespace catena
