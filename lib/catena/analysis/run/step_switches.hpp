// What forces do within a step that its stages may not show: laws of state that take another branch, and elastic cables
// and ropes that become taut or slack, by samples at the stages.
//
// There a force bends. Integrals over such a step are of low order, and an estimate of their error that takes powers
// for smooth may be small by chance: methods judge these steps otherwise. Source: columns/switches.hpp,
// analysis/run/cable_slack.hpp.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "catena/analysis/run/law_switches.hpp"

namespace catena {

class StepSwitches {
 public:
  struct Found {
    bool laws = false, cables = false;
    bool any() const { return laws || cables; }
  };

  explicit StepSwitches(const Evaluator& evaluator) : evaluator_(evaluator) {}
  /// A step from t, s, is tried: the sample that was taken there, by the step before, is its first.
  void begin_step(double t);
  /// At the evaluator's configuration; one at the same time is replaced.
  void note(double t, std::span<const double> qd);
  /// Whether there are cables or ropes at all.
  bool has_cables();
  /// What may switch between two samples.
  Found found() const;

 private:
  struct Sample {
    double t = 0;
    std::vector<double> of_laws, of_cables;
  };
  using Values = std::vector<double> Sample::*;
  void find_what_switches();
  bool may_switch(Values values) const;

  const Evaluator& evaluator_;
  LawSwitches laws_;
  bool known_ = false, cables_ = false;  // what there is; whether there are any
  // Stages of a step are fewer; what is evaluated for rows between its ends does not count.
  std::array<Sample, 16> samples_;
  std::size_t count_ = 0;
};

}  // namespace catena
