// Values and names of a scene for one set of parameters and replicate variables; a number without a value is reported
// at its place, with the values of the variables, and becomes NaN, so that later errors are found as well.
#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "catena/scene/json/diagnostic.hpp"
#include "catena/scene/numbers/name_template.hpp"
#include "catena/scene/numbers/number_value.hpp"

namespace catena {

/// Reports an error at byte `place` of the source: `message`, then "(at k = 3)" for the replicate variables. In a
/// repeated block a place is reported once.
void report_in_block(const SourceText& source, std::size_t place, std::string_view message,
                     std::span<const std::string> loop_names, std::span<const double> loop_values,
                     Diagnostics& diagnostics);

/// The same for an error met in an evaluation: `position` is a byte in the text of the JSON string at `offset`.
inline void report_evaluation(const SourceText& source, std::size_t offset, std::size_t position,
                              std::string_view message, std::span<const std::string> loop_names,
                              std::span<const double> loop_values, Diagnostics& diagnostics) {
  report_in_block(source, source.offset_in_string(offset, position), message, loop_names, loop_values, diagnostics);
}

template <class S>
class Evaluation {
 public:
  /// All of these but the tables must outlive the evaluation; `parameters` in the order of their names.
  Evaluation(const SourceText& source, const ExpressionPool& pool, std::span<const S> parameters,
             Diagnostics& diagnostics, std::vector<typename Formula<S>::Table> tables = {})
      : source_(source), pool_(pool), parameters_(parameters), diagnostics_(diagnostics), tables_(std::move(tables)) {
    for (const S& value : parameters) plain_parameters_.push_back(value_of(value));
  }

  /// Blocks from the outermost in, as the reader saw them.
  void enter_block(std::string_view variable) {
    loop_names_.emplace_back(variable);
    loop_values_.push_back(0);
  }
  void leave_block() {
    loop_names_.pop_back();
    loop_values_.pop_back();
  }
  /// The value of the innermost block's variable.
  void set_variable(double value) { loop_values_.back() = value; }

  S operator()(const NumberValue& value) const {
    try {
      return evaluate<S>(value, pool_, parameters_, loop_values_, tables_);
    } catch (const ExpressionError& error) {
      // One byte for the "=" before the expression.
      report_evaluation(source_, value.offset(), error.position + 1, error.what(), loop_names_, loop_values_,
                        diagnostics_);
      return S(std::numeric_limits<double>::quiet_NaN());
    }
  }

  /// Appends a name from the JSON string at `offset`; false, with a report, if it has no value.
  bool append_name(const NameTemplate& name, std::size_t offset, std::string& out) const {
    try {
      name.append_to(out, plain_parameters_, loop_values_);
      return true;
    } catch (const ExpressionError& error) {
      report_evaluation(source_, offset, error.position, error.what(), loop_names_, loop_values_, diagnostics_);
      return false;
    }
  }

  std::span<const std::string> loop_names() const { return loop_names_; }
  std::span<const double> loop_values() const { return loop_values_; }
  TableSet<S> tables() const { return tables_; }

 private:
  const SourceText& source_;
  const ExpressionPool& pool_;
  std::span<const S> parameters_;
  std::vector<double> plain_parameters_;  // names are made of plain numbers
  Diagnostics& diagnostics_;
  std::vector<typename Formula<S>::Table> tables_;
  std::vector<std::string> loop_names_;
  std::vector<double> loop_values_;
};

}  // namespace catena
