#include "catena/results/terminal/text_table.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <limits>

#include "catena/results/number_format.hpp"

namespace catena::testing {
namespace {

using Strings = std::vector<std::string>;

Strings formatted(const std::vector<double>& values) { return format_column(values); }

TEST(NumberFormat, AColumnSharesItsDecimals) {
  EXPECT_EQ(formatted({0, 0.01, 0.5, 1}), (Strings{"0.00", "0.01", "0.50", "1.00"}));
  EXPECT_EQ(formatted({1, 2, 300}), (Strings{"1", "2", "300"}));
  EXPECT_EQ(formatted({12.3456789, -1}), (Strings{"12.3457", "-1.0000"}));
  EXPECT_EQ(formatted({9.9999999}), Strings{"10"});
  EXPECT_EQ(formatted({0, -0.0}), (Strings{"0", "0"}));
  EXPECT_EQ(formatted({-0.0, 3e-9}), (Strings{"0e+00", "3e-09"}));
}

TEST(NumberFormat, RoundingErrorsBesideARealNumberReadZero) {
  EXPECT_EQ(formatted({1.5, -3e-17}), (Strings{"1.5", "0.0"}));
  EXPECT_EQ(formatted({2e-17}), Strings{"2e-17"});  // alone it is all there is
}

TEST(NumberFormat, LargeAndSmallColumnsHaveExponents) {
  EXPECT_EQ(formatted({1.25e-5, 0}), (Strings{"1.25e-05", "0.00e+00"}));
  EXPECT_EQ(formatted({123456, 1}), (Strings{"123456", "1"}));
  EXPECT_EQ(formatted({1234567}), Strings{"1.23457e+06"});
  EXPECT_EQ(formatted({0.00123456789}), Strings{"0.00123457"});
}

TEST(NumberFormat, NumbersThatAreNotFiniteAreDashes) {
  EXPECT_EQ(formatted({std::nan(""), 1.5, std::numeric_limits<double>::infinity()}), (Strings{"-", "1.5", "-"}));
  EXPECT_EQ(formatted({}), Strings{});
}

TEST(NumberFormat, ExactNumbersReadBack) {
  for (double value : {0.1, -1.0 / 3, 5e-324, 1.7976931348623157e308, 0.0, 6.02214076e23}) {
    std::string text;
    append_exact(text, value);
    EXPECT_EQ(std::strtod(text.c_str(), nullptr), value) << text;
  }
  std::string text = "a";
  append_exact(text, std::nan(""));
  EXPECT_EQ(text, "a");
}

TextTable::Text table(const std::vector<ColumnInfo>& columns, int rows, const TableLimits& limits = {}) {
  TextTable table(limits);
  table.begin(columns);
  for (int r = 0; r < rows; ++r) {
    std::vector<double> row;
    for (std::size_t k = 0; k < columns.size(); ++k) row.push_back(r + 0.5 * static_cast<double>(k));
    EXPECT_TRUE(table.row(row));
  }
  return table.text();
}

const std::vector<ColumnInfo> three{{"t", UnitKind::time}, {"crank.x", UnitKind::length}, {"mode", UnitKind::none}};

TEST(TextTable, AlignsNamesUnitsAndNumbers) {
  const TextTable::Text text = table(three, 3);
  EXPECT_EQ(text.lines,
            "  t  crank.x  mode\n"
            "  s        m\n"
            "  0      0.5     1\n"
            "  1      1.5     2\n"
            "  2      2.5     3\n");
  EXPECT_FALSE(text.shortened);
}

TEST(TextTable, ShowsTheFirstAndTheLastRowsOfMany) {
  const TextTable::Text text = table({{"t", UnitKind::time}}, 1000, {.first_rows = 2, .last_rows = 3});
  EXPECT_EQ(text.lines,
            "    t\n"
            "    s\n"
            "    0\n"
            "    1\n"
            "  ... 995 more rows\n"
            "  997\n"
            "  998\n"
            "  999\n");
  EXPECT_TRUE(text.shortened);
}

TEST(TextTable, TheLastRowsAreInOrderWhereverTheRingStands) {
  for (int rows = 2; rows < 14; ++rows) {
    const std::string lines = table({{"t", UnitKind::time}}, rows, {.first_rows = 3, .last_rows = 4}).lines;
    std::size_t at = 0;
    for (int r = 0; r < rows; ++r) {
      if (r >= 3 && r < rows - 4) continue;
      const std::size_t found = lines.find(" " + std::to_string(r) + "\n", at);
      ASSERT_NE(found, std::string::npos) << rows << '\n' << lines;
      at = found + 1;
    }
    EXPECT_EQ(lines.find("more row") != std::string::npos, rows > 7);
  }
}

TEST(TextTable, CountsTheColumnsThatDoNotFit) {
  const TextTable::Text text = table(three, 2, {.width = 14});
  EXPECT_EQ(text.lines,
            "  t  crank.x\n"
            "  s        m\n"
            "  0      0.5\n"
            "  1      1.5\n"
            "  ... 1 more column\n");
  EXPECT_TRUE(text.shortened);
  // Something is shown even where nothing fits.
  EXPECT_NE(table(three, 2, {.width = 1}).lines.find("... 2 more columns"), std::string::npos);
}

TEST(TextTable, ASingleRowIsAList) {
  EXPECT_EQ(table(three, 1).lines,
            "  t          0 s\n"
            "  crank.x  0.5 m\n"
            "  mode       1\n");
  const TextTable::Text text = table(three, 1, {.list_lines = 1});
  EXPECT_EQ(text.lines, "  t  0 s\n  ... 2 more columns\n");
  EXPECT_TRUE(text.shortened);
}

TEST(TextTable, AlignsNamesOfAnyScript) {
  EXPECT_EQ(table({{"Kurbel-ä.x", UnitKind::length}, {"b", UnitKind::length}}, 2).lines,
            "  Kurbel-ä.x    b\n"
            "           m    m\n"
            "           0  0.5\n"
            "           1  1.5\n");
}

TEST(TextTable, NoRowsAndNoColumnsAreFine) {
  EXPECT_EQ(table({}, 3).lines, "");
  EXPECT_EQ(table(three, 0).lines, "  t  crank.x  mode\n  s        m\n");
}

TEST(TextTable, WithoutLimitsEverythingIsShown) {
  std::vector<ColumnInfo> columns;
  for (int k = 0; k < 300; ++k) columns.push_back({"column" + std::to_string(k), UnitKind::length});
  const TextTable::Text text = table(columns, 100, TableLimits::none());
  EXPECT_FALSE(text.shortened);
  EXPECT_EQ(std::count(text.lines.begin(), text.lines.end(), '\n'), 102);
  EXPECT_NE(text.lines.find("column299"), std::string::npos);
}

}  // namespace
}  // namespace catena::testing
