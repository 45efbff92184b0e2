// Solves for positions and rates of a group of designs, each lane at its own instant, from starts that are given; and
// for multipliers, where the program has loads.
//
// Owns the numbers of the designs and the scratch of the kernels. Allocates when it is made.
#pragma once

#include <array>
#include <memory>

#include "catena/analysis/batch/lane_evaluators.hpp"
#include "catena/analysis/batch/lane_program.hpp"

namespace catena {

/// A group of designs at one instant each. Coordinates as in LaneCode: x, y, phi of the moving bodies.
struct LaneState {
  explicit LaneState(const LaneProgram& program)
      : q(3 * program.code().moving),
        qd(3 * program.code().moving),
        qdd(3 * program.code().moving),
        turned(2 * program.code().moving),
        margin(program.code().tails),
        lambda(program.has_loads() ? program.code().rows : 0),
        places(2 * program.searched().count()) {}

  /// Takes over another group's state, or that of one lane; of the same program.
  void copy(const LaneState& from) {
    t = from.t;
    each(from, [](LaneNumbers& to, const LaneNumbers& numbers) { to.copy(numbers); });
  }
  void take_lane(int lane, const LaneState& from) {
    t[static_cast<std::size_t>(lane)] = from.t[static_cast<std::size_t>(lane)];
    each(from, [lane](LaneNumbers& to, const LaneNumbers& numbers) {
      for (std::size_t k = static_cast<std::size_t>(lane); k < to.values(); k += lane_count)
        to.data()[k] = numbers.data()[k];
    });
  }

  alignas(64) std::array<double, lane_count> t{};
  LaneNumbers q, qd, qdd;
  LaneNumbers turned;  ///< cosine and sine of the angle of every moving body, where it was solved for
  LaneNumbers margin;  ///< determinants of the blocks' tails
  LaneNumbers lambda;  ///< multipliers of the solver's rows
  LaneNumbers places;  ///< on curves, where contacts were found, and are searched for from

 private:
  template <class F>
  void each(const LaneState& from, F&& f) {
    for (LaneNumbers LaneState::*numbers : {&LaneState::q, &LaneState::qd, &LaneState::qdd, &LaneState::turned,
                                            &LaneState::margin, &LaneState::lambda, &LaneState::places})
      f(this->*numbers, from.*numbers);
  }
};

class LaneSolver {
 public:
  /// `program` must outlive this object.
  explicit LaneSolver(const LaneProgram& program);

  const LaneProgram& program() const { return program_; }
  int coordinates() const { return coordinates_; }
  /// Puts the parameters of a design into a lane; the model must outlive their use. All lanes must have one. False
  /// where one is not finite.
  bool set_design(int lane, const Model& model, double length_scale);
  /// The same design in all lanes.
  bool set_designs(const Model& model, double length_scale);
  /// A lane starts anew from where its design was given: its ropes lie as they do there.
  void start_anew(int lane) {
    if (evaluators_) evaluators_->start_anew(lane);
  }
  /// Functions of time, and the instants, are the same in all lanes: they are evaluated once.
  void share_functions(bool shared) { shared_ = shared; }

  const LaneSearches& searches() const { return searches_; }
  /// q and places, from where they are, and all rates, at the instants of the state, in the first lanes.
  void solve(LaneState& state, int lanes = lane_count);
  /// q at the instants of `state` by the quintic through two states; in lanes where both are at one instant the later
  /// state's own. Returns the lanes in which a determinant, going on as it went, would keep less than `remaining_part`.
  unsigned foretell(const LaneState& before, const LaneState& after, double remaining_part, LaneState& state);
  /// What Kinematics asks of a step (kinematics/kinematics_march.cpp).
  struct Rules {
    double largest_turn, largest_contraction, longest_step, sudden_part;
  };
  /// The lanes in which the last solve, from `before` to `state`, meets them.
  unsigned judge(const LaneState& before, const LaneState& state, const Rules& rules);
  /// The lanes in which a determinant is below this part of its largest value so far, which goes on, or of 1.
  unsigned watch(const LaneState& state, double least_part, LaneNumbers& largest);

  // Of the last solve:
  /// Nothing, or what is wrong with a lane that has not converged.
  const char* trouble(int lane) const { return trouble_[static_cast<std::size_t>(lane)]; }
  bool converged(int lane) const { return converged_[0][lane] == 1; }
  double first_size(int lane) const { return first_size_[0][lane]; }    ///< of the first correction
  double first_turn(int lane) const { return first_turn_[0][lane]; }    ///< its largest angle, rad
  double contraction(int lane) const { return contraction_[0][lane]; }  ///< largest ratio of corrections
  /// x, y, phi, cos, sin of every frame; of bodies that do not move from set_design() on.
  const LaneNumbers& frame() const { return frame_; }
  const LaneNumbers& field() const { return field_; }             ///< parameters of the designs
  double residual(int lane) const { return residual_[0][lane]; }  ///< rad or length scales

  double tolerance = 1e-12;  ///< of residuals, relative to the length scale

 private:
  /// All of a design but its evaluator.
  bool put_design(int lane, const Model& model, double length_scale);
  /// Lanes in which an element or a force means nothing have not converged.
  void refuse_trouble(const LaneState& state, int lanes);
  /// The lanes that have 1 in flag_.
  unsigned flagged() const;

  const LaneProgram& program_;
  int coordinates_;
  LaneNumbers field_, function_, frame_, unit_, matrix_, right_, tail_, exchange_, load_;
  LaneSearches searches_;
  std::unique_ptr<LaneEvaluators> evaluators_;  // where kernels have no formulas
  LaneNumbers applied_;
  std::array<const char*, lane_count> trouble_{};
  LaneNumbers converged_, first_size_, first_turn_, contraction_, residual_, flag_;
  LaneJob job_{};
  std::array<const Model*, lane_count> model_{};
  bool shared_ = false;
};

}  // namespace catena
