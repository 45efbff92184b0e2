// Where laws of state switch from one branch to another along a motion: by what they compare (columns/switches.hpp) at
// samples of a stretch, in the order of time.
//
// A sum over a stretch in which a law bends or jumps is of low order, and an estimate of its error that takes powers
// for smooth may be small by chance. A comparison that changes its sign between two samples, or comes near to zero
// between three, says that there is such a place.
#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "catena/assembly/evaluate.hpp"

namespace catena {

class LawSwitches {
 public:
  /// Of the evaluator's laws.
  void begin(const Evaluator& evaluator);
  /// Whether some law compares.
  bool any() const { return !laws_.empty(); }
  /// All that these laws compare at the evaluator's configuration and time, into `differences`.
  void read(std::span<const double> qd, std::vector<double>& differences) const;
  /// Whether one of the differences v, at the places t in their order, switches between them.
  static bool may_switch(std::span<const double> t, std::span<const double> v);

 private:
  const Evaluator* evaluator_ = nullptr;
  std::vector<int> laws_;
};

}  // namespace catena
