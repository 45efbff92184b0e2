// What contacts do next, at an instant at which one of them changes: impacts, then which of them press, stick and
// slide.
//
//   impact        M (qd+ - qd-) + Phi_q^T p = J^T x,  Phi_q qd+ = nu      x: impulses of contact_problem.hpp
//   Newton        v_n+ >= -e v_n-, equal where x_n > 0                    friction: |x_t| <= mu x_n
//   then          accelerations of gaps and slides at qd+ decide which places press, stick and slide
//
// A strike is an impulse on a point; what it presses together collides then. Where a constraint is engaged or the
// velocity of a driver jumps, velocities meet that first: v_n- is the rate then.
//
// All places that touch take part together, of those that constraints and other places tie to the one that changed:
// impulses and forces do not reach the others. Their impulses do no work, x^T (v- + v+) / 2 <= 0, v the rates of gaps
// and slides: what the bodies gain is then the work of drivers. Where impacts with friction of several places would do
// some (Kane's example), the restitution of all is reduced until they do not.
//
// Where drivers move on against closed places no impulse stops them: D_nn = 0, or w_n >= 0 has no solution even without
// friction. The motion ends there, in a lock-up.
//
// A place that would bounce slower than its rest speed, or with e = 0, stays closed; had it bounced before, the instant
// of its landing is when ever smaller bounces would have ended: t + T e / (1 - e), T the time since the last bounce.
// Units as in contact_points.hpp.
#pragma once

#include <algorithm>
#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/analysis/contact/motion_phase.hpp"
#include "catena/analysis/contact/problem/contact_problem.hpp"
#include "catena/analysis/contact/several_states.hpp"
#include "catena/analysis/contact/shared_forces.hpp"
#include "catena/analysis/events/motion_sizes.hpp"
#include "catena/analysis/events/strike.hpp"
#include "catena/analysis/motion/equations_of_motion.hpp"
#include "catena/analysis/motion/impulses.hpp"
#include "catena/analysis/motion/redundant_rows.hpp"
#include "catena/analysis/pose/singular_point.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/status.hpp"

namespace catena {

/// The gradient of a gap or slide times x, by coordinate.
double product(const Evaluator::ScalarMotion& of, std::span<const double> x);
/// The sizes of its terms together, for its rounding.
double size_of_product(const Evaluator::ScalarMotion& of, std::span<const double> x);

/// A change of a contact.
struct ContactEvent {
  int element = -1;
  std::string_view kind;  ///< impact, contact, release, stick or slip
  double t = 0;
};

class ContactSwitch {
 public:
  /// `plan`: one in which no row of a contact holds. The points must outlive this object.
  ContactSwitch(std::shared_ptr<const Model> model, const std::vector<ContactPoint>& points, const PlanOptions& plan);

  Evaluator& evaluator() { return evaluator_; }
  EquationsOfMotion& equations() { return equations_; }
  /// Masses, and what else is found once, at a configuration that meets the constraints.
  Report prepare(std::span<const double> q);

