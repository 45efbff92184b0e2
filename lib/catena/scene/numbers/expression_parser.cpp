#include <fmt/format.h>

#include <algorithm>
#include <numbers>

#include "catena/scene/json/diagnostic.hpp"
#include "catena/scene/json/near_miss.hpp"
#include "catena/scene/json/utf8.hpp"
#include "catena/scene/numbers/decimal.hpp"
#include "catena/scene/numbers/expression.hpp"
#include "catena/scene/numbers/expression_functions.hpp"

namespace catena {

/// Recursive descent, one function a rank; instructions are appended in the order of evaluation.
class ExpressionParser {
 public:
  ExpressionParser(std::string_view text, const ExpressionScope& scope) : text_(text), scope_(scope) {}

  Parsed<Expression> parse() {
    if (!sum()) return error_;
    if (at_ < text_.size()) return after_operand();
    return std::move(expression_);
  }

 private:
  static constexpr int deepest = 64;

  void skip_blanks() {
    while (at_ < text_.size() &&
           (text_[at_] == ' ' || text_[at_] == '\t' || text_[at_] == '\n' || text_[at_] == '\r')) {
      ++at_;
    }
  }
  bool next_is(char c) {
    skip_blanks();
    return at_ < text_.size() && text_[at_] == c;
  }
  bool take(char c) {
    const bool there = next_is(c);
    if (there) ++at_;
    return there;
  }
  bool fail(std::size_t position, std::string message) {
    error_ = {position, std::move(message)};
    return false;
  }

  bool emit(Operation operation, std::size_t position, int stack_change, double number = 0) {
    Instruction instruction{operation, static_cast<std::uint32_t>(position), {}};
    instruction.number = number;
    return emit(instruction, stack_change);
  }
  bool emit(const Instruction& instruction, int stack_change) {
    expression_.code_.push_back(instruction);
    stack_ += stack_change;
    if (stack_ <= static_cast<int>(Expression::deepest_stack)) return true;
    return fail(instruction.position, "this expression is nested too deeply; give a part of it a parameter");
  }

  bool sum() {
    if (!product()) return false;
    for (;;) {
      const bool plus = next_is('+');
      if (!plus && !next_is('-')) return true;
      const std::size_t position = at_++;
      if (!product() || !emit(plus ? Operation::add : Operation::subtract, position, -1)) return false;
    }
  }

  bool product() {
    if (!sign()) return false;
    for (;;) {
      const bool times = next_is('*');
      if (!times && !next_is('/')) return true;
      const std::size_t position = at_++;
      if (times && next_is('*')) return fail(position, "write ^ for a power");
      if (!sign() || !emit(times ? Operation::multiply : Operation::divide, position, -1)) return false;
    }
  }

  bool sign() {
    if (depth_ >= deepest) return fail(at_, "this expression is nested too deeply; give a part of it a parameter");
    ++depth_;
    bool good = false;
    const bool minus = next_is('-');
    if (minus || next_is('+')) {
      const std::size_t position = at_++;
      good = sign() && (!minus || emit(Operation::negate, position, 0));
    } else {
      good = raised();
    }
    --depth_;
    return good;
  }

  bool raised() {
    if (!operand()) return false;
    if (!next_is('^')) return true;
    const std::size_t position = at_++;
    return sign() && emit(Operation::power, position, -1);
  }

  bool operand() {
    skip_blanks();
    if (at_ >= text_.size())
      return fail(at_, text_.empty() ? "expected an expression" : "the expression is incomplete");
    const std::size_t begin = at_;
    if (take('(')) return sum() && (take(')') || missing_bracket(begin));
    if (is_digit(text_[at_]) || text_[at_] == '.') return number();
    if (starts_name(text_[at_])) return name();
    if (text_[at_] == '\'' && scope_.columns) return column(begin);
    return unexpected();
  }

  /// The rest of a column's name, whose first part was read or stands here: parts between dots, each an identifier or
  /// anything in single quotes.
  bool column(std::size_t begin, std::string name = {}) {
    while (name.empty() || take_dot()) {
      if (!name.empty()) name += '.';
      if (at_ < text_.size() && text_[at_] == '\'') {
        const std::size_t end = text_.find('\'', at_ + 1);
        if (end == std::string_view::npos) return fail(at_, "this quote is not closed");
        if (end == at_ + 1) return fail(at_, "a name is missing between these quotes");
        name += text_.substr(at_ + 1, end - at_ - 1);
        at_ = end + 1;
      } else if (at_ < text_.size() && starts_name(text_[at_])) {
        name += word();
      } else {
        return fail(at_, "a name is missing after the dot");
      }
    }
    std::vector<NamedInput>& columns = *scope_.columns;
    const auto known = std::find_if(columns.begin(), columns.end(), [&](const auto& c) { return c.name == name; });
    Instruction load{Operation::column, static_cast<std::uint32_t>(begin), {}};
    load.index = static_cast<std::uint32_t>(known - columns.begin());
    if (known == columns.end()) columns.push_back({std::move(name), begin});
    return emit(load, 1);
  }
  bool take_dot() {
    const bool there = at_ < text_.size() && text_[at_] == '.';
    if (there) ++at_;
    return there;
  }

  bool number() {
    const std::size_t begin = at_;
    const Decimal number = read_decimal(text_.substr(begin));
    if (number.length == 0) return unexpected();
    if (number.too_large) return fail(begin, "this number is too large");
    at_ += number.length;
    return emit(Operation::constant, begin, 1, number.value);
  }

