// Dynamics in which constraints may come and go at events: a pin breaks, a clutch engages, a part lands and stays.
//
// Between events it is Dynamics. At an event that releases or engages a constraint, the motion goes on from there with
// a plan of the same bodies and other rows. Positions and, on a release, velocities are continuous; on engagement
// velocities change as little as the constraint asks for in the mass metric (a plastic impact), and the energy lost
// counts as dissipated. A constraint that an event engages does not hold before. Units as in dynamics.hpp.
#pragma once

#include <memory>
#include <vector>

#include "catena/analysis/dynamics.hpp"

namespace catena {

class DynamicsWithEvents {
 public:
  /// Throws as EventWatch does. `sources`: what columns of dynamics can be made of.
  DynamicsWithEvents(std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                     const DynamicsOptions& options, std::vector<Event> events, const ColumnSources& sources);

  const Plan& plan() const { return dynamics_->plan(); }
  IntegrationMethod method() const { return dynamics_->method(); }
  Evaluator& evaluator() { return dynamics_->evaluator(); }
  void start_from(const SystemState& state) { dynamics_->start_from(state); }
  AnalysisReport run(const TimeGrid& grid, const Needs& needs, RowObserver& observer);
  SystemState state() const { return dynamics_->state(); }
  const std::vector<EventRecord>& records() const { return watch_->records(); }

 private:
  void make_dynamics();
  /// Releases or engages what the event says; a report if that cannot be.
  Report act(const Event& event, bool sum_up_work);
  Report check_fit(int element);

  std::shared_ptr<const Model> model_;
  PlanOptions plan_options_;
  DynamicsOptions options_;
  std::unique_ptr<Dynamics> dynamics_;
  std::unique_ptr<EventWatch> watch_;
};

}  // namespace catena
