#include "catena/columns/switches.hpp"

#include <algorithm>
#include <charconv>

namespace catena {
namespace {

constexpr std::string_view switch_mark = " switch ";

int count_switches(const Formula<double>& formula) {
  SwitchNotes<double> notes;
  note_switches(
      formula, [](std::uint32_t) { return 0.0; }, notes);
  return notes.count;
}

void add_switches(const Model& model, const std::string& name, std::vector<std::string>& seen,
                  std::vector<std::string>& out) {
  const int own = model.find_own_column(name);
  if (own < 0 || std::find(seen.begin(), seen.end(), name) != seen.end()) return;
  seen.push_back(name);
  const OwnColumn<double>& column = model.own_columns[static_cast<std::size_t>(own)];
  for (const std::string& input : column.inputs) add_switches(model, input, seen, out);
  const int count = count_switches(column.formula);
  for (int k = 0; k < count; ++k) out.push_back(name + std::string(switch_mark) + std::to_string(k));
}

}  // namespace

std::optional<NamedColumn> find_switch(const Model& model, std::string_view name) {
  const std::size_t end = name.rfind(switch_mark);
  if (end == std::string_view::npos) return {};
  const int own = model.find_own_column(name.substr(0, end));
  const std::string_view digits = name.substr(end + switch_mark.size());
  int number = -1;
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (own < 0 || error != std::errc() || rest != digits.data() + digits.size()) return {};
  if (number < 0 || number >= count_switches(model.own_columns[static_cast<std::size_t>(own)].formula)) return {};
  return NamedColumn{{std::string(name), UnitKind::own, {}}, {ColumnKind::own, own, number}};
}

std::vector<std::string> switches_of(const Model& model, const std::string& name) {
  std::vector<std::string> seen, names;
  add_switches(model, name, seen, names);
  return names;
}

}  // namespace catena
