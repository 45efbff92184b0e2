// Numbers as text: exact for files, rounded for people. Locale independent.
#pragma once

#include <span>
#include <string>
#include <vector>

namespace catena {

/// Appends the shortest text that reads back as the same double; nothing for a number that is not finite.
void append_exact(std::string& out, double value);

/// The numbers of a column for readers: the same number of decimals for all, six significant digits of the largest
/// (rounding errors beside it then read 0), common trailing zeros removed; "-" for a number that is not finite.
/// `errors`: of the values, 0 where they are not known: no digit is shown that may be wrong by more than half a unit.
std::vector<std::string> format_column(std::span<const double> values, std::span<const double> errors = {});

/// One number with six significant digits.
std::string format_number(double value);

}  // namespace catena
