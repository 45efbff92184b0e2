#include "equilibrium_machine.hpp"

#include <stdexcept>

namespace catena::python {

EquilibriumMachine::EquilibriumMachine(OpenScene scene, const EquilibriumOptions& options)
    : Machine(std::move(scene), {.analysis = "equilibrium", .multipliers = true}), options_(options) {
  use_model(scene_.model());
  show_state();
}

// The plan stays where the structure does: the last solution is then the next start.
void EquilibriumMachine::use_model(std::shared_ptr<const Model> model) {
  bool fits = analysis_ && model->bodies.size() == model_->bodies.size();
  if (fits) {
    try {
      analysis_->set_model(model);
    } catch (const std::invalid_argument&) {
      fits = false;
    }
  }
  if (!fits) {
    auto next = std::make_unique<Equilibrium>(model, plan(*model), options_);
    if (analysis_ && model->bodies.size() == model_->bodies.size()) next->start_from(analysis_->state());
    analysis_ = std::move(next);
    columns_ = resolve(*model, analysis_->plan());
  }
  model_ = std::move(model);
}

AnalysisReport EquilibriumMachine::run(const TimeGrid& grid, RowObserver& observer) {
  report_ = analysis_->run(grid, columns_->needs(), observer);
  return report_;
}

}  // namespace catena::python
