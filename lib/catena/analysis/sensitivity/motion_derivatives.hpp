// Derivatives of a motion under forces, carried forward with it: the variational equations of its steps.
//
//   y = [q, qd]    y_p' = [qd_p, qdd_p]
//   [ M      Phi_q^T ] [ qdd_p    ]   [ (Q - M qdd - Phi_q^T lambda)_p ]
//   [ Phi_q  0       ] [ lambda_p ] = [ gamma_p - (Phi_q qdd)_p        ]      partials along q_p, qd_p
//
// by the method of Dormand and Prince of order 8 over the very steps that the motion took, once for all parameters
// (motion_tangents.hpp). Where the motion takes steps of this method, and lets them be seen, its own stages are those
// of the derivatives, with their factors (motion/stage_watcher.hpp). Else every stage is recomputed from the state at
// the step's start, and steps that are shorter than this method needs, between instants that are asked for, are taken
// several as one (recomputed_steps.hpp). A step that is too long for derivatives, though not for the motion, is taken
// in parts (motion/derivative_error.hpp). Where constraints depend on each other, and for models with laws of state,
// ropes over pulleys or massless bodies, step by step in dual numbers. At the step's end positions and velocities are
// those of the motion, and their derivatives are projected as these were: Phi_q q_p = -Phi_p, and the same for
// velocities, changed least in the metric of the masses. What a projection's own bending adds is of the size of the
// drift that it removes, that is of the tolerance. Between ends of steps derivatives follow from the interpolant of
// order 7 of their stages.
//
// At an instant t* at which functions of time jump, and which parameters move, the state's derivatives jump:
//
//   q_p+  = q_p- + (qd- - qd+) t*_p
//   [ M      Phi_q^T ] [ qd_p+ ]   [ M (qd_p- + (qdd- - qdd+) t*_p) - M_p (qd+ - qd-) - (Phi_q^T mu)_p ]
//   [ Phi_q  0       ] [ mu_p  ] = [ nu_p - (Phi_q qd+)_p                                             ]
//
// M (qd+ - qd-) + Phi_q^T mu = 0 the blow of drivers whose velocities jump, its partials along q_p- + qd- t*_p.
// Singular where two functions jump at once that move apart, and where the motion begins at such an instant: no
// derivatives. An instant at which an event acts is not followed; one at which a law of state switches is
// (motion/switch_instants.hpp). Source: apps/manual/sensitivity.md; E. Hairer, S.
// Norsett, G. Wanner, Solving Ordinary Differential Equations I, section I.14.
#pragma once

#include <memory>
#include <optional>

#include "catena/analysis/motion/derivative_error.hpp"
#include "catena/analysis/motion/stage_watcher.hpp"
#include "catena/analysis/motion/switch_instants.hpp"
#include "catena/analysis/motion/tableau.hpp"
#include "catena/analysis/sensitivity/design_steps.hpp"
#include "catena/analysis/sensitivity/motion_tangents.hpp"
#include "catena/analysis/sensitivity/recomputed_steps.hpp"
#include "catena/analysis/sensitivity/saddle_system.hpp"
#include "catena/analysis/sensitivity/start_derivatives.hpp"
#include "catena/analysis/sensitivity/state_derivatives.hpp"

namespace catena {

class MotionDerivatives final : public StateDerivatives, private StageWatcher {
 public:
  MotionDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters, GivenByModel start,
                    DerivativeAim aim = {});

  void cover(const MotionStretch& stretch) override;
  bool find(const Snapshot& snapshot) override;
  StageWatcher* stage_watcher() override { return tangents_ ? this : nullptr; }
  /// As how many steps the motion's were taken so far.
  int blocks() const { return blocks_; }
  /// How many steps were taken in parts so far.
  int divided() const { return divided_; }

 protected:
  bool find_before(const Snapshot& snapshot) override;
  int seen_order() const override { return 3; }

 private:
  using Step = RecomputedSteps::Step;
  /// Of one group: y = [q, qd] where the present step begins, where it ends, its stages and those of the
  /// interpolant; and at the last instant at which functions of time jump, just before it and after.
  struct Track {
    DesignVector begin, end, before, after;
    std::vector<DesignVector> stage;
  };
  /// Of all parameters beside each other: y where the step begins and ends, y and accelerations at the instant asked
  /// for.
  struct TangentRows {
    MotionTangents::Rows begin, end, now, accelerations;
  };

