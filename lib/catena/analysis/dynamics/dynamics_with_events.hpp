// Dynamics in which constraints may come and go at events: a pin breaks, a clutch engages, a part lands and stays.
//
// Between events it is Dynamics. At an event that releases or engages a constraint, the motion goes on from there with
// a plan of the same bodies and other rows. Positions and, on a release, velocities are continuous; on engagement
// velocities get the least change in the mass metric that meets the constraint (a plastic impact), and the energy lost
// counts as dissipated. A constraint that an event engages does not hold before (but see first_actions.hpp). Events of
// the same instant act in the order of the list, each on the velocities that the one before leaves behind, up to one
// that stops the analysis. Angles are continuous everywhere: what is engaged after some turns takes its value with it
// (engaged_turns.hpp). Units as in dynamics.hpp.
//
// A set of equations that held before has its plan, and the structure of its factors: the last few sets are kept, so
// that a place that closes, opens, sticks and slips again and again costs numbers alone.
//
// Contacts, stops and cables are phases of the same kind (contact_phases.hpp): rows that come and go by themselves,
// with impacts where they close.
//
// It can also pause at intervals to save its state. At the end of the first step that reaches a multiple of `every`
// after the last pause the integrator is discarded, and a new one continues from the saved numbers, in the same run as
// in one that is resumed from them: both are thus equal bit for bit. Pauses depend on simulated time alone. A run with
// pauses is as exact as one without, but may differ from it within its tolerance; adams starts with short steps after
// each.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

#include "catena/analysis/dynamics/contact_phases.hpp"
#include "catena/analysis/dynamics/dynamics.hpp"

namespace catena {

struct Pauses {
  double every = std::numeric_limits<double>::infinity();  ///< s
  std::function<void(const MotionMemory&)> save = {};      ///< called at each
};

class DynamicsWithEvents {
 public:
  /// Throws as EventWatch does. `sources`: what columns of dynamics can be made of. `events` may be empty. `ropes`:
  /// their ways change in motion; else the run ends where one leaves a pulley.
  DynamicsWithEvents(std::shared_ptr<const Model> model, const PlanOptions& plan_options,
                     const DynamicsOptions& options, std::vector<Event> events, const ColumnSources& sources,
                     bool ropes = true);

  const Plan& plan() const { return dynamics_->plan(); }
  IntegrationMethod method() const { return dynamics_->method(); }
  /// All that were in use, of all phases.
  const std::vector<IntegrationMethod>& methods() const { return methods_; }
  Evaluator& evaluator() { return dynamics_->evaluator(); }
  /// Told of every phase of the motion; nullptr: none.
  void witness(PhaseWitness* witness) { witness_ = witness; }
  /// Before run(), without contacts: the follower is told of every step; where another phase of the motion begins, of
  /// a jump, and of no steps after it. nullptr: none.
  void follow(StepFollower* follower) {
    follower_ = follower;
    dynamics_->follow(follower);
  }
  void pause(Pauses pauses) { pauses_ = std::move(pauses); }
  /// Nothing in a motion that is taken up.
  void start_from(const SystemState& state);
  /// Takes up a motion that paused; run() then wants the grid of that motion from its beginning, and gives the rows
  /// that are left.
  void resume(const MotionMemory& memory);
  AnalysisReport run(const TimeGrid& grid, const Needs& needs, RowObserver& observer);
  /// run() in parts, as in Dynamics; rows may come before they are asked for: all of a step that an event ends.
  /// `steps`: see Dynamics::count_steps_in(); nullptr: of this motion alone.
  void begin(const TimeGrid& grid, const Needs& needs, std::shared_ptr<std::int64_t> steps = nullptr);
  bool go_on(std::int64_t rows, RowObserver& observer);
  AnalysisReport end();
  double time() const { return dynamics_->time(); }
  /// With how far its ropes are wound, if they are followed.
  SystemState state() const;
  /// See Dynamics.
  const std::vector<SingularPoint>& singular_points() const { return singular_points_; }
  const std::vector<EventRecord>& records() const { return watch_->records(); }
  /// Where velocities jumped, impacts of contacts alone left out: what constraints exerted.
  const std::vector<Jolt>& jolts() const { return jolts_; }
  /// Changes of contacts, in order of their instants but for accumulated bounces.
  const std::vector<ContactEvent>& contact_events() const { return contacts_.events(); }
  bool has_contacts() const { return contacts_.any(); }
  bool watches_events() const { return !watch_->events().empty(); }

