// A driven mechanism that is moved through time; its drivers can also be taken to values while time stands still.
#pragma once

#include <memory>

#include "catena/analysis/kinematics/kinematics.hpp"
#include "machine.hpp"

namespace catena::python {

class KinematicsMachine final : public Machine {
 public:
  KinematicsMachine(OpenScene scene, const KinematicsOptions& options);

  /// Takes a driver to a value along the branch that the mechanism is on, while time stands still; from then on the
  /// driver's value changes at this rate.
  void drive(const std::string& driver, double value, double rate);
  /// Accelerations at the present place, in the order of q().
  Numbers accelerations();

 private:
  void use_model(std::shared_ptr<const Model> model) override;
  const ColumnSet& resolved() override { return *columns_; }
  AnalysisReport run(const TimeGrid& grid, RowObserver& observer) override;
  SystemState state() const override { return analysis_->state(); }
  /// By element: what drive() put in place of the scene's functions.
  using Driven = std::map<int, TimeFunction<double>>;
  std::unique_ptr<Kinematics> analysis_of(std::shared_ptr<const Model> model) const;
  /// Takes over the model with these drivers, assembled near `start` if that is given.
  void rebuild(std::shared_ptr<const Model> model, Driven driven, const std::optional<SystemState>& start);

  KinematicsOptions options_;
  std::unique_ptr<Kinematics> analysis_;
  Driven driven_;
  bool stepped_ = false;
};

}  // namespace catena::python
