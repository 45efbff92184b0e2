#include "catena/analysis/dynamics_with_checkpoints.hpp"

#include <cmath>

#include "catena/analysis/report_parts.hpp"

namespace catena {

DynamicsWithCheckpoints::DynamicsWithCheckpoints(std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                                                 const DynamicsOptions& options, double every,
                                                 std::function<void(const MotionMemory&)> save)
    : model_(std::move(model)), plan_options_(plan_options), options_(options), every_(every), save_(std::move(save)) {
  make_dynamics();
}

void DynamicsWithCheckpoints::make_dynamics() {
  dynamics_ = std::make_unique<Dynamics>(model_, plan_options_, options_);
}

void DynamicsWithCheckpoints::start_from(const SystemState& state) {
  if (!resumed_) dynamics_->start_from(state);
}

void DynamicsWithCheckpoints::resume(const MotionMemory& memory) {
  resumed_ = true;
  first_row_ = memory.next_row;
  dynamics_->resume(memory);
}

AnalysisReport DynamicsWithCheckpoints::run(const TimeGrid& grid, const Needs& needs, RowObserver& observer) {
  AnalysisReport total;
  for (;;) {
    // The next multiple that lies clearly ahead.
    const double next = (std::floor(dynamics_->time() / every_ * (1 + 1e-12)) + 1) * every_;
    dynamics_->pause_after(next);
    add_part(total, dynamics_->run(grid.from_row(first_row_), needs, observer));
    if (!total.ok() || !dynamics_->paused()) return total;
    MotionMemory memory = dynamics_->memory();
    memory.next_row += first_row_;
    save_(memory);
    make_dynamics();
    resume(memory);
  }
}

}  // namespace catena