  std::string_view word() {
    const std::size_t begin = at_;
    while (at_ < text_.size() && (starts_name(text_[at_]) || is_digit(text_[at_]))) ++at_;
    return text_.substr(begin, at_ - begin);
  }

  bool name() {
    const std::size_t begin = at_;
    const std::string_view found = word();
    const bool dotted = at_ < text_.size() && text_[at_] == '.';
    if (scope_.columns && dotted) return column(begin, std::string(found));
    if (const ExpressionFunction* function = find_function(found)) return call(*function, begin);
    if (const int table = scope_.parameters ? scope_.parameters->find_table(found) : -1; table >= 0)
      return call_table(table, found, begin);
    if (found == "pi") return emit(Operation::constant, begin, 1, std::numbers::pi);
    Instruction load{Operation::loop_variable, static_cast<std::uint32_t>(begin), {}};
    for (std::size_t i = scope_.loop_variables.size(); i-- > 0;) {
      if (scope_.loop_variables[i] != found) continue;
      load.index = static_cast<std::uint32_t>(i);
      return emit(load, 1);
    }
    const int parameter = scope_.parameters ? scope_.parameters->find(found) : -1;
    if (scope_.columns && parameter < 0 && next_after_blanks() != '(') return column(begin, std::string(found));
    if (parameter < 0) return fail(begin, unknown_name(found));
    load.operation = Operation::parameter;
    load.index = static_cast<std::uint32_t>(parameter);
    return emit(load, 1);
  }

  std::string unknown_name(std::string_view found) const {
    if (next_after_blanks() == '(') {
      NearMiss near(found);
      for (const ExpressionFunction& function : expression_functions) near.consider(function.name);
      if (scope_.parameters) near.consider_all(scope_.parameters->tables());
      return "unknown function " + in_quotes(found) + near.hint();
    }
    NearMiss near(found);
    near.consider_all(scope_.loop_variables);
    if (scope_.parameters) near.consider_all(scope_.parameters->all());
    near.consider("pi");
    return "unknown parameter " + in_quotes(found) + near.hint();
  }

  char next_after_blanks() const {
    const std::size_t next = text_.find_first_not_of(' ', at_);
    return next == std::string_view::npos ? '\0' : text_[next];
  }

  bool call(const ExpressionFunction& function, std::size_t begin) {
    const std::size_t bracket = at_;
    if (!take('(')) return fail(begin, fmt::format("{0} is a function: write {0}(...)", function.name));
    if (!sum()) return false;
    int values = 1;
    const bool more_allowed = function.operation == Operation::min || function.operation == Operation::max;
    while (take(',')) {
      if (!sum()) return false;
      ++values;
      // min and max of many values are taken two by two as they come.
      if (more_allowed && !emit(function.operation, begin, -1)) return false;
    }
    if (!take(')')) return missing_bracket(bracket);
    if (values < function.values || (values > function.values && !more_allowed)) {
      return fail(begin, fmt::format("{} takes {}{} value{}, not {}", function.name, more_allowed ? "at least " : "",
                                     function.values, function.values == 1 ? "" : "s", values));
    }
    return more_allowed || emit(function.operation, begin, 1 - values);
  }

  bool call_table(int table, std::string_view table_name, std::size_t begin) {
    const std::size_t bracket = at_;
    if (!take('(')) return fail(begin, fmt::format("{0} is a table: write {0}(...)", table_name));
    if (!sum()) return false;
    if (next_is(',')) return fail(begin, fmt::format("the table {} takes one value", table_name));
    if (!take(')')) return missing_bracket(bracket);
    Instruction look_up{Operation::table, static_cast<std::uint32_t>(begin), {}};
    look_up.index = static_cast<std::uint32_t>(table);
    return emit(look_up, 0);
  }

  bool missing_bracket(std::size_t opened) {
    if (at_ >= text_.size()) return fail(opened, "this ( is not closed");
    after_operand();
    return false;
  }

  /// An operand is complete, but what follows is no operator.
  TextError after_operand() {
    skip_blanks();
    const char c = text_[at_];
    if (c == ')') {
      fail(at_, "this ) was never opened");
    } else if (is_digit(c) || c == '.' || c == '(' || (starts_name(c) && static_cast<unsigned char>(c) < 0x80)) {
      const bool unit = starts_name(c) && at_ > 0 && is_digit(text_[text_.find_last_not_of(' ', at_ - 1)]);
      fail(at_, unit ? "expected an operator here; numbers in an expression have no units, they are SI and radians"
                     : "expected an operator here");
    } else {
      unexpected();
    }
    return error_;
  }

  bool unexpected() {
    const auto bytes = static_cast<std::size_t>(next_code_point(text_, at_).bytes);
    return fail(at_, "unexpected " + in_quotes(text_.substr(at_, bytes)) + " in an expression");
  }

  std::string_view text_;
  ExpressionScope scope_;
  Expression expression_;
  TextError error_;
  std::size_t at_ = 0;
  int stack_ = 0;  // values waiting at this point of the evaluation
  int depth_ = 0;  // of recursion
};

Parsed<Expression> Expression::parse(std::string_view text, const ExpressionScope& scope) {
  return ExpressionParser(text, scope).parse();
}

}  // namespace catena
