// Forward dynamics: the motion that follows from forces, constraints and drivers (apps/manual/dynamics.md).
//
// The start is assembled, its velocities made consistent; then an integrator steps through time, stopping where a
// function of time has a breakpoint, and rows are interpolated between its steps and projected onto the constraints, so
// that however many there are they do not shorten steps. Accelerations and multipliers of rows come from one solve at
// the row, only if needed. Where no step can be made any more, the report says when and why; rows so far are kept. In a
// dead point a last row gives the place, without the rates, which grow without bound there.
#pragma once

#include <limits>
#include <memory>
#include <optional>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/analysis/dynamics/dynamics_options.hpp"
#include "catena/analysis/dynamics/dynamics_state.hpp"
#include "catena/analysis/dynamics/integrators/integrator.hpp"
#include "catena/analysis/dynamics/integrators/motion.hpp"
#include "catena/analysis/dynamics/integrators/step_follower.hpp"
#include "catena/analysis/dynamics/singular_rows.hpp"
#include "catena/analysis/events/event_watch.hpp"
#include "catena/analysis/events/law_stretches.hpp"
#include "catena/analysis/motion/equations_of_motion.hpp"
#include "catena/analysis/motion/redundant_rows.hpp"
#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/run/row_observer.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/system_state.hpp"
#include "catena/analysis/run/watched_elements.hpp"

namespace catena {

class Dynamics {
 public:
  explicit Dynamics(std::shared_ptr<const Model> model, const PlanOptions& plan_options = {},
                    const DynamicsOptions& options = {});

  const Plan& plan() const { return *plan_; }
  /// The method in use: the requested one, or the one chosen automatically.
  IntegrationMethod method() const { return methods_.present; }
  /// All that were in use, in the order of their first steps.
  const std::vector<IntegrationMethod>& methods() const { return methods_.used; }
  Evaluator& evaluator() { return evaluator_; }

  /// Starts from a state of an earlier analysis instead of the given configuration at t = 0.
  void start_from(const SystemState& state);
  /// Assembles and makes velocities consistent, if nothing did before, and goes through the grid. An automatic method
  /// is rk8 where the observer sees the stages; see method().
  AnalysisReport run(const TimeGrid& grid, const Needs& needs, RowObserver& observer);

  /// run() in parts, for motions that go on side by side: begin(), go_on() as often as one likes, end().
  void begin(const TimeGrid& grid, const Needs& needs);
  /// Goes on until `rows` rows of the grid were given in all, counted from begin(), or the run ends. False: it ended
  /// before, and no row will come any more.
  bool go_on(std::int64_t rows, RowObserver& observer);
  AnalysisReport end();

  /// run() ends, and paused() says so, with the first step that reaches t (s) and does not lie across a singular
  /// position, after its rows.
  void pause_after(double t) { pause_after_ = t; }
  bool paused() const { return run_.paused; }
  /// run() also ends, and jumped() says so, where the velocity of a driver jumps while contacts hold: what they do then
  /// is not for this class to decide.
  bool jumped() const { return run_.jumped; }
  /// The state of the motion where the last run paused.
  const MotionMemory& memory() const { return memory_; }
  /// Takes up a motion of the same model and options that paused: the next run() begins there, on the rest of its grid.
  void resume(const MotionMemory& memory);

  /// Forces of contacts from now on, made for evaluator(); nullptr: none.
  void attach(ContactLoads* contacts);
  /// Looks for events during run(): a row is given at each, and one that acts ends the run there. nullptr: none.
  void watch(EventWatch* events) { attached_.events = events; }
  /// The follower is told of every step of run(); nullptr: none.
  void follow(StepFollower* follower) { attached_.follower = follower; }
  /// The event at which the last run ended before the end of its grid, or -1; and the row of the grid that was next.
  int stopped_by() const { return run_.stopped_by; }
  /// The events of the list that act there, in its order: those that happened at the same instant.
  const std::vector<int>& acting() const { return run_.acting; }
  std::int64_t next_row() const { return run_.next_row; }
  WorkSoFar work_so_far() const;
  /// Where `auto` chooses: begins with the method that another phase of the same motion ended with.
  void begin_with(IntegrationMethod method);
  /// What moved in the last run, J, and in those before it of the same motion: errors are compared with the whole.
  double energy_in_motion() const { return work_.balance ? work_.balance->energy() : work_.earlier_motion; }
  void know_energy(double energy) { work_.earlier_motion = energy; }
  /// How laws change with time, where that was looked at; to be known by another phase of the same motion.
  const std::shared_ptr<const LawStretches>& law_stretches() const { return law_stretches_; }
  void know_law_stretches(std::shared_ptr<const LawStretches> laws) { law_stretches_ = std::move(laws); }
  /// Counts work from an earlier start; energy that is missing against then counts as dissipated (an impact).
  void carry_on(WorkSoFar work) { work_.earlier = std::move(work); }

