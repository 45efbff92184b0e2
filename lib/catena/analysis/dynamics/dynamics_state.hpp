// What Dynamics knows of a motion, as plain values: where it begins, how far a run has come, the present row, and the
// work so far.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/analysis/dynamics/balance_watch.hpp"
#include "catena/analysis/motion/energy_account.hpp"
#include "catena/analysis/motion/impulses.hpp"
#include "catena/analysis/motion/motion_memory.hpp"
#include "catena/analysis/pose/minimum_norm.hpp"
#include "catena/analysis/pose/singular_start.hpp"
#include "catena/analysis/run/analysis_report.hpp"
#include "catena/analysis/run/process_time.hpp"
#include "catena/analysis/run/time_grid.hpp"

namespace catena {

/// Where the next run begins.
struct MotionOrigin {
  bool prepared = false;                  ///< assembled, with velocities that meet the constraints
  bool resumed = false;                   ///< from the memory of a motion that paused
  std::vector<double> given_qd;           ///< velocities of an earlier analysis; empty: those of the model
  std::string jolting_event;              ///< velocities are those before it acts, and may have to jump
  std::optional<SingularStart> singular;  ///< in a singular position, driven
};

/// A run under way: what was asked for, how far it has come, and why it stopped before the end of its grid.
struct DynamicsRun {
  TimeGrid grid = TimeGrid::list({});
  Needs needs;
  ProcessTimer timer;
  AnalysisReport report;
  Report outcome;
  std::int64_t next_row = 0;  ///< of the grid
  /// A function of time jumps at the present time, and the integrator does not know yet.
  bool at_jump = false;
  /// The run ended at its pause, or where the velocity of a driver jumps while contacts hold.
  bool paused = false, jumped = false;
  bool locked = false;       ///< the row at the dead point was given
  int stopped_by = -1;       ///< the event that ended it
  std::vector<int> acting;   ///< events that act there
  double smooth_since = 0;   ///< the breakpoint before the present time, s
  std::vector<int> jumping;  ///< drivers whose velocity jumps at the breakpoint that was met last
  std::vector<Jolt> jolts;
  std::vector<SingularPoint> singular_points;

  bool stopped() const { return stopped_by >= 0 || paused || jumped; }
};

/// Counts of steps, rejected ones included, from which the end of a run is foreseen.
struct StepPace {
  std::shared_ptr<std::int64_t> taken;   ///< in the whole run
  std::shared_ptr<std::int64_t> of_all;  ///< the same, of a run of which this is a part; none: this is all
  std::int64_t counted = 0;              ///< of this part, those that are among them
  std::int64_t step = 0;                 ///< when the time was ...
  double t = 0;                          ///< ... this, s
};

/// The mechanism at an instant of the last step.
struct PresentRow {
  std::vector<double> y, slope, lambda, loads;
  double residual = 0;  ///< of positions, in length scales or rad
  std::vector<double> driver_work;
  std::vector<ContactLoad> contact_loads;  ///< by element
};

/// Work and energy of the motion; J.
struct MotionWork {
  std::optional<EnergyAccount> account;  ///< while a run sums work up
  std::optional<BalanceWatch> balance;   ///< where the energy can be told, and a tolerance was asked for
  WorkSoFar earlier;                     ///< of the motion before this run
  double earlier_motion = 0;             ///< what moved then
  double initial_energy = 0;
};

/// Multipliers where they are not unique.
struct LeastMultipliers {
  std::optional<MinimumNorm> norm;
  std::string ambiguity;  ///< a remark: whose reactions are not unique, when that was found

  /// The least ones at the evaluator's configuration; nullptr: it cannot be factored.
  MinimumNorm* factorize(const Evaluator& evaluator) {
    if (!norm) norm.emplace(evaluator);
    return norm->factorize() ? &*norm : nullptr;
  }
};

}  // namespace catena
