#include "catena/columns/state_laws.hpp"

#include <algorithm>
#include <tuple>

#include "catena/base/at.hpp"
#include "catena/base/design_scalar.hpp"
#include "catena/columns/column_names.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/attachment.hpp"

namespace catena {
namespace {

/// A law's formula with those of own columns put in.
template <class S>
class Flattening {
 public:
  explicit Flattening(const BasicModel<S>& model) : model_(model) {}

  /// False where own columns are read in a circle, which find_own_inputs() reports.
  bool flatten(StateLaw<S>& law) {
    bool any = false;
    for (const std::string& name : law.names) any = any || model_.find_own_column(name) >= 0;
    if (!any) return true;
    const std::vector<std::string> written = std::move(law.names);
    names_.clear();
    law.formula = put_in(law.formula, written);
    law.names = names_;
    return good_;
  }

 private:
  Formula<S> put_in(const Formula<S>& formula, const std::vector<std::string>& names) {
    return formula.with_inputs([&](std::uint32_t k, Formula<S>& result) {
      const int own = model_.find_own_column(names[k]);
      if (own < 0) {
        result.push_input(number_of(names[k]));
      } else if (std::find(path_.begin(), path_.end(), own) != path_.end()) {
        good_ = false;
        result.push_constant(S(0.0));
      } else {
        path_.push_back(own);
        const OwnColumn<S>& column = model_.own_columns[at(own)];
        const Formula<S> part = put_in(column.formula, column.inputs);
        std::vector<std::uint32_t> same(names_.size());
        for (std::size_t n = 0; n < same.size(); ++n) same[n] = static_cast<std::uint32_t>(n);
        result.push_formula(part, same);
        path_.pop_back();
      }
    });
  }
  std::uint32_t number_of(const std::string& name) {
    const auto known = std::find(names_.begin(), names_.end(), name);
    if (known == names_.end()) names_.push_back(name);
    return static_cast<std::uint32_t>(std::find(names_.begin(), names_.end(), name) - names_.begin());
  }

  const BasicModel<S>& model_;
  std::vector<std::string> names_;
  std::vector<int> path_;
  bool good_ = true;
};

bool reads_spring(ColumnKind kind) { return kind == ColumnKind::tension || kind == ColumnKind::spring_torque; }

/// Whether a column is known before the forces are.
bool is_known_before(ColumnKind kind) {
  switch (kind) {
    case ColumnKind::time:
    case ColumnKind::x:
    case ColumnKind::y:
    case ColumnKind::angle:
    case ColumnKind::vx:
    case ColumnKind::vy:
    case ColumnKind::omega:
    case ColumnKind::joint_angle:
    case ColumnKind::joint_omega:
    case ColumnKind::slide:
    case ColumnKind::slide_rate:
    case ColumnKind::length:
    case ColumnKind::length_rate:
    case ColumnKind::turn:
      return true;
    default:
      return reads_spring(kind);
  }
}

/// Whether it depends on all forces: accelerations, reactions and what is made of them.
bool closes_a_loop(ColumnKind kind) {
  return is_reaction(kind) || kind == ColumnKind::ax || kind == ColumnKind::ay || kind == ColumnKind::alpha;
}

/// The laws that are functions of a force element.
std::vector<int> laws_of(const Model& model, int element) {
  std::vector<int> laws;
  with_entry(model, element, [&](const auto& entry) {
    for (const auto& value : entry.values) {
      if (value.law >= 0) laws.push_back(value.law);
    }
  });
  return laws;
}

class Binding {
 public:
  explicit Binding(Model& model) : model_(model) {}

  std::vector<LawProblem> run() {
    for (std::size_t k = 0; k < model_.laws.size(); ++k) look_up(static_cast<int>(k));
    if (!problems_.empty()) return std::move(problems_);
    state_.assign(model_.laws.size(), State::fresh);
    for (std::size_t k = 0; k < model_.laws.size(); ++k) search(static_cast<int>(k));
    return std::move(problems_);
  }

 private:
  void look_up(int number) {
    StateLaw<double>& law = model_.laws[at(number)];
    law.inputs.clear();
    const std::string law_name = describe_law(model_, number);
    for (const std::string& name : law.names) {
      std::vector<NamedColumn> found;
      if (auto unknown = find_columns(model_, name, found)) {
        problems_.push_back(
            {number, name, "unknown column \"" + name + "\": " + unknown->message, std::move(unknown->candidates)});
        continue;
      }
      if (found.size() > 1) {
        problems_.push_back({number,
                             name,
                             "\"" + name + "\" stands for " + std::to_string(found.size()) +
                                 " columns, and an expression reads one, such as \"" + found.front().info.name + "\"",
                             {}});
        continue;
      }
      const Column column = found.front().column;
      if (closes_a_loop(column.kind)) {
        problems_.push_back({number,
                             name,
                             "an algebraic loop: " + law_name + " -> " + name + " -> " + law_name +
                                 ": reactions and accelerations follow from all forces, this one among them",
                             {}});
      } else if (!is_known_before(column.kind) || is_of_rope(column)) {
        problems_.push_back({number,
                             name,
                             "a force cannot read " + name +
                                 ": places, angles, velocities, lengths and the forces of springs "
                                 "are known where forces are computed",
                             {}});
      }
      law.inputs.push_back(column);
    }
  }

