// A mechanism at rest, followed as its parameters change.
#pragma once

#include <memory>

#include "catena/analysis/statics/equilibrium.hpp"
#include "machine.hpp"

namespace catena::python {

class EquilibriumMachine final : public Machine {
 public:
  EquilibriumMachine(OpenScene scene, const EquilibriumOptions& options);

  const EquilibriumReport& report() const { return report_; }

 private:
  void use_model(std::shared_ptr<const Model> model) override;
  const ColumnSet& resolved() override { return *columns_; }
  AnalysisReport run(const TimeGrid& grid, RowObserver& observer) override;
  SystemState state() const override { return analysis_->state(); }

  EquilibriumOptions options_;
  std::unique_ptr<Equilibrium> analysis_;
  EquilibriumReport report_;
};

}  // namespace catena::python
