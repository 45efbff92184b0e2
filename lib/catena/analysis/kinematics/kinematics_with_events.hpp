// A driven motion in which events are looked for between its rows, and in which constraints and drivers may come and
// go.
//
// Kinematics gives the rows; a KinematicLook follows the same motion between them. The way from row to row is divided
// until places within a piece are those of the cubic through its ends
//
//   |q(t) - H(t)| <= 1e-4 length scales, rad,     H: Hermite, from q and qd at both ends
//
// and in every piece EventWatch samples and locates. At an event that releases or engages a constraint the motion goes
// on with a plan of the same bodies and other rows, from the same places; constraints and drivers must then determine
// it again (`under_driven` if they do not). Velocities may jump there, which asks for no force in kinematics. All
// events of an instant act together, in the order of the list, up to one that stops the analysis. A constraint that an
// event engages does not hold before (but see first_actions.hpp), and must hold where it happens (engagement.hpp).
// Units: m, rad, s.
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/events/event_watch.hpp"
#include "catena/analysis/kinematics/kinematic_look.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"

namespace catena {

class KinematicsWithEvents {
 public:
  /// Throws as EventWatch does; std::invalid_argument for an event with an impulse, which moves nothing that is driven.
  KinematicsWithEvents(std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                       const KinematicsOptions& options, std::vector<Event> events, const ColumnSources& sources);
  ~KinematicsWithEvents();

  const Plan& plan() const { return kinematics_->plan(); }
  Evaluator& evaluator() { return kinematics_->evaluator(); }
  void start_from(const SystemState& state);
  /// Instants of the grid must be in the order of time.
  AnalysisReport run(const TimeGrid& grid, const Needs& needs, RowObserver& observer);
  SystemState state() const;
  const std::vector<SingularPoint>& singular_points() const { return singular_points_; }
  const std::vector<EventRecord>& records() const { return watch_->records(); }

 private:
  class Rows;
  void make_kinematics();
  Report check_order(const TimeGrid& grid) const;
  /// Lets the events act at which the phase ended; `stop`: the one of them that ends the analysis.
  Report act(const Event*& stop);
  bool turn_values_to_bodies(std::span<const int> elements, const SystemState& state);
  Report engage(std::span<const int> elements);

  std::shared_ptr<const Model> given_model_, model_;  // model_: with values moved by whole turns
  PlanOptions plan_options_;
  KinematicsOptions options_;
  std::unique_ptr<Kinematics> kinematics_;
  std::unique_ptr<EventWatch> watch_;
  std::optional<SystemState> start_, end_;  // of the phase; where an event ended it
  std::vector<int> turned_;                 // turns by which values were moved, by element; empty: none
  std::vector<int> acting_;                 // the events at which the phase ended
  std::string released_;                    // what they released, in words
  std::vector<std::string> inactive_;       // what is said of elements that do not hold from the start
  std::vector<SingularPoint> singular_points_;
};

}  // namespace catena
