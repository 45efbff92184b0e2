// Which numbers a field accepts: the test, and its words for messages and the schema.
#pragma once

#include <string>
#include <string_view>

#include "catena/elements/field.hpp"

namespace catena {

/// A NaN fits every domain: its error was reported already.
constexpr bool fits(double value, Domain domain) {
  switch (domain) {
    case Domain::any:
      return true;
    case Domain::positive:
      return !(value <= 0);
    case Domain::not_negative:
      return !(value < 0);
    case Domain::not_zero:
      return value != 0;
  }
  return true;
}

/// `above zero`.
constexpr std::string_view wanted(Domain domain) {
  switch (domain) {
    case Domain::any:
      break;
    case Domain::positive:
      return "above zero";
    case Domain::not_negative:
      return "zero or above";
    case Domain::not_zero:
      return "other than zero";
  }
  return "any number";
}

/// `must be above zero; it is -3`.
std::string out_of_domain(double value, Domain domain);

}  // namespace catena
