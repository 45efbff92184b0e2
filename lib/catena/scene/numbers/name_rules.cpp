#include "catena/scene/numbers/name_rules.hpp"

#include <algorithm>
#include <array>

#include "catena/model/column_rules.hpp"
#include "catena/scene/json/diagnostic.hpp"
#include "catena/scene/numbers/expression.hpp"

namespace catena {
namespace {

constexpr std::array<std::string_view, 5> taken{"ground", "t", "energy", "momentum", "residual"};

std::string character_problem(std::string_view name) {
  if (name.empty()) return "a name may not be empty";
  if (name.front() == ' ' || name.back() == ' ') {
    return "the name " + in_quotes(name) + " may not begin or end with a blank";
  }
  for (const char c : name) {
    const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
    if (control) return "the name " + in_quotes(name) + " may not have control characters";
    if (c == '.' || c == '{' || c == '}' || c == '#') {
      return "the name " + in_quotes(name) + " may not have a " + std::string(1, c);
    }
  }
  return {};
}

template <class List>
bool contains(const List& list, std::string_view name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

}  // namespace

std::string element_name_problem(std::string_view name) {
  if (contains(taken, name)) return "the name " + in_quotes(name) + " is taken; choose another";
  return character_problem(name);
}

std::string point_name_problem(std::string_view name) {
  if (std::any_of(body_kinds.begin(), body_kinds.end(), [&](const NamedKind& kind) { return kind.name == name; })) {
    return "a point may not be called " + in_quotes(name) + ": that is a column of every body";
  }
  return character_problem(name);
}

std::string parameter_name_problem(std::string_view name) {
  if (is_expression_word(name)) return "the name " + in_quotes(name) + " is taken by expressions; choose another";
  if (is_identifier(name)) return {};
  return "the parameter name " + in_quotes(name) +
         " cannot stand in an expression; use letters, digits and _, no digit first";
}

}  // namespace catena
