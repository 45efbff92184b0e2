// Many designs of one driven mechanism at once: positions, velocities, accelerations and, where they are wanted, loads
// of drivers and multipliers, at the instants of a grid.
//
//   catena::Batch batch(model);
//   batch.run(1'000'000, grid,
//             [](std::int64_t k, catena::Model& model) { ... },           // writes the numbers of design k
//             [](const catena::BatchRows& rows) { ... });                 // takes what came of sixteen designs
//
// Designs have the structure of the model and other numbers: given poses, local points, constants, functions of time.
// They are followed in lanes, sixteen side by side, and several threads share them out (lane_motion.hpp). A design that
// leaves its lane is followed by Kinematics instead, and ends as that says, with its message: the others do not notice.
// The results are those of Kinematics to rounding, the same for any number of threads.
// What cannot be computed in lanes at all is refused, with the reason (lane_program.hpp). Designs do not change flags
// and sides of elements. Units SI, rad.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/batch/lane_motion.hpp"
#include "catena/analysis/run/time_grid.hpp"
#include "catena/base/status.hpp"

namespace catena {

struct BatchOptions {
  double tolerance = 1e-12;  ///< of constraint residuals, relative to the length scale
  int threads = 1;
  bool loads = false;  ///< multipliers and loads are wanted: every body needs its mass
  /// Designs do not touch functions of time: these are evaluated once an instant for all lanes.
  bool same_functions = false;
  const std::atomic<bool>* cancel = nullptr;
};

/// What came of up to lane_count designs. Rows that a design did not reach hold no numbers (NaN).
class BatchRows {
 public:
  std::int64_t first = 0;  ///< number of the first design
  int designs = 0, rows = 0;

  /// x, y, phi of a body of the model in the ground frame, their rates and accelerations, of the design in a lane.
  Frame<double> position(int row, int body, int lane) const;
  Rates velocity(int row, int body, int lane) const;
  Rates acceleration(int row, int body, int lane) const;
  /// The same numbers side by side, of all lanes: entry 0, 1, 2 is x, y, phi.
  const double* positions(int row, int body, int entry) const { return motion_->q(row) + place(body, entry); }
  const double* velocities(int row, int body, int entry) const { return motion_->qd(row) + place(body, entry); }
  const double* accelerations(int row, int body, int entry) const { return motion_->qdd(row) + place(body, entry); }
  /// The load of a driver, a number of the model's list of elements, N or N m; needs BatchOptions::loads.
  double load(int row, int element, int lane) const;
  /// Multiplier number k of a constraint, of all lanes side by side, in the solver's scale: that of the published
  /// equation but for squared distances, whose equation is scaled by 1/(2c).
  const double* multipliers(int row, int element, int k) const;

  Status status(int lane) const { return outcome_[static_cast<std::size_t>(lane)].status; }
  const std::string& message(int lane) const { return outcome_[static_cast<std::size_t>(lane)].message; }
  /// Why Kinematics took over the design; empty: it stayed in its lane.
  const std::string& left_lane(int lane) const { return left_[static_cast<std::size_t>(lane)]; }

 private:
  friend class Batch;
  int place(int body, int entry) const;

  const LaneMotion* motion_ = nullptr;
  const Plan* plan_ = nullptr;
  std::array<const Model*, lane_count> model_{};
  std::span<const double> instants_;
  bool has_loads_ = false;
  std::array<Report, lane_count> outcome_;
  std::array<std::string, lane_count> left_;
};

struct BatchReport {
  std::int64_t designs = 0, in_lanes = 0, failed = 0;
  bool cancelled = false;
};

class Batch {
 public:
  /// Writes the numbers of a design into a model that has those of any design before: all that differ are to be
  /// written.
  using Design = std::function<void(std::int64_t design, Model& model)>;
  using Take = std::function<void(const BatchRows& rows)>;

  /// Throws std::invalid_argument, with the reason, where designs of this model cannot be computed in lanes.
  explicit Batch(std::shared_ptr<const Model> model, const BatchOptions& options = {});
  ~Batch();

  /// Empty, or why designs of this model cannot be computed in lanes.
  static std::string obstacle(const Model& model, bool loads = false);

  /// Both functions are called by several threads at once where there are several, each for designs of its own. An
  /// exception of theirs ends the run and is thrown on. Throws std::invalid_argument for a grid that is empty or not in
  /// order, for a number of designs below zero, and where a design has another structure or numbers that are not
  /// finite.
  BatchReport run(std::int64_t designs, const TimeGrid& grid, const Design& design, const Take& take);

 private:
  class Worker;
  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Plan> plan_;
  std::unique_ptr<const LaneProgram> program_;
  BatchOptions options_;
};

}  // namespace catena
