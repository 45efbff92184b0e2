#include "dynamics_machine.hpp"

namespace catena::python {

DynamicsMachine::DynamicsMachine(OpenScene scene, const DynamicsOptions& options)
    : Machine(std::move(scene),
              {.analysis = "dynamics", .timed = true, .velocity = true, .acceleration = true, .multipliers = true}),
      options_(options) {
  use_model(scene_.model());
  show_state();
}

void DynamicsMachine::use_model(std::shared_ptr<const Model> model) {
  const PlanOptions options = plan(*model);
  bool touches = !model->gaps().empty() || !model->frictions().empty();
  // Each step of a motion with contacts is an analysis of its own, which knows nothing of the work done before.
  ColumnSources sources = sources_;
  sources.work = !touches;
  std::unique_ptr<Dynamics> free;
  std::unique_ptr<DynamicsWithEvents> touching;
  if (touches) {
    touching = std::make_unique<DynamicsWithEvents>(model, options, options_, std::vector<Event>{}, sources);
    touching->start_from(state_);
  } else {
    free = std::make_unique<Dynamics>(model, options, options_);
    free->start_from(state_);
  }
  const SystemState here = state_;
  const auto take = [&] {
    model_.swap(model);
    std::swap(touches_, touches);
    std::swap(sources_, sources);
    free_.swap(free);
    touching_.swap(touching);
    columns_.reset();
  };
  take();
  if (!row()) return;  // nothing was shown yet, so that nothing shown is of the parameters before
  try {
    if (const AnalysisReport report = go({here.t}, nullptr); !report.ok()) throw StepError(report);
  } catch (...) {
    take();
    state_ = here;
    throw;
  }
}

// With friction the model that is analysed has more equations than that of the scene.
const ColumnSet& DynamicsMachine::resolved() {
  if (!columns_) {
    columns_ = touches_ ? resolve(touching_->evaluator().model(), touching_->plan())
                        : resolve(free_->evaluator().model(), free_->plan());
  }
  return *columns_;
}

AnalysisReport DynamicsMachine::run(const TimeGrid& grid, RowObserver& observer) {
  double last = state_.t;
  for (std::int64_t k = 0; k < grid.size(); ++k) {
    if (grid[k] < last) {
      AnalysisReport report;
      static_cast<Report&>(report) = refusal("dynamics goes forwards in time: " + std::to_string(grid[k]) +
                                             " s is before " + std::to_string(last) + " s");
      return report;
    }
    last = grid[k];
  }
  AnalysisReport report;
  if (touches_) {
    touching_ = std::make_unique<DynamicsWithEvents>(model_, plan(*model_), options_, std::vector<Event>{}, sources_);
    touching_->start_from(state_);
    report = touching_->run(grid, columns_->needs(), observer);
    state_ = touching_->state();
  } else {
    report = free_->run(grid, columns_->needs(), observer);
    if (columns_->needs().work && report.ok()) free_->carry_on(free_->work_so_far());
    state_ = free_->state();
  }
  return report;
}

std::string_view DynamicsMachine::method() const { return to_string(free_ ? free_->method() : touching_->method()); }

}  // namespace catena::python
