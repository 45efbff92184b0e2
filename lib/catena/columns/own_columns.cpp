#include "catena/columns/own_columns.hpp"

#include <algorithm>

namespace catena {
namespace {

/// Looks up formulas, depth first; `path_` are the own columns that are being looked up.
class OwnLookup {
 public:
  OwnLookup(const Model& model, OwnInputs& inputs) : model_(model), inputs_(inputs) {}

  std::optional<UnknownColumn> find(int own) {
    const OwnColumn<double>& column = model_.own_columns[static_cast<std::size_t>(own)];
    if (std::find(path_.begin(), path_.end(), own) != path_.end()) return circle(own);
    std::vector<Column>& inputs = inputs_[static_cast<std::size_t>(own)];
    if (inputs.size() == column.inputs.size()) return {};  // known, or a formula of constants alone
    path_.push_back(own);
    inputs.clear();
    for (const std::string& name : column.inputs) {
      if (auto unknown = find_input(name)) return unknown;
      inputs_[static_cast<std::size_t>(own)].push_back(found_);
    }
    path_.pop_back();
    return {};
  }

 private:
  std::optional<UnknownColumn> find_input(const std::string& name) {
    std::vector<NamedColumn> named;
    if (auto unknown = find_columns(model_, name, named)) return unknown;
    if (named.size() > 1) {
      return UnknownColumn{name,
                           "it stands for " + std::to_string(named.size()) +
                               " columns, and a formula reads one, such as \"" + named.front().info.name + "\"",
                           {}};
    }
    const Column column = named.front().column;
    if (column.kind == ColumnKind::own) {
      if (auto unknown = find(column.index)) return unknown;
    }
    found_ = column;
    return {};
  }

  UnknownColumn circle(int own) const {
    const std::string& name = model_.own_columns[static_cast<std::size_t>(own)].name;
    std::string chain;
    for (auto member = std::find(path_.begin(), path_.end(), own); member != path_.end(); ++member) {
      chain += model_.own_columns[static_cast<std::size_t>(*member)].name + " -> ";
    }
    return {name, "columns depend on each other in a circle: " + chain + name, {}};
  }

  const Model& model_;
  OwnInputs& inputs_;
  std::vector<int> path_;
  Column found_{};
};

}  // namespace

std::optional<UnknownColumn> find_own_inputs(const Model& model, int own, OwnInputs& inputs) {
  return OwnLookup(model, inputs).find(own);
}

}  // namespace catena
