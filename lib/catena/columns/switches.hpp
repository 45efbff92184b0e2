// Where formulas of own columns switch: at every abs, min and max of them, and at the ends of tables that hold.
//
//   abs(a): s = a        min(a, b), max(a, b): s = +-(a - b)        table(a), held beyond its end e: s = a - e
//
// the branch, and the derivative, changes where s changes its sign. A switch is a column like others, called "NAME
// switch K", K from 0 in the order of evaluation: it has values and derivatives wherever NAME has. A formula is
// evaluated with a scalar that takes down what its comparisons were made between; nothing else is looked at, and
// formulas without switches are not touched. Derivatives of a column are those of one branch at s = 0. What shows loads
// switches too where an elastic cable or rope that acts as a force becomes taut, s its gap, by what laws of state
// compare ("law L switch K"), and at the ends of springs' curves that hold, s = l - l0 - e ("SPRING switch K", K 0 at
// the first end, 1 at the last). Source: A. Griewank, A. Walther, Evaluating Derivatives (2008), section 14.1.
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catena/columns/column_names.hpp"

namespace catena {

/// The comparisons of one evaluation: how many there were, and the difference that decided number `wanted`, or, where
/// there is a place for them, those that decided all.
template <class R>
struct SwitchNotes {
  int wanted = -1, count = 0;
  R difference = R(0.0);
  std::vector<R>* all = nullptr;

  void take(const R& value) {
    if (count++ == wanted) difference = value;
    if (all) all->push_back(value);
  }
};

/// A number that takes down the comparisons that are made with it. Those among constants alone are not.
template <class R>
class Noted {
 public:
  Noted() = default;
  template <class Number>
  explicit Noted(const Number& value) : v_(value) {}
  Noted(R value, SwitchNotes<R>* notes) : v_(std::move(value)), notes_(notes) {}

  const R& plain() const { return v_; }

  friend Noted operator-(const Noted& a) { return {-a.v_, a.notes_}; }
  friend Noted operator+(const Noted& a, const Noted& b) { return {a.v_ + b.v_, a.notes(b)}; }
  friend Noted operator-(const Noted& a, const Noted& b) { return {a.v_ - b.v_, a.notes(b)}; }
  friend Noted operator*(const Noted& a, const Noted& b) { return {a.v_ * b.v_, a.notes(b)}; }
  friend Noted operator/(const Noted& a, const Noted& b) { return {a.v_ / b.v_, a.notes(b)}; }
  friend bool operator<(const Noted& a, const Noted& b) {
    if (SwitchNotes<R>* notes = a.notes(b)) notes->take(a.v_ - b.v_);
    return a.v_ < b.v_;
  }
  friend Noted abs(const Noted& a) {
    if (a.notes_) a.notes_->take(a.v_);
    return a.smooth(Operation::abs);
  }
  friend Noted pow(const Noted& a, const Noted& b) { return {apply(Operation::power, a.v_, b.v_), a.notes(b)}; }
  friend Noted atan2(const Noted& a, const Noted& b) { return {apply(Operation::atan2, a.v_, b.v_), a.notes(b)}; }
  friend Noted sin(const Noted& a) { return a.smooth(Operation::sin); }
  friend Noted cos(const Noted& a) { return a.smooth(Operation::cos); }
  friend Noted tan(const Noted& a) { return a.smooth(Operation::tan); }
  friend Noted asin(const Noted& a) { return a.smooth(Operation::asin); }
  friend Noted acos(const Noted& a) { return a.smooth(Operation::acos); }
  friend Noted atan(const Noted& a) { return a.smooth(Operation::atan); }
  friend Noted sqrt(const Noted& a) { return a.smooth(Operation::sqrt); }
  friend Noted exp(const Noted& a) { return a.smooth(Operation::exp); }
  friend Noted log(const Noted& a) { return a.smooth(Operation::log); }

  /// The number of a table there; one that is held beyond its ends bends at them.
  template <class Table>
  Noted look_up(const Table& table) const {
    if (notes_ && table.curve.beyond() == Beyond::hold && !table.curve.periodic()) {
      notes_->take(v_ - R(table.curve.first()));
      notes_->take(v_ - R(table.curve.last()));
    }
    if (!table.curve.covers(value_of(v_))) return {R(std::numeric_limits<double>::quiet_NaN()), notes_};
    return {table.curve.evaluate(v_).f, notes_};
  }

 private:
  Noted smooth(Operation operation) const { return {apply(operation, v_), notes_}; }
  SwitchNotes<R>* notes(const Noted& other) const { return notes_ ? notes_ : other.notes_; }

  R v_ = R(0.0);
  SwitchNotes<R>* notes_ = nullptr;
};

/// Evaluates a formula, input(k) giving its inputs, and takes down what it compares.
template <class R, class F, class Input>
void note_switches(const F& formula, Input&& input, SwitchNotes<R>& notes) {
  formula.evaluate_with([&](std::uint32_t k) { return Noted<R>(input(k), &notes); },
                        [](const auto& table, const Noted<R>& x) { return x.look_up(table); });
}

/// The column that a name such as "NAME switch 0" stands for.
std::optional<NamedColumn> find_switch(const Model& model, std::string_view name);

/// The names of all switches of a column and of the own columns that it is made of; none of any other name.
std::vector<std::string> switches_of(const Model& model, const std::string& name);

/// By what the loads that a column shows switch: gaps of elastic cables and ropes that act as forces, ends of curves
/// that springs hold, and the comparisons that laws of state make; `multipliers`: the column needs those of the
/// constraints, and so all loads.
std::vector<std::string> switches_of_loads(const Model& model, const std::string& name, bool multipliers);

}  // namespace catena