 private:
  using WorkByDriver = std::vector<std::pair<int, double>>;
  void make_dynamics();
  void keep_dynamics();
  bool take_up_kept(const std::vector<int>& released);
  void begin_phase();
  void take_report();
  /// Does what the phase's end asks for. False: the run ends.
  bool end_phase(RowObserver& rows);
  bool give_up(const Report& report);
  /// Begins the next phase; `stop`: see act().
  Report change(bool acts, const Event*& stop);
  Report start_contacts();
  /// Goes on from `state` with the rows that hold now; `engaged`: elements that do from now on.
  /// `work_of_jolt`: what a blow or drivers did at once, the latter apart as well.
  void go_on_from(const SystemState& state, std::span<const int> engaged, bool sum_up_work, double work_of_jolt = 0,
                  const WorkByDriver& by_driver = {});
  /// Ends a phase at a transition, and begins the next one from the state that it leaves behind.
  Report change_contacts(int transition, bool sum_up_work);
  /// The same where the velocity of a driver jumps.
  Report meet_jump(bool sum_up_work);
  /// Saves the motion where it paused and goes on from what was saved.
  void save_and_resume(std::int64_t rows_given, std::int64_t next_row);
  /// Releases, engages and strikes what the events say at which the run ended; a report if that cannot be. `stop`: the
  /// one of them that ends the analysis.
  Report act(bool sum_up_work, const Event*& stop);
  Report act(int number, SystemState& state, std::vector<int>& engaged, double& work, MotionPhase& next);
  /// Takes up ropes as `memory` has them.
  Report resume_ropes(const MotionMemory& memory);
  void turn_values_to_bodies(std::span<const int> engaged, const SystemState& state);
  std::vector<double> place();
  void end_in_lock_up(const Needs& needs, RowObserver& rows);
  void take_note_of_jump(MotionPhase& next) const;
  void tell(MotionPhase next) const;

  ContactPhases contacts_;
  std::optional<SystemState> start_, end_;  // of the first phase; where events acted before one that stopped it
  std::shared_ptr<const Model> given_model_;
  std::shared_ptr<const Model> model_;  // with values moved by whole turns
  PlanOptions plan_options_;
  DynamicsOptions options_;
  std::unique_ptr<Dynamics> dynamics_;
  std::vector<int> released_;  // elements without equations in it, ascending
  /// Dynamics of other sets of equations, the one that held last behind the others.
  struct Kept {
    std::vector<int> released;
    std::shared_ptr<const Model> model;  // its evaluator reads this one
    std::unique_ptr<Dynamics> dynamics;
  };
  std::vector<Kept> kept_;
  std::unique_ptr<EventWatch> watch_;
  std::vector<int> turned_, held_;              // see EventMemory
  std::vector<std::string> inactive_;           // what is said of elements that are released before they are engaged
  std::vector<SingularPoint> singular_points_;  // of the run, in all its phases
  std::vector<Jolt> jolts_;                     // the same
  std::vector<IntegrationMethod> methods_;      // in use so far
  Pauses pauses_;
  bool resumed_ = false;
  Report taken_up_;                               // whether ropes could be
  std::int64_t first_row_ = 0, rows_before_ = 0;  // of the grid; rows given before the motion was taken up
  /// The run under way.
  struct {
    TimeGrid grid = TimeGrid::list({});
    Needs needs;
    AnalysisReport total;
    std::int64_t rows = 0, next_row = 0;  // given, those at events as well; of the grid, where the phase begins
    std::shared_ptr<std::int64_t> steps;  // in all phases
    bool in_phase = false, over = false;
  } run_;
  PhaseWitness* witness_ = nullptr;
  StepFollower* follower_ = nullptr;
  double last_action_ = -1;  // s; and how often events acted then
  int at_once_ = 0;
};

}  // namespace catena
