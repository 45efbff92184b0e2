// Ropes and cables without stiffness that determine a driven motion: a drum winds its rope, and the load hangs on it.
//
//   Psi = L - way = 0        throughout; tension T = -lambda >= 0, or the rope would be slack
//
// They do where constraints and drivers leave freedom that the equations of all ropes that are taut at the start take
// away, without one too many: else forces would say which of them are taut, and a driven motion asks for none. Where
// drivers determine the motion by themselves, ropes are watched as other one-sided elements (gap_watch.hpp). T is known
// in inverse dynamics alone; negative tensions are told. Units: N, s.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "catena/analysis/run/system_state.hpp"
#include "catena/assembly/plan.hpp"
#include "catena/columns/snapshot.hpp"

namespace catena {

class TautRopes {
 public:
  /// `without`: plan options in which no one-sided element has equations. `from`: where the motion begins.
  TautRopes(std::shared_ptr<const Model> model, const PlanOptions& without, const SystemState& from);

  bool any() const { return !pulled_.empty(); }
  /// Gives them their equations in a plan.
  void add_rows(PlanOptions& options) const;
  /// Their names in quotes.
  std::string names() const;
  void observe(const Snapshot& row);
  /// What is taken for granted, and which of them would have to push.
  std::vector<std::string> warnings() const;

 private:
  struct Pulled {
    int element = -1;
    double least = 0, t = 0;  // tension, and when; zero: it always pulls
  };
  void find(const PlanOptions& without, const SystemState& from);

  std::shared_ptr<const Model> model_;
  std::vector<Pulled> pulled_;
  double largest_ = 0;  // of tensions, for their rounding
};

}  // namespace catena
