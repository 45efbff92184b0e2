// A motion that is integrated from step to step.
#pragma once

#include <memory>

#include "catena/analysis/dynamics/dynamics_with_events.hpp"
#include "machine.hpp"

namespace catena::python {

class DynamicsMachine final : public Machine {
 public:
  DynamicsMachine(OpenScene scene, const DynamicsOptions& options);

  std::string_view method() const;

 private:
  void use_model(std::shared_ptr<const Model> model) override;
  const ColumnSet& resolved() override;
  AnalysisReport run(const TimeGrid& grid, RowObserver& observer) override;
  SystemState state() const override { return state_; }

  DynamicsOptions options_;
  SystemState state_;
  bool touches_ = false;  // contacts or friction: every step begins with looking what touches
  std::unique_ptr<Dynamics> free_;
  std::unique_ptr<DynamicsWithEvents> touching_;
};

}  // namespace catena::python