  bool begin_stages(double from, double to, std::span<const double> y) override;
  void watch_stage(int s, double t, Side side, std::span<const double> y, std::span<const double> slope,
                   EquationsOfMotion& equations) override;
  /// The first stage of the steps that are tried from here; false: it has none.
  bool begin_watched(double from, std::span<const double> rates);
  /// Takes the step that was watched, if it is this one; false: it is to be recomputed.
  bool take_watched(const Step& step);
  /// What begins where the last block ended, at this state; then what ends at that of step_.
  void begin_block(double from, const RecomputedSteps::Vector& y);
  void end_block();
  void note_block(std::span<const Step> steps);
  bool start(double t, std::span<const double> q, std::span<const double> qd);
  /// Positions and velocities of the motion to y of all tracks.
  void take_values(const RecomputedSteps::Vector& values, DesignVector Track::*y);
  /// Carries derivatives over the steps that wait, so that t, within the last of them, can be asked for.
  bool catch_up(double t);
  /// Over as many of these steps as can be taken as one; what waits begins with them.
  bool take_block(std::span<const Step> steps);
  /// Of a step that was divided: states where a part begins are those of the recomputed motion, its own at the end.
  struct Part {
    Step step;
    std::vector<DesignVector> begin;  // by group
  };
  /// Takes a step, which misses so many times what it may, in parts; those that still miss too much, in parts again.
  bool take_in_parts(const Step& step, double missed);
  bool divide(const Step& whole, double missed);
  bool take_part(const Step& part);
  bool is_part(const Step& step) const { return !parts_.empty() && step.from < parts_.back().step.to; }
  /// To the part of the step divided last in which t lies.
  bool return_to_part(double t);
  /// How many times what it may the step that was taken misses derivatives.
  double excess();
  void undo_step();
  /// Of as many of the steps as are taken as one: `count`.
  double take_joined(std::span<const Step> steps, std::size_t& count);
  /// The same by tangents, of the steps joined in step_; false where constraints depend on each other.
  bool take_by_tangents();
  bool take_in_dual_numbers();
  /// The last block, which is one step, once more: where an instant inside of it has no tangents.
  bool retake_in_dual_numbers();
  /// A stage where derivatives are projected and looked at.
  RecomputedSteps::Stage& place();
  void to_rows(DesignVector Track::*y, MotionTangents::Rows& rows) const;
  void from_rows(const MotionTangents::Rows& rows, DesignVector Track::*y);
  /// The state at a snapshot from rows of derivatives; nothing where constraints depend on each other.
  bool find_by_tangents(const Snapshot& snapshot);
  /// Past the jump of functions of time where the step ends.
  bool cross();
  /// From y just before it to y after, with what this leaves of M (qd+ - qd-) + Phi_q^T mu = 0.
  bool cross(Group& group, Track& track, std::span<const double> rate);
  bool project_end(double t, Side side);
  bool make_step(double h);
  /// y' at stage (or end) `y` of a group.
  bool derivative(Group& group, double t, Side side, const DesignVector& y, DesignVector& slope);
  bool prepare_interpolant(Group& group, Track& track);
  /// Projects the derivatives in y onto the constraints at its values.
  bool project(Group& group, double t, Side side, DesignVector& y);
  bool factorize(double t, Side side, std::span<const DesignScalar> q);
  /// State, accelerations and multipliers of a group from y, where they are wanted.
  bool take_state(Group& group, const Snapshot& snapshot, Side side, const DesignVector& y);
  bool singular(double t);
  bool not_shown(double t);
  // Switches of laws of state: motion_blocks.cpp.
  using Switches = std::vector<SwitchInstants::Switch>;
  /// Takes a step in parts, between switches.
  bool take_between(const MotionStretch& stretch, const Step& whole, const Switches& switches);
  void keep_part();
  /// Makes the part of the last step nearest to t the present one.
  void go_to_part(double t);

  std::size_t n_;  // coordinates
  SwitchInstants switches_;
  SaddleSystem system_;
  GivenByModel given_start_;
  DerivativeAim aim_;
  bool started_ = false, has_step_ = false, interpolant_ready_ = false;
  bool started_by_trial_ = false;  // at a step that was tried, before anything was shown
  double from_ = 0, to_ = 0;
  std::optional<double> crossed_;  // where functions of time jumped last
  std::vector<Track> tracks_;
  std::vector<double> values_;
  DesignVector stage_, y_;
  /// Of the last step, as its from_, to_ and tracks_ were; all but the present one.
  struct Between {
    double from = 0, to = 0;
    bool step = false, interpolant = false;
    std::vector<Track> tracks{};
  };
  std::vector<Between> between_;
  // By tangents; nullptr where the model does not have them.
  std::unique_ptr<RecomputedSteps> again_;
  std::unique_ptr<MotionTangents> tangents_;
  std::unique_ptr<RecomputedSteps::Stage> place_;  // once it was asked for
  std::vector<Step> pending_, block_;              // steps that wait, and those that the last block is made of
  Step step_;                                      // that block
  bool by_tangents_ = false;                       // it was carried over by them
  int blocks_ = 0, divided_ = 0;
  std::vector<Part> parts_;           // of the step that was divided last
  bool goes_on_ = false;              // the motion goes on from where the last step ended ...
  RecomputedSteps::Vector last_end_;  // ... here
  TangentRows rows_;
  /// The step whose stages are watched: how many were seen of all, one after the other.
  struct Watched {
    double from = 0, to = 0;
    int stages = 0;
    bool begun = false;                  // the first one is known, whatever the step's length
    bool place_serves = false;           // place() has what is known where it begins
    bool recomputed = false;             // again_ has the stages of the last block
    double excess = 0, too_long_to = 0;  // of the last one, and where it ends, if it is to be divided
  } watched_;
};

}  // namespace catena