  /// Why contacts are decided about.
  struct Cause {
    int place = -1;                      ///< the one that changed; -1: something else did
    bool opens = false;                  ///< nothing presses it any more, to rounding
    bool rests = false;                  ///< its slide is at rest, to rounding
    bool shares = false;                 ///< places that hold each other, this one among them, keep no limit any more
    std::vector<GivesWay> giving_way{};  ///< those of them whose limits these are
    int leaves = 0;    ///< sign of the slip with which it leaves a state of sticking: friction has reached its limit
    bool tell = true;  ///< changes of places are events; impacts always are
    const Strike* strike = nullptr;  ///< acts before anything closes
    bool jolts = false;  ///< velocities need not meet the constraints: one was engaged, or a driver's velocity jumps
  };
  /// Changes qd by impacts, and `states` to what holds from t on.
  Report decide(double t, std::span<const double> q, std::span<double> qd, std::vector<ContactState>& states,
                const Cause& cause);
  /// Goes on from what another one knew of the same points, before constraints came or went.
  void take_over(const ContactSwitch& earlier);
  /// Takes note of a speed of the motion, see fastest().
  void know_speed(double speed) { speed_ = std::max(speed_, speed); }
  double speed() const { return speed_; }
  /// Of the motion so far, where contacts were decided about.
  const MotionSizes& sizes() const { return sizes_; }
  /// The work of the last strike, J.
  double work_of_strike() const { return work_of_strike_; }
  /// What constraints exerted at the last decision, where it was about a strike or a jolt: collisions that followed at
  /// once included.
  std::vector<ConstraintImpulse> take_impulses() { return std::move(impulses_); }
  /// How velocities jumped at the last decision; nothing where they did not.
  const std::optional<VelocityJump>& jump() const { return jump_; }
  /// Where drivers ask for a motion that closed places rule out, once decide() has said so.
  const std::optional<SingularPoint>& blocked() const { return blocked_; }
  /// Of places that hold each other since they were decided about last.
  const std::vector<SharedForces>& shared() const { return shared_; }
  std::vector<SharedForces>& shared() { return shared_; }
  /// Impacts in which Newton's restitution would have made energy grow.
  struct OtherLaws {
    int poisson = 0;   ///< Poisson's took its place
    int reduced = 0;   ///< that did not fit either: every restitution was reduced
    double first = 0;  ///< instant of the first of them, s
    int element = -1;  ///< that was hit then
  };
  const OtherLaws& other_laws() const { return other_laws_; }
  /// Decisions at which other states of friction would have fitted as well (several_states.hpp).
  struct SeveralStates {
    int times = 0;
    double first = 0;    ///< instant of the first of them, s
    std::string states;  ///< those that were taken then, and others
  };
  const SeveralStates& several_states() const { return several_states_; }
  /// What happened since this was called last.
  std::vector<ContactEvent> take_events() { return std::move(events_); }

 private:
  /// What was noted of every point, s.
  struct Past {
    explicit Past(std::size_t points)
        : bounced_at(points, -std::numeric_limits<double>::infinity()),
          landing(points, std::numeric_limits<double>::quiet_NaN()),
          left_at(bounced_at),
          flight(landing) {}
    /// All but the event under way.
    void take_over(const Past& earlier) {
      bounced_at = earlier.bounced_at;
      left_at = earlier.left_at;
      flight = earlier.flight;
    }

    std::vector<double> bounced_at;  // when it hit and came back last
    std::vector<double> landing;     // instant of the `contact` event under way, or NaN
    std::vector<double> left_at;     // when it was last let go, by its speed or by drivers
    std::vector<double> flight;      // how long it was open before it landed last; NaN: it never was
  };

