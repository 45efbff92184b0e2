// Dynamics of mechanisms that stand side by side in one scene, tied by no constraint and no force: those of different
// pace (paces.hpp) are integrated apart, with steps of their own size, each class by the method that `auto` chooses for
// it, and they meet at the rows.
//
// A stiff or fast mechanism then does not force its steps on a slow and large one: instead of
//   (most steps of any) x (bodies of all)      the cost is      sum over the classes of steps x bodies.
// Mechanisms with contacts, stops, cables or dry friction are each a class of their own: where one of them changes what
// it does, the others know nothing of it, and a fall of n bodies costs n times that of one.
//
// Errors are compared with the sizes of each class, not with those of the whole scene: the same tolerance asks for more
// where a small mechanism stands beside a large one.
#pragma once

#include <memory>
#include <vector>

#include "catena/analysis/dynamics/dynamics_with_events.hpp"
#include "catena/model/model_part.hpp"

namespace catena {

class DynamicsOfIslands {
 public:
  /// `classes`: bodies of each, as classes_of_pace() finds them.
  DynamicsOfIslands(std::shared_ptr<const Model> model, const PlanOptions& plan_options, const DynamicsOptions& options,
                    const std::vector<std::vector<int>>& classes);
  ~DynamicsOfIslands();

  std::size_t classes() const { return parts_.size(); }
  /// The motion of a class, whose bodies and elements have numbers of their own; and an observer that is given its rows
  /// beside those of all; nullptr: none.
  DynamicsWithEvents& motion_of(std::size_t part);
  void watch_rows_of(std::size_t part, RowObserver* observer);
  const Plan& plan() const { return *plan_; }
  Evaluator& evaluator() { return evaluator_; }
  SystemState state() const;
  /// Of each class.
  std::vector<IntegrationMethod> methods() const;
  void start_from(const SystemState& state);
  /// See Dynamics; drivers by their numbers in the whole model.
  const std::vector<SingularPoint>& singular_points() const { return singular_points_; }
  const std::vector<Jolt>& jolts() const { return jolts_; }
  /// Changes of contacts, of one instant in the order of the classes.
  const std::vector<ContactEvent>& contact_events() const { return contact_events_; }
  /// Where one of them cannot go on all end, with its message; in a dead point with a row of all at that instant.
  AnalysisReport run(const TimeGrid& grid, const Needs& needs, RowObserver& observer);

 private:
  class Part;
  bool give_row(double t, const Needs& needs, RowObserver& observer);
  AnalysisReport report_of_all(const Part* ended);
  void give_row_at_lock_up(Part& locked, const Needs& needs, RowObserver& observer);
  void collect_points_in_time(double until);

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Plan> plan_;
  EvaluationWork evaluation_;
  Evaluator evaluator_;
  std::vector<std::unique_ptr<Part>> parts_;
  std::vector<SingularPoint> singular_points_;
  std::vector<Jolt> jolts_;
  std::vector<ContactEvent> contact_events_;
  bool touches_ = false;  // some have contacts, stops or friction
  double t_ = 0;
  std::vector<double> q_, qd_, qdd_, lambda_, driver_work_;  // of all, in the order of plan_
  std::vector<ContactLoad> contacts_;                        // by element
};

}  // namespace catena
