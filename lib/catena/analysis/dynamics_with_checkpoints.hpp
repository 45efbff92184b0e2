// Dynamics that pauses now and then to save what it goes on from.
//
// At the end of the first step that reaches a multiple of `every` after the last pause the integrator and all it holds
// are given up, and a new one goes on from the numbers that were saved: in the run that goes on as in one that is taken
// up from the file, which are thus equal bit for bit. Pauses depend on simulated time alone. A run with checkpoints is
// as exact as one without, but differs from it within its tolerance; adams starts with short steps after each.
#pragma once

#include <functional>
#include <memory>

#include "catena/analysis/dynamics.hpp"

namespace catena {

class DynamicsWithCheckpoints {
 public:
  /// `every` > 0, s. `save` is called at each pause.
  DynamicsWithCheckpoints(std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                          const DynamicsOptions& options, double every, std::function<void(const MotionMemory&)> save);

  const Plan& plan() const { return dynamics_->plan(); }
  IntegrationMethod method() const { return dynamics_->method(); }
  Evaluator& evaluator() { return dynamics_->evaluator(); }
  SystemState state() const { return dynamics_->state(); }
  /// Ignored by a motion that is taken up.
  void start_from(const SystemState& state);
  /// Takes up a motion; run() then wants the grid of the motion from its beginning, and gives the rows that are left.
  void resume(const MotionMemory& memory);
  AnalysisReport run(const TimeGrid& grid, const Needs& needs, RowObserver& observer);

 private:
  void make_dynamics();

  std::shared_ptr<const Model> model_;
  PlanOptions plan_options_;
  DynamicsOptions options_;
  double every_;
  std::function<void(const MotionMemory&)> save_;
  std::unique_ptr<Dynamics> dynamics_;
  bool resumed_ = false;
  std::int64_t first_row_ = 0;  // of the grid, for the present part
};

}  // namespace catena