  void look(std::span<const double> qd);
  void apply(const Strike& strike, std::span<const double> q, std::span<double> qd);
  void find_touching(const std::vector<ContactState>& states, const Cause& cause);
  void find_groups();
  bool is_active(std::size_t k) const;
  void let_grips_go(std::vector<ContactState>& states);
  void tie_grips(const ContactProblem& problem, std::vector<ContactState>& states) const;
  void tie_joints(const ContactProblem& problem, std::vector<ContactState>& states) const;
  void share_or_leave(double t, std::span<const double> qd, const std::vector<ContactState>& states, const Cause& cause,
                      const ContactLoads& loads, ContactProblem& problem);
  bool holds_below_limits(const ContactProblem& problem, const std::vector<ContactState>& states) const;
  void find_responses();
  void fill(ContactProblem& problem) const;
  /// Of point k: what cannot be told from rest, m/s or rad/s, as a part of the largest speed.
  double part_of_speed(std::size_t k, double part) const;
  /// Of point k: slower than that a rebound is none.
  double rest_speed(std::size_t k) const;
  bool hits(std::size_t k) const;
  Report collide(double t, std::span<double> qd, std::vector<ContactState>& states);
  // Impacts: contact_impact.cpp.
  void set_up(ContactProblem& problem, double restitution_part, std::span<const double> qd) const;
  double act(const ContactProblem& problem, std::span<double> qd);
  bool bounce(double restitution_part, std::span<double> qd, double& work);
  bool bounce_by_poisson(std::span<double> qd, double& work);
  bool bounce_without_gain(double t, const std::vector<std::size_t>& hit, std::span<double> qd);
  void take_note(const ContactProblem& problem);
  double rebound(std::size_t k) const;
  bool find_free_accelerations(double t, std::span<const double> q, std::span<const double> qd, ContactLoads& loads);
  Report choose(double t, std::span<const double> q, std::span<const double> qd, std::vector<ContactState>& states,
                const Cause& cause);
  Report choose_among(double t, std::span<const double> qd, std::vector<ContactState>& states, const Cause& cause,
                      const ContactLoads& loads);
  void stick_where_pressed(double t, std::span<const double> qd, const ContactLoads& loads, ContactProblem& problem);
  void note_other_states(double t, const ContactProblem& problem);
  void note_states(double t, const ContactProblem& taken, const StatesOfFriction& other);
  std::string describe(const std::vector<ContactProblem::State>& states, const std::vector<int>& directions) const;
  void let_leave(double t, std::vector<ContactState>& states, const Cause& cause);
  void set_up(ContactProblem& problem, const Cause& cause) const;
  void prefer_giving_way(ContactProblem& problem, const std::vector<ContactState>& states, const Cause& cause) const;
  std::vector<std::vector<std::size_t>> active_by_group();
  Report press_joints(double t, std::span<const double> qd, const ContactLoads& loads, ContactProblem& problem);
  // joint_states.cpp
  // Friction of joints and their forces, in turns: each leaves a part r of the error, about mu; four thousand rounds
  // reach rounding where that part is up to 0.99. Where friction presses its own joint by more than itself, |r| > 1,
  // changes grow: N = |A + r N| has no solution then, or two.
  static constexpr int most_settling = 4000;
  struct Pressing {
    double change = 0, size = 0;  // of the limits of friction, N, N m
    bool is_settled() const { return change <= thresholds::sum_rounding * size; }
  };
  Pressing press(std::span<const double> qd, const ContactLoads& loads, ContactProblem& problem) const;
  bool settle_by_states(std::span<const double> qd, const ContactLoads& loads, ContactProblem& problem) const;
  void forget_shared();
  void tell_changes(double t, const std::vector<ContactState>& before, const std::vector<ContactState>& after);
  double kinetic_energy(std::span<const double> qd) const;
  Report failure(double t, const std::string& why) const;
  Report wedged(double t) const;
  // Feet that land and lift in turns: contact_rocking.cpp.
  std::vector<std::size_t> rocking(double t, const std::vector<std::size_t>& hit) const;
  double end_rocking(double t, const std::vector<std::size_t>& hit, std::span<double> qd);
  void note_flights(double t, const std::vector<std::size_t>& hit);
  void bring_to_rest(const std::vector<std::size_t>& rows, std::span<double> qd);
  void settle(std::span<double> qd);
  // Drivers that move on against closed places: contact_jam.cpp.
  bool gives_way(std::size_t row, double response) const;
  bool is_jammed(bool accelerates) const;
  bool returns(double t, std::size_t k, const Cause& cause) const;
  std::vector<std::size_t> pushed_through(double t, const ContactProblem& problem, const Cause& cause);
  Report blocked(double t, std::span<const std::size_t> places);

  std::shared_ptr<const Model> model_;
  const std::vector<ContactPoint>& points_;
  EvaluationWork evaluation_;
  Evaluator evaluator_;
  EquationsOfMotion equations_;
  RedundantRows redundant_;
  double work_of_strike_ = 0;
  std::vector<double> p_;  // multipliers of the velocities' jumps, while it decides
  std::vector<ConstraintImpulse> impulses_;
  double speed_ = 0;  // largest of the motion so far, m/s or rad/s times the length scale
  MotionSizes sizes_;
  Past past_;
  std::optional<SingularPoint> blocked_;
  std::optional<VelocityJump> jump_;
  std::vector<Evaluator::ScalarMotion> gap_, slide_;
  std::vector<int> group_;  // by point: impulses and forces at one point reach only points of its group
  // Of the touching places, two each: what a unit force across and along makes of accelerations and multipliers.
  std::vector<std::size_t> active_;
  std::vector<std::vector<double>> change_, multipliers_;
  struct {
    std::vector<double> load, nothing, qdd;
  } unit_;  // such a force, no right-hand sides beside it, and accelerations without any
  std::vector<SharedForces> shared_;
  OtherLaws other_laws_;
  SeveralStates several_states_;
  std::vector<ContactEvent> events_;
};

}  // namespace catena
