// The interface of methods that integrate a constrained motion step by step. One object an integration; nothing
// allocates after the first step. Times in s, states as in motion.hpp.
#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/motion/motion_memory.hpp"

namespace catena {

class StageWatcher;

class Integrator {
 public:
  Integrator() = default;
  Integrator(const Integrator&) = delete;
  Integrator& operator=(const Integrator&) = delete;
  virtual ~Integrator() = default;

  /// Starts, or starts anew after a jump, at (t, y), which must meet the constraints. False: no acceleration there.
  virtual bool start(double t, std::span<const double> y) = 0;
  /// Makes one step that does not go beyond `limit` (> time()). False: none can be made; see culprit().
  virtual bool advance(double limit) = 0;
  /// The state at t between previous_time() and time(), as exact as the steps; constraints are met no better than that.
  virtual void interpolate(double t, std::span<double> y) = 0;
  /// Remarks on the run for the user; sentences.
  virtual std::vector<std::string> remarks() const { return {}; }
  /// How often the motion went straight on where its branch turns, too near to another one for steps to follow it.
  virtual std::int64_t straight_passages() const { return 0; }
  /// Quantities observed along the motion; and, before start(), those of another integrator.
  virtual IntegratorMemory memory() const = 0;
  virtual void remember(const IntegratorMemory& memory) = 0;
  /// Whether another integrator may continue from here: not across a singular position.
  virtual bool may_pause() const = 0;
  /// Adds what the last step is estimated to be off by to `error`, [q, qd]; its part across the constraints, which is
  /// projected away, may be in it. Not numbers where nothing is known of it. Costs a pass over the coordinates.
  virtual void add_error(std::span<double> error) const = 0;
  /// qdd at time().
  virtual std::span<const double> accelerations() const = 0;
  /// How fast the mechanism moves, 1/s: see ErrorScale.
  virtual double rate() const = 0;
  /// Shows the stages of its steps from now on, if they are those of stage_watcher.hpp; nullptr: to nothing.
  virtual void show_stages_to(StageWatcher* watcher) { static_cast<void>(watcher); }
  /// Whether ends of steps lie on the constraints to rounding.
  virtual bool meets_constraints() const { return true; }

  double time() const { return t_; }
  double previous_time() const { return t_before_; }
  std::span<const double> state() const { return y_; }
  /// Coordinate (of a moving body) whose error was largest in the step that failed; -1: not finite, or constraints.
  int culprit() const { return culprit_; }
  /// Of positions at time(), in length scales or rad.
  double position_residual() const { return position_residual_; }

 protected:
  double t_ = 0, t_before_ = 0, position_residual_ = 0;
  std::vector<double> y_;
  std::vector<CurvePlace> curve_places_;  // of contacts at y_, where every trial of a step begins its searches
  int culprit_ = -1;
};

}  // namespace catena
