// The names of a scene's parameters, numbered in file order, and what is known of their units; and the names of its
// tables, which are functions in expressions. Expressions hold the numbers.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "catena/scene/numbers/unit.hpp"

namespace catena {

class ParameterNames {
 public:
  /// Adds a name and returns its number; a name that exists keeps its number.
  int add(std::string_view name) {
    const auto [place, added] = index_.try_emplace(std::string(name), static_cast<int>(names_.size()));
    if (added) {
      names_.emplace_back(name);
      dimensions_.emplace_back();
      asked_.emplace_back();
    }
    return place->second;
  }
  /// The number of a name, -1 if there is none.
  int find(std::string_view name) const {
    const auto place = index_.find(name);
    return place == index_.end() ? -1 : place->second;
  }
  std::span<const std::string> all() const { return names_; }
  std::size_t size() const { return names_.size(); }

  void add_table(std::string_view name) { tables_.emplace_back(name); }
  /// The number of a table, -1 if there is none of this name.
  int find_table(std::string_view name) const {
    for (std::size_t k = 0; k < tables_.size(); ++k) {
      if (tables_[k] == name) return static_cast<int>(k);
    }
    return -1;
  }
  std::span<const std::string> tables() const { return tables_; }

  /// The dimension of a parameter given as a quantity; unknown for plain numbers and expressions.
  const std::optional<Dimension>& dimension(int index) const { return dimensions_[static_cast<std::size_t>(index)]; }
  void set_dimension(int index, const std::optional<Dimension>& dimension) {
    dimensions_[static_cast<std::size_t>(index)] = dimension;
  }
  /// What a value that takes the place of the given one must be: the parameter's dimension, or what the first field
  /// that names it asks for. Unknown where only expressions use it.
  const std::optional<Dimension>& dimension_of_value(int index) const {
    const auto& own = dimension(index);
    return own ? own : asked_[static_cast<std::size_t>(index)];
  }
  /// A field that names a parameter asks for this; noted while scenes are read.
  void note_use(int index, const std::optional<Dimension>& dimension) const {
    auto& asked = asked_[static_cast<std::size_t>(index)];
    if (!asked) asked = dimension;
  }

 private:
  std::vector<std::string> names_, tables_;
  std::vector<std::optional<Dimension>> dimensions_;
  mutable std::vector<std::optional<Dimension>> asked_;
  std::map<std::string, int, std::less<>> index_;
};

}  // namespace catena
