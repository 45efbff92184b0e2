// A formula over columns of results, compiled: a few instructions of a stack machine whose constants are numbers of the
// scalar S, so that derivatives with respect to design parameters run through it.
//
//   sqrt(vx^2 + vy^2)    =>    vx  2  ^  vy  2  ^  +  sqrt
//
// Parameters are constants here: their values were put in when the model was made, as those of every element were.
// evaluate() asks for its inputs by number and allocates nothing. What has no value (0/0, log of a negative number)
// comes out as a number that is not finite.
#pragma once

#include <array>
#include <cstddef>
#include <stdexcept>
#include <vector>

#include "catena/base/operation.hpp"

namespace catena {

template <class S>
class Formula {
 public:
  static constexpr std::size_t deepest_stack = 32;

  void push_constant(const S& number) { append({Operation::constant, 0, number}, 1); }
  /// The value of input number `index`, from 0.
  void push_input(std::uint32_t index) { append({Operation::column, index, S{}}, 1); }
  /// An operation on the values pushed last.
  void push(Operation operation) {
    const int taken = operands(operation);
    if (taken == 0 || depth_ < taken) throw std::invalid_argument("formula: an operation lacks its operands");
    append({operation, 0, S{}}, 1 - taken);
  }
  bool empty() const { return steps_.empty(); }

  /// input(k): the value of input k.
  template <class Input>
  S evaluate(Input&& input) const {
    std::array<S, deepest_stack> stack;
    S* top = stack.data();  // one after the last value
    for (const Step& step : steps_) {
      if (step.operation == Operation::constant) {
        *top++ = step.number;
      } else if (step.operation == Operation::column) {
        *top++ = input(step.index);
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
    std::uint32_t index;  // of an input
    S number;             // of a constant
  };
  void append(const Step& step, int change) {
    depth_ += change;
    if (depth_ > static_cast<int>(deepest_stack)) throw std::length_error("formula: nested too deeply");
    steps_.push_back(step);
  }

  std::vector<Step> steps_;
  int depth_ = 0;  // values on the stack after the last step
};

}  // namespace catena
