// Rows and comparisons as lines for a terminal.
#pragma once

#include <string>

#include "documents/comparison.hpp"
#include "documents/document.hpp"

namespace bench {

std::string table_head();
std::string table_line(const Row& row);
/// "12.3 us", "4.56 s": three digits, of a time in s.
std::string time_text(double seconds);
/// What was measured on, and when.
std::string describe(const Document& document);
/// The fitted exponents, one a line.
std::string growth_lines(const std::vector<Row>& rows);
std::string comparison_lines(const Comparison& comparison);

}  // namespace bench
