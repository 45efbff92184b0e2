// ModelBuilder: the scene's tables, and laws of state.
#include <fmt/format.h>

#include "catena/base/design_scalar.hpp"
#include "catena/columns/state_laws.hpp"
#include "catena/elements/all.hpp"
#include "catena/scene/building/model_builder.hpp"
#include "catena/scene/json/near_miss.hpp"

namespace catena {

template <class S>
void ModelBuilder<S>::check_tables() {
  const std::span<const TableFunction> tables = scene_.parameters.table_functions();
  for (std::size_t k = 0; k < tables.size(); ++k) {
    const TableFunction& table = tables[k];
    // Lists of different lengths were reported by the reader.
    if (evaluation_.tables()[k] || table.x.size() != table.y.size()) continue;
    const auto place = table.place.offset();
    try {
      // An entry without a value was reported, or is reported here.
      bool known = true;
      for (const std::vector<NumberValue>* list : {&table.x, &table.y}) {
        for (const NumberValue& number : *list) known = known && !std::isnan(value_of(value(number)));
      }
      if (known) make_table<S>(table, scene_.expressions, parameters_);
    } catch (const std::invalid_argument& error) {
      if (!diagnostics_.reported(*scene_.source, place))
        report(place, fmt::format("table {} is no curve: {}", in_quotes(table.name), error.what()));
    }
  }
}

template <class S>
int ModelBuilder<S>::state_law(const StateLawTemplate& source) {
  StateLaw<S> law;
  law.formula = source.expression.template formula<S>(parameters_, evaluation_.loop_values(), evaluation_.tables());
  for (std::size_t k = 0; k < source.inputs.size(); ++k) {
    std::string name = source.inputs[k].name;
    if (const int pattern = source.patterns[k]; pattern >= 0) {
      name.clear();
      if (!evaluation_.append_name(scene_.patterns[static_cast<std::size_t>(pattern)], source.place.offset(), name))
        return -1;
    }
    law.names.push_back(std::move(name));
  }
  model_.laws.push_back(std::move(law));
  law_source_.push_back(&source);
  return static_cast<int>(model_.laws.size()) - 1;
}

template <class S>
void ModelBuilder<S>::bind_laws() {
  if (model_.laws.empty() || !diagnostics_.ok()) return;
  std::vector<LawProblem> problems;
  if constexpr (std::is_same_v<S, double>) {
    problems = bind_state_laws(model_);
  } else {
    problems = complete_state_laws(model_);
  }
  for (const LawProblem& problem : problems) {
    const StateLawTemplate& source = *law_source_[static_cast<std::size_t>(problem.law)];
    std::size_t position = 0;
    for (const NamedInput& input : source.inputs) {
      if (input.name == problem.input) position = input.position + 1;
    }
    std::string message = problem.message;
    if (!problem.candidates.empty()) message += NearMiss(problem.input).consider_all(problem.candidates).hint();
    const JsonValue& text = source.place;
    const std::size_t place = position == 0 ? text.offset() : text.source().offset_in_string(text.offset(), position);
    if (!diagnostics_.full() && !diagnostics_.reported(text.source(), place))
      diagnostics_.error(text.source(), place, std::move(message));
  }
}

// Instantiated member by member: the rest of the class is in other files.
template void ModelBuilder<double>::check_tables();
template int ModelBuilder<double>::state_law(const StateLawTemplate&);
template void ModelBuilder<double>::bind_laws();
template void ModelBuilder<Dual<double, 4>>::check_tables();
template int ModelBuilder<Dual<double, 4>>::state_law(const StateLawTemplate&);
template void ModelBuilder<Dual<double, 4>>::bind_laws();

}  // namespace catena