  /// Steps of the next runs are counted, for max_steps, together with those of others, which use the same number.
  void count_steps_in(std::shared_ptr<std::int64_t> steps) { pace_.of_all = std::move(steps); }

  /// The velocities of the next start are those before `event` acts, and may have to jump.
  void expect_jolt(std::string event) { origin_.jolting_event = std::move(event); }
  /// Where velocities jumped in the last run, its start included if that was expected.
  const std::vector<Jolt>& jolts() const { return run_.jolts; }
  /// Where jumped(): the drivers concerned.
  const std::vector<int>& jumping_drivers() const { return run_.jumping; }

  /// Where the drivers asked for a motion that cannot be made: at the start, or where the run ended.
  const std::vector<SingularPoint>& singular_points() const { return run_.singular_points; }

  double time() const { return t_; }
  std::span<const double> q() const { return q_; }
  std::span<const double> qd() const { return qd_; }
  /// The present state, absolute and in model order.
  SystemState state() const;
  /// Where a body is where the last run ended: the frame in which its points and attachments were given. By its number
  /// in the model; throws std::out_of_range for one that no body has.
  Frame<double> frame(int body) const { return frame_of(evaluator_, q_, body); }

 private:
  void choose_method(bool stages_are_watched);
  Report check_options() const;
  Report prepare(std::vector<std::string>& warnings);
  std::unique_ptr<Integrator> make_integrator(const Motion& motion, double horizon) const;
  void look_for_singularity(double t);
  std::string near_branches();
  std::optional<SingularPoint> dead_point_ahead();
  std::optional<SingularPoint> infinity_ahead();
  std::optional<Report> lock_up_ahead();
  double time_to_dead_point(std::span<const double> w, std::vector<double>& q);
  void give_row_at_lock_up(RowObserver& observer);
  bool know_singular_start();
  bool know_start_from_rest();
  std::optional<SingularStart> singular_start();
  int branch_of_given_velocities(const SingularPoint& point);
  std::optional<RedundantRows::GenericPlace> place_along(const SingularStart& start);
  Report check_order() const;
  int freedoms() const;
  Report check_freedoms() const;
  Report check_method() const;
  Report start();
  Report set_out();
  Report next(RowObserver& observer);
  Report step(RowObserver& observer);
  Report start_anew();
  void take_note_of_start();
  void take_note_of_jump(std::span<const double> before);
  Report check_balance();
  Report judge_balance(double t);
  Report check_redundant_rows();
  void remember();
  Report give_row(double t, RowObserver& observer);
  std::optional<Snapshot> state_at(double t);
  Report check_ends_at(std::span<const double> y) const;
  Report check_curve_ends(double from, RowObserver& observer);
  Report find_events(double from, RowObserver& observer);
  Report show(double from, double to, RowObserver& observer, int ended_by = -1);
  void find_multipliers();
  void describe_mobility(AnalysisReport& report);
  Report stuck();
  static Report cancelled(double t);
  Report check_pace(double last);
  void begin_looking_for_stiffness();
  bool look_for_stiffness(double limit);
  double try_method(IntegrationMethod method, int steps, double limit);
  double next_breakpoint(double t) const;
  void look_ahead_at_laws();
  Snapshot snapshot(double t, std::span<const double> y, const Needs& needs) const;

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Plan> plan_;
  DynamicsOptions options_;
  struct {
    IntegrationMethod present = IntegrationMethod::rk8;
    std::vector<IntegrationMethod> used;
  } methods_;
  EvaluationWork evaluation_;
  Evaluator evaluator_;
  EquationsOfMotion equations_;
  RedundantRows redundant_;
  WatchedElements watched_;
  struct {
    EventWatch* events = nullptr;
    StepFollower* follower = nullptr;
    ContactLoads* contacts = nullptr;
  } attached_;
  double t_ = 0;
  std::vector<double> q_, qd_;
  MotionOrigin origin_;
  MotionMemory memory_;
  double pause_after_ = std::numeric_limits<double>::infinity();
  // Of the run under way.
  DynamicsRun run_;
  struct {
    std::optional<Evaluator::TimeLimit> limit;  // while it lasts
    std::optional<Motion> motion;
    std::unique_ptr<Integrator> integrator;
    bool all_is_driven = false;  // constraints and drivers leave no freedom
  } under_way_;
  std::shared_ptr<const LawStretches> law_stretches_;  // none where no law reads t, or steps are fixed
  StepPace pace_;
  /// The search for stiffness: steps and time at the last look, and when the next one is.
  struct {
    bool wanted = false, may_change = false;
    std::int64_t step = 0, next = 0, wait = 0;
    double t = 0;
    IntegrationMethod explicit_method = IntegrationMethod::rk8;
  } stiffness_;
  MotionWork work_;
  PresentRow row_;
  SingularRows singular_;
  LeastMultipliers reactions_;
};

}  // namespace catena
