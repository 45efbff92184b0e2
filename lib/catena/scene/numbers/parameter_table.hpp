// The parameters of a scene: their definitions in any order, the order in which they can be evaluated, their values.
//
//   "parameters": {"crank": 0.1, "rod": "=3*crank", "speed": {"value": "60 rpm", "min": 0, "max": "=10*pi"}}
//
// A circle of definitions is reported once, as the chain of names "a -> b -> a". Values are computed with any scalar:
// a seed gives a parameter its value (and derivatives) in place of its definition; all dependent parameters follow. Of
// a = 2, b = "=a^2" the derivatives by both count in b: db/da = 2 a, db/db = 1.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/scene/numbers/evaluation.hpp"
#include "catena/scene/numbers/number_reader.hpp"
#include "catena/scene/numbers/table_function.hpp"

namespace catena {

/// A value that stands in for the definition of parameter `index`; or, added to it, derivatives beside its own.
template <class S>
struct ParameterSeed {
  int index;
  S value;
  bool added = false;  ///< the value is that of the definition, whose derivatives count too
};

class ParameterTable {
 public:
  /// Reads the object "parameters". Errors are reported; parameters with errors exist and are NaN, so that expressions
  /// which use them give no further errors.
  /// Without an object there are none. Where `tables` are named, they are defined next.
  static ParameterTable read(const JsonValue& object, ExpressionPool& pool, Diagnostics& diagnostics,
                             std::span<const std::string> tables = {});
  /// The tables in the order of their names. Parameters and the entries of tables may depend on each other, in no
  /// circle.
  void define_tables(std::vector<TableFunction> tables, const ExpressionPool& pool, Diagnostics& diagnostics);

  /// Replaces definitions by those of an object {"P": 3, ...}: the key `set` of an analysis, --set of a command line.
  /// min and max stay. An unknown name is an error. The object's source must outlive the table.
  void set(const JsonValue& object, ExpressionPool& pool, Diagnostics& diagnostics);

  const ParameterNames& names() const { return names_; }
  /// The tables at these values of all parameters; null where one could not be made.
  template <class S>
  std::vector<typename Formula<S>::Table> tables(const ExpressionPool& pool, std::span<const S> parameters) const;
  std::span<const TableFunction> table_functions() const { return tables_; }
  /// What a parameter is given as.
  const NumberValue& definition(int index) const { return definitions_[static_cast<std::size_t>(index)].value; }
  /// min and max of a parameter at these values of all; infinite where it has none.
  std::pair<double, double> limits(int index, const ExpressionPool& pool, std::span<const double> values) const;

  /// All values, in the order of names(). Values that do not exist or lie outside min and max are reported and NaN.
  template <class S>
  std::vector<S> evaluate(const ExpressionPool& pool, Diagnostics& diagnostics,
                          std::span<const ParameterSeed<S>> seeds = {}) const;

 private:
  struct Definition {
    NumberValue value;
    std::optional<NumberValue> least, greatest;
    const SourceText* source = nullptr;        // of the value
    const SourceText* limit_source = nullptr;  // of min and max
  };

  void read_definition(int index, const JsonValue& value, NumberReader& reader, Diagnostics& diagnostics);
  void find_order(const ExpressionPool& pool, Diagnostics& diagnostics);
  /// The parameters on which the value of one depends.
  std::vector<int> needs(int index, const ExpressionPool& pool) const;
  /// The tables that the definition of one uses.
  std::vector<int> used_tables(int index, const ExpressionPool& pool) const;
  void report_circle(std::span<const int> circle, Diagnostics& diagnostics) const;
  /// False, with a report, if `value` of parameter `index` is outside its limits.
  bool check_limits(int index, double value, std::span<const double> values, const ExpressionPool& pool,
                    Diagnostics& diagnostics) const;
  static void report(const ExpressionError& error, const NumberValue& value, const SourceText& source,
                     Diagnostics& diagnostics);

  ParameterNames names_;
  std::vector<Definition> definitions_;
  std::vector<TableFunction> tables_;
  std::vector<int> order_;  // every parameter after those it needs; members of circles are left out
};

template <class S>
std::vector<typename Formula<S>::Table> ParameterTable::tables(const ExpressionPool& pool,
                                                               std::span<const S> parameters) const {
  std::vector<typename Formula<S>::Table> made;
  for (const TableFunction& table : tables_) made.push_back(try_to_make<S>(table, pool, parameters));
  return made;
}

template <class S>
std::vector<S> ParameterTable::evaluate(const ExpressionPool& pool, Diagnostics& diagnostics,
                                        std::span<const ParameterSeed<S>> seeds) const {
  const S nothing(std::numeric_limits<double>::quiet_NaN());
  std::vector<S> values(definitions_.size(), nothing);
  std::vector<const ParameterSeed<S>*> seeded(definitions_.size(), nullptr);
  for (const ParameterSeed<S>& seed : seeds) seeded[static_cast<std::size_t>(seed.index)] = &seed;
  std::vector<typename Formula<S>::Table> tables(tables_.size());  // made when the first parameter uses them
  for (const int index : order_) {
    const auto i = static_cast<std::size_t>(index);
    for (const int used : tables_.empty() ? std::vector<int>() : used_tables(index, pool)) {
      auto& table = tables[static_cast<std::size_t>(used)];
      if (!table) table = try_to_make<S>(tables_[static_cast<std::size_t>(used)], pool, values);
    }
    const Definition& definition = definitions_[i];
    if (seeded[i] && !seeded[i]->added) {
      values[i] = seeded[i]->value;
      continue;
    }
    try {
      values[i] = catena::evaluate<S>(definition.value, pool, values, {}, tables);
      if (seeded[i]) values[i] += seeded[i]->value - S(value_of(seeded[i]->value));
    } catch (const ExpressionError& error) {
      report(error, definition.value, *definition.source, diagnostics);
    }
  }
  std::vector<double> plain(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) plain[i] = value_of(values[i]);
  for (std::size_t i = 0; i < values.size(); ++i) {
    if (!check_limits(static_cast<int>(i), plain[i], plain, pool, diagnostics)) values[i] = nothing;
  }
  return values;
}

}  // namespace catena
