// A formula over columns of results, compiled: a few instructions of a stack machine whose constants are numbers of the
// scalar S, so that derivatives with respect to design parameters run through it.
//
//   sqrt(vx^2 + vy^2)    =>    vx  2  ^  vy  2  ^  +  sqrt
//
// Parameters are constants here: their values were put in when the model was made, as those of every element were.
// Tables are functions of one operand, p(crank.angle): splines, shared by the formulas that use them.
//
// evaluate() asks for its inputs by number and allocates nothing; the scalar of its inputs may carry more derivatives
// than S. What has no value (0/0, log of a negative number, a place beyond the ends of a table that ends there) comes
// out as a number that is not finite.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "catena/base/operation.hpp"
#include "catena/base/spline.hpp"

namespace catena {

/// A table that formulas use as a function.
template <class S>
struct NamedTable {
  std::string name;
  Spline<S> curve;
};

template <class S>
class Formula {
 public:
  static constexpr std::size_t deepest_stack = 32;
  using Table = std::shared_ptr<const NamedTable<S>>;

  void push_constant(const S& number) { append({Operation::constant, 0, number}, 1); }
  /// The value of input number `index`, from 0.
  void push_input(std::uint32_t index) { append({Operation::column, index, S{}}, 1); }
  /// An operation on the values pushed last.
  void push(Operation operation) {
    const int taken = operands(operation);
    if (taken == 0 || depth_ < taken) throw std::invalid_argument("formula: an operation lacks its operands");
    append({operation, 0, S{}}, 1 - taken);
  }
  /// A table at the value pushed last.
  void push_table(Table table) {
    if (depth_ < 1) throw std::invalid_argument("formula: a table lacks its operand");
    append({Operation::table, static_cast<std::uint32_t>(tables_.size()), S{}}, 0);
    tables_.push_back(std::move(table));
  }
  /// The value of another formula, whose input k is input `inputs[k]` of this one.
  void push_formula(const Formula& other, const std::vector<std::uint32_t>& inputs) {
    const int before = depth_;
    for (const Step& step : other.steps_) {
      if (step.operation == Operation::column) {
        push_input(inputs[step.index]);
      } else if (step.operation == Operation::table) {
        push_table(other.tables_[step.index]);
      } else {
        append(step, step.operation == Operation::constant ? 1 : 1 - operands(step.operation));
      }
    }
    if (depth_ != before + 1) throw std::invalid_argument("formula: a part of it has no value");
  }
  /// This formula with inputs that are formulas themselves: replace(k, result) pushes the value of input k to `result`.
  template <class Replace>
  Formula with_inputs(Replace&& replace) const {
    Formula result;
    for (const Step& step : steps_) {
      if (step.operation == Operation::column) {
        replace(step.index, result);
      } else if (step.operation == Operation::table) {
        result.push_table(tables_[step.index]);
      } else {
        result.append(step, step.operation == Operation::constant ? 1 : 1 - operands(step.operation));
      }
    }
    return result;
  }
  bool empty() const { return steps_.empty(); }
  /// Whether it uses a table that ends: beyond() may then find a place outside.
  bool has_ends() const {
    for (const Table& table : tables_) {
      if (!table->curve.periodic() && table->curve.beyond() == Beyond::error) return true;
    }
    return false;
  }

  /// input(k): the value of input k, of a scalar T that S converts to.
  template <class Input>
  auto evaluate(Input&& input) const {
    using T = std::remove_cvref_t<decltype(input(std::uint32_t{}))>;
    return evaluate_with(input, [](const NamedTable<S>& table, const T& x) {
      if (!table.curve.covers(value_of(x))) return T(std::numeric_limits<double>::quiet_NaN());
      return table.curve.evaluate(x).f;
    });
  }
  /// The same, but tables that end go on along straight lines: for iterations, which come back.
  template <class Input>
  auto evaluate_beyond(Input&& input) const {
    using T = std::remove_cvref_t<decltype(input(std::uint32_t{}))>;
    return evaluate_with(input, [](const NamedTable<S>& table, const T& x) { return table.curve.evaluate(x).f; });
  }
  /// look(table, x) gives the value of a table at x: T.
  template <class Input, class Look>
  auto evaluate_with(Input&& input, Look&& look) const {
    using T = std::remove_cvref_t<decltype(input(std::uint32_t{}))>;
    std::array<T, deepest_stack> stack;
    T* top = stack.data();  // one after the last value
    for (const Step& step : steps_) {
      if (step.operation == Operation::constant) {
        *top++ = T(step.number);
      } else if (step.operation == Operation::column) {
        *top++ = input(step.index);
      } else if (step.operation == Operation::table) {
        top[-1] = look(*tables_[step.index], top[-1]);
      } else if (operands(step.operation) == 1) {
        top[-1] = apply(step.operation, top[-1]);
      } else {
        --top;
        top[-1] = apply(step.operation, top[-1], top[0]);
      }
    }
    return stack[0];
  }

 private:
  struct Step {
    Operation operation;
    std::uint32_t index;  // of an input or table
    S number;             // of a constant
  };
  void append(const Step& step, int change) {
    depth_ += change;
    if (depth_ > static_cast<int>(deepest_stack)) throw std::length_error("formula: nested too deeply");
    steps_.push_back(step);
  }

  std::vector<Step> steps_;
  std::vector<Table> tables_;
  int depth_ = 0;  // values on the stack after the last step
};

}  // namespace catena
