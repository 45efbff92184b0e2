#include "catena/columns/switches.hpp"

#include <algorithm>
#include <charconv>

#include "catena/base/taylor.hpp"
#include "catena/columns/own_columns.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

constexpr std::string_view switch_mark = " switch ", law_mark = "law ";

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

/// Whether a column is one of an element, which `prefix` says, or an own one that is made of one.
bool shows(const Model& model, const std::string& name, const std::string& prefix) {
  if (name.starts_with(prefix)) return true;
  const int own = model.find_own_column(name);
  if (own < 0) return false;
  const std::vector<std::string>& inputs = model.own_columns[static_cast<std::size_t>(own)].inputs;
  return std::any_of(inputs.begin(), inputs.end(),
                     [&](const std::string& input) { return shows(model, input, prefix); });
}

/// Own columns, and behind them the laws of state, by name; -1: none.
int find_formula(const Model& model, std::string_view name) {
  if (const int own = model.find_own_column(name); own >= 0 || !name.starts_with(law_mark)) return own;
  const std::string_view digits = name.substr(law_mark.size());
  int law = -1;
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), law);
  if (error != std::errc() || rest != digits.data() + digits.size()) return -1;
  const auto count = static_cast<int>(model.laws.size());
  return law >= 0 && law < count ? static_cast<int>(model.own_columns.size()) + law : -1;
}

using Spring = SpringDamper<double>;

/// Whether the force keeps its value beyond an end of the curve, 0 the first one, where it has another slope before it.
bool holds_beyond(const Spring& spring, int end) {
  if (!spring.curve || spring.curve.ends()) return false;
  const CurveUse ends = spring.curve.use_at(0);
  const double size = ends.last - ends.first;
  return spring.curve.force(Taylor<double>(end == 0 ? ends.first - size : ends.last + size, 1.0, 0.0)).d == 0;
}

std::string end_of_curve(const Model& model, int element, int end) {
  return model.element_name(element) + std::string(switch_mark) + std::to_string(end);
}

/// "SPRING switch K".
std::optional<NamedColumn> find_end_of_curve(const Model& model, std::string_view name) {
  for (const auto& spring : std::get<std::vector<ElementEntry<Spring, double>>>(model.forces)) {
    for (const int end : {0, 1}) {
      if (holds_beyond(spring.element, end) && name == end_of_curve(model, spring.id, end))
        return NamedColumn{{std::string(name), UnitKind::length, {}}, {ColumnKind::length, spring.id, end}};
    }
  }
  return {};
}

}  // namespace

std::optional<NamedColumn> find_switch(const Model& model, std::string_view name) {
  const std::size_t end = name.rfind(switch_mark);
  if (end == std::string_view::npos) return {};
  if (std::optional<NamedColumn> of_spring = find_end_of_curve(model, name)) return of_spring;
  const int formula = find_formula(model, name.substr(0, end));
  const std::string_view digits = name.substr(end + switch_mark.size());
  int number = -1;
  const auto [rest, error] = std::from_chars(digits.data(), digits.data() + digits.size(), number);
  if (formula < 0 || error != std::errc() || rest != digits.data() + digits.size()) return {};
  if (number < 0 || number >= count_switches(formula_of(model, formula))) return {};
  return NamedColumn{{std::string(name), UnitKind::own, {}}, {ColumnKind::own, formula, number}};
}

std::vector<std::string> switches_of(const Model& model, const std::string& name) {
  std::vector<std::string> seen, names;
  add_switches(model, name, seen, names);
  return names;
}

std::vector<std::string> switches_of_loads(const Model& model, const std::string& name, bool multipliers) {
  std::vector<std::string> names;
  const auto add_gap = [&](int element) {
    const std::string prefix = model.element_name(element) + ".";
    if (multipliers || shows(model, name, prefix)) names.push_back(prefix + "gap");
  };
  for (const auto& cable : std::get<std::vector<ElementEntry<ElasticCable<double>, double>>>(model.forces))
    add_gap(cable.id);
  for (const auto& span : std::get<std::vector<ElementEntry<ElasticRope<double>, double>>>(model.forces)) {
    if (span.element.pieces > 0) add_gap(span.id);
  }
  for (const auto& spring : std::get<std::vector<ElementEntry<Spring, double>>>(model.forces)) {
    if (!multipliers && !shows(model, name, model.element_name(spring.id) + ".")) continue;
    for (const int end : {0, 1}) {
      if (holds_beyond(spring.element, end)) names.push_back(end_of_curve(model, spring.id, end));
    }
  }
  for (std::size_t law = 0; law < model.laws.size(); ++law) {
    if (!multipliers && !shows(model, name, model.element_name(model.laws[law].element) + ".")) continue;
    const int count = count_switches(model.laws[law].formula);
    const std::string own = std::string(law_mark) + std::to_string(law) + std::string(switch_mark);
    for (int k = 0; k < count; ++k) names.push_back(own + std::to_string(k));
  }
  return names;
}

}  // namespace catena
