// Tables show no digit that is not right.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <limits>
#include <random>

#include "catena/columns/column_errors.hpp"
#include "catena/results/number_format.hpp"
#include "catena/results/terminal/text_table.hpp"

namespace catena {
namespace {

using Texts = std::vector<std::string>;

TEST(ShownDigits, EndWhereTheErrorBegins) {
  const std::array<double, 2> values = {1.234567, 0.001234};
  const auto shown = [&](double error) { return format_column(values, std::array{error, error}); };
  EXPECT_EQ(shown(0), (Texts{"1.23457", "0.00123"}));
  EXPECT_EQ(shown(1e-12), (Texts{"1.23457", "0.00123"}));
  EXPECT_EQ(shown(0.004), (Texts{"1.23", "0.00"}));
  EXPECT_EQ(shown(0.4), (Texts{"1", "0"}));
  EXPECT_EQ(shown(3), (Texts{"0", "0"}));
}

TEST(ShownDigits, OfLargeAndSmallNumbersAsWell) {
  const auto shown = [](double value, double error) {
    return format_column(std::array{value}, std::array{error}).front();
  };
  EXPECT_EQ(shown(1.23456e-9, 0), "1.23456e-09");
  EXPECT_EQ(shown(1.23456e-9, 2e-12), "1.23e-09");
  EXPECT_EQ(shown(1.23456e-17, 2e-16), "0");
  EXPECT_EQ(shown(123456, 200), "1.23e+05");
  EXPECT_EQ(shown(8.5e9, 3e9), "0") << "half a unit of its first digit is less than the error";
}

// Whatever the number and its error: the text is within the error and half a unit, and its last digit is right.
TEST(ShownDigits, AreRightForRandomNumbers) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> any(-1, 1);
  for (int k = 0; k < 20000; ++k) {
    const double value = any(random) * std::pow(10.0, 12 * any(random)),
                 error = std::abs(value) * std::pow(10.0, 8 * any(random) - 6);
    const std::string text = format_column(std::array{value}, std::array{error}).front();
    const double shown = std::stod(text);
    if (shown == 0) {
      EXPECT_LE(std::abs(value), 20 * error) << text;
      continue;
    }
    // One unit of the last digit that is shown.
    const std::size_t end = std::min(text.find('e'), text.size()), point = text.find('.');
    const int decimals = point == std::string::npos ? 0 : static_cast<int>(end - point) - 1;
    const double power = end == text.size() ? 0 : std::stod(text.substr(end + 1));
    const double unit = std::pow(10.0, power - decimals);
    EXPECT_GE(unit, 1.999 * error) << value << " " << error << " " << text;
    EXPECT_LE(std::abs(shown - value), 0.501 * unit) << value << " " << error << " " << text;
  }
}

TEST(ShownDigits, AreTakenFromTheLargestOfAllRows) {
  TextTable table({.first_rows = 1, .last_rows = 1, .width = 120, .list_lines = 45});
  const std::vector<ColumnInfo> columns = {{"t", UnitKind::time}, {"a", UnitKind::angle}};
  table.begin(columns);
  for (const double a : {1.111111, 1000.0, 1.111111}) table.row(std::array{0.0, a});
  const double nothing = std::numeric_limits<double>::quiet_NaN();
  // An error of 0.1: half a unit of the last digit is not less.
  EXPECT_NE(table.text(std::array{nothing, 4.0}).lines.find(" 1\n"), std::string::npos) << table.text().lines;
  EXPECT_NE(table.text().lines.find("1.11111\n"), std::string::npos);
}

TEST(ColumnErrors, AreThoseOfTheLargestValue) {
  ColumnErrors errors(5);
  errors.take_row(std::array{1.0, -100.0, 1e-17, 0.0, 1.0});
  errors.take_row(std::array{-2.0, 3.0, std::numeric_limits<double>::infinity(), 0.0, 2.0});
  errors.take_error(0, 2e-9);
  errors.take_error(0, 1e-12);
  errors.take_error(1, std::numeric_limits<double>::quiet_NaN());
  errors.take_error(1, 1e-9);
  errors.take_error(2, 1e-16);
  errors.take_error(3, 0);
  const std::vector<double> digits = errors.digits();
  EXPECT_NEAR(digits[0], 9, 1e-12);
  EXPECT_TRUE(std::isnan(digits[1])) << "once not known, never known";
  EXPECT_EQ(digits[2], 0) << "nothing but error";
  EXPECT_NEAR(digits[3], 15.95, 0.01) << "exactly zero";
  EXPECT_TRUE(std::isnan(digits[4])) << "in no row an estimate was made";
}

}  // namespace
}  // namespace catena
