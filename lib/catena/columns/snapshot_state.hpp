// A snapshot as the templates over scalars see a state (row_values.hpp): in plain numbers.
//
// States have: Scalar, model(), plan(), time(), frame(plan body) in the ground frame, twist(plan body) and
// acceleration(plan body) as three numbers, zero where they are not known, law_value(number) of a law of state,
// foot(element): where the curve of a contact is touched or nearest.
// `bodies` of the plan stands for the ground.
#pragma once

#include "catena/columns/snapshot.hpp"
#include "catena/elements/force_element.hpp"

namespace catena {

class SnapshotState {
 public:
  using Scalar = double;

  explicit SnapshotState(const Snapshot& snapshot) : s_(snapshot) {}

  const Snapshot& snapshot() const { return s_; }
  const Model& model() const { return s_.evaluator.model(); }
  const Plan& plan() const { return s_.evaluator.plan(); }
  double time() const { return s_.t; }
  Frame<double> frame(int plan_body) const { return s_.evaluator.ground_frame(plan_body); }
  Twist<double> twist(int plan_body) const { return three(s_.qd, plan_body); }
  Twist<double> acceleration(int plan_body) const { return three(s_.qdd, plan_body); }
  CurvePlace foot(int element) const { return s_.evaluator.contact(element); }
  double law_value(int law) const { return s_.evaluator.law_value(law, s_.qd); }

 private:
  static Twist<double> three(std::span<const double> rates, int plan_body) {
    if (rates.empty()) return {};
    const double* v = rates.data() + 3 * plan_body;
    return {v[0], v[1], v[2]};
  }
  const Snapshot& s_;
};

}  // namespace catena