  /// The force of an elastic rope is one of all its stretches, and is not looked up here.
  bool is_of_rope(const Column& column) const {
    return reads_spring(column.kind) && model_.element_type(column.index) == ElasticRope<double>::type;
  }

  /// Depth first through the springs whose forces are laws.
  void search(int law) {
    if (state_[at(law)] == State::done) return;
    if (state_[at(law)] == State::open) return report_circle(law);
    state_[at(law)] = State::open;
    path_.push_back(law);
    const StateLaw<double>& reader = model_.laws[at(law)];
    for (std::size_t k = 0; k < reader.inputs.size(); ++k) {
      if (!reads_spring(reader.inputs[k].kind)) continue;
      through_.push_back(reader.names[k]);
      for (const int other : laws_of(model_, reader.inputs[k].index)) search(other);
      through_.pop_back();
    }
    path_.pop_back();
    state_[at(law)] = State::done;
  }

  void report_circle(int law) {
    auto member = static_cast<std::size_t>(std::find(path_.begin(), path_.end(), law) - path_.begin());
    const std::string input = through_[member];
    std::string chain;
    for (; member < path_.size(); ++member)
      chain += describe_law(model_, path_[member]) + " -> " + through_[member] + " -> ";
    problems_.push_back({law, input, "an algebraic loop: " + chain + describe_law(model_, law), {}});
  }

  enum class State : char { fresh, open, done };
  Model& model_;
  std::vector<LawProblem> problems_;
  std::vector<State> state_;
  std::vector<int> path_;
  std::vector<std::string> through_;
};

}  // namespace

void set_state_law(Model& model, int element, int place, Formula<double> formula, std::vector<std::string> names) {
  bool found = false;
  if (element >= 0 && element < static_cast<int>(model.elements.size()) &&
      model.elements[at(element)].kind == ElementKind::force) {
    const ElementRecord& record = model.elements[at(element)];
    with_list(model.forces, record.type, [&](auto& list) {
      auto& values = list[at(record.index)].values;
      if (place < 0 || place >= static_cast<int>(values.size())) return;
      values[at(place)] = {.law = static_cast<int>(model.laws.size())};
      found = true;
    });
  }
  if (!found) throw ModelError("a law of state belongs to a force element and one of its functions");
  model.laws.push_back({element, place, std::move(formula), std::move(names), {}});
}

template <class S>
std::vector<LawProblem> complete_state_laws(BasicModel<S>& model) {
  std::vector<LawProblem> problems;
  for_each_list(model.forces, [&](const auto& list, int) {
    for (const auto& entry : list) {
      for (std::size_t k = 0; k < entry.values.size(); ++k) {
        if (entry.values[k].law < 0) continue;
        StateLaw<S>& law = model.laws[at(entry.values[k].law)];
        law.element = entry.id;
        law.place = static_cast<int>(k);
      }
    }
  });
  Flattening<S> flattening(model);
  for (std::size_t k = 0; k < model.laws.size(); ++k) {
    try {
      if (!flattening.flatten(model.laws[k]))
        problems.push_back({static_cast<int>(k), {}, "it reads columns that depend on each other in a circle", {}});
    } catch (const std::length_error&) {
      problems.push_back(
          {static_cast<int>(k), {}, "with the columns that it reads this expression is nested too deeply", {}});
    }
  }
  return problems;
}

template std::vector<LawProblem> complete_state_laws(Model&);
template std::vector<LawProblem> complete_state_laws(BasicModel<DesignScalar>&);

std::vector<LawProblem> bind_state_laws(Model& model) {
  if (model.laws.empty()) return {};
  std::vector<LawProblem> problems = complete_state_laws(model);
  if (!problems.empty()) return problems;
  return Binding(model).run();
}

std::string describe_law(const Model& model, int law) {
  const StateLaw<double>& described = model.laws[at(law)];
  std::string_view key = "force";
  with_entry(model, described.element, [&](const auto& entry) {
    using E = typename std::remove_cvref_t<decltype(entry)>::Element;
    const auto look = [&](const auto& field) {
      if constexpr (requires {
                      field.omitted;
                      field.index;
                    }) {
        if (field.index == described.place) key = field.key;
      }
    };
    std::apply([&](const auto&... field) { (look(field), ...); }, E::fields());
  });
  return "\"" + std::string(key) + "\" of " + std::string(model.element_type(described.element)) + " \"" +
         model.element_name(described.element) + "\"";
}

}  // namespace catena
