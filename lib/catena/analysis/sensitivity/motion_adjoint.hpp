// The gradient of a measure of a motion by any number of design parameters: the discrete adjoint of the steps that the
// motion took, in reverse.
//
//   step   y1 = P(y0 + h sum b_s k_s),  k_s = f(t_s, Y_s),  Y_s = y0 + h sum a_sj k_j        y = [q, qd]
//   k_s^ = h b_s y1^ + h sum_j>s a_js Y_j^        Y_s^ = f_y^T k_s^        y0^ = y1^ + sum Y_s^        p^ += f_p^T k_s^
//
// ^ marks derivatives of the measure. With [M, Phi_q^T; Phi_q, 0] [w; mu] = [k_qd^; 0], by the factors of the stage,
//
//   f_y^T k^ = [ w^T R_q - mu^T (Phi_q)'' ;  k_q^ + w^T R_qd - 2 mu^T (Phi_q)' ]        (adjoint_mechanism.hpp)
//
// and the projection P of positions, then velocities, of motion_derivatives.hpp transposed. The measure is a sum over
// instants of m(q, qd, qdd, lambda). Inside of a step it is reached by the interpolant of order 7 and a projection,
//
//   y(t) = P(y0 + e (y1 - y0) + h sum_s c_s k_s),  k_12 the slope at y1, k_13 ... k_15 further stages,
//
// and accelerations and multipliers by [M, Phi_q^T; Phi_q, 0] [w; mu] = [m_qdd; m_lambda] as stages are. The equations
// that are transposed are those of MotionDerivatives: both give the same gradient to rounding. Several measures share
// stages, factors and instants. Stages are recomputed from stored ends of steps: memory 4 x coordinates a step. Steps
// of another method, shorter than this one needs, are gone back over several at once, as long as what is recomputed
// misses the motion's own end by no more than its single steps do; and a step of the motion that is too long for y^ in
// parts (motion/derivative_error.hpp). That is looked at now and then, by the errors E5 and E3 of y0^: the same way
// back from y1^ with the weights of the embedded errors in place of b_s.
//
// An instant t* at which the motion goes on in another way (motion_crossing.hpp), transposed, r what t* weighs:
//
//   r = m_t* - y'+^T y+^        [M, Phi_q^T; Phi_q, 0] [w; nu] = [qd+^; 0]        r += nu^T nu_t + y'-^T y-^
//   qd-^ = M w,   q-^ = q+^ + w^T F_q - (w^T Phi_q^T mu)_q - nu^T (Phi_q qd+)_q,   p^ likewise with - w^T M_p (qd+ -
//   qd-) p^ += r t*_p,   or where an event acts   y-^ -= h_y r / h',   p^ -= (h_p - value_p) r / h'
//
// No gradient: equations that depend on each other; laws of state, ropes over pulleys; instants at which a motion
// begins or ends and goes on in another way. Source: apps/manual/sensitivity.md; A. Griewank, A. Walther, Evaluating
// Derivatives, chapter 3.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <optional>

#include "catena/analysis/motion/derivative_error.hpp"
#include "catena/analysis/sensitivity/motion_crossing.hpp"
#include "catena/analysis/sensitivity/recomputed_steps.hpp"
#include "catena/analysis/sensitivity/start_derivatives.hpp"
#include "catena/analysis/sensitivity/state_derivatives.hpp"
#include "catena/assembly/design/adjoint_mechanism.hpp"

namespace catena {

/// What a measure changes by with the state at an instant: sizes coordinates(), plan order, of by_lambda the rows of
/// the plan in the solver's scale; empty: nothing. by_instant: with the instant, one at which the motion goes on in
/// another way; the state there is that after it.
struct MotionPulse {
  double t = 0;
  std::vector<double> by_q, by_qd;
  std::vector<double> by_qdd{}, by_lambda{};
  double by_instant = 0;
};

class MotionAdjoint : public StateDerivatives {
 public:
  /// As MotionDerivatives.
  MotionAdjoint(const Evaluator& evaluator, const DesignModels& models, int parameters, GivenByModel start,
                DerivativeAim aim = {});
  ~MotionAdjoint() override;

  bool goes_back() const override { return true; }
  /// Keeps a step of the motion.
  void cover(const MotionStretch& stretch) override;
  /// False: states have no derivatives here, only measures have. The gradient is none the worse for being asked.
  bool find(const Snapshot& snapshot) override;

  using Gradients = std::vector<std::vector<double>>;
  /// dm/dp of every measure by parameter, at fixed p in the pulses themselves; nothing, and why() says it, where there
  /// is none. Pulses in any order, within the motion.
  std::optional<Gradients> gradients(const std::vector<std::vector<MotionPulse>>& measures);
  std::optional<std::vector<double>> gradient(std::vector<MotionPulse> pulses);

  int steps() const { return static_cast<int>(steps_.size()); }
  /// As how many steps the last gradient() took them.
  int blocks() const { return blocks_; }
  /// Elements that parameters reach, of all groups of parameters together: the only ones differentiated by them.
  int reached_elements() const;

  /// Whether the motion goes on in another way at the end of a step there.
  bool crosses_at(double t) const;

 protected:
  int seen_order() const override { return 3; }
  /// Until when steps are kept; nothing before the first.
  std::optional<double> covered_to() const;
  /// The motion goes on from there in another way.
  void go_on_otherwise(MotionCrossing crossing);
  bool lose(double t, std::string_view what);
  /// Of the column of an event less its value: what it changes by with the state just before the event, and by
  /// parameter at a fixed state.
  struct EventSlopes {
    MotionPulse by_state;
    std::vector<double> by_parameter;
  };
  virtual EventSlopes slopes_of_event(int event, const Snapshot& before);

 private:
  using Vector = std::vector<double>;
  using Step = RecomputedSteps::Step;
  using Stage = RecomputedSteps::Stage;
  /// What a pulse belongs to.
  struct Look {
    const MotionPulse* pulse;
    std::size_t measure;
  };
  /// One measure on its way back.
  struct Way {
    Vector y1{}, y0{}, gradient{};  // y^ at the end of the step and at its beginning; what parameters have gathered
    std::vector<Vector> slopes{};   // k_s^ by the interpolant
    bool begun = false;
    double instant = 0;  // what the instant weighs at which the motion goes on in another way
  };
  /// The motion across such an instant.
  struct Passage {
    double t = 0;
    Vector before{}, after{}, slope_before{}, slope_after{};  // y, y'
    Vector lambda_before{}, impulse{}, by_time{};             // by row: just before; of the blow mu; nu_t
    Vector change{};                                          // qd+ - qd-
  };

  /// A stage for projections and pulses.
  Stage& end_stage();
  /// From y1^ at the end of a step, which has been recomputed, to y0^, which is added to.
  void go_back(const Step& step, Way& way, bool interpolated);
  /// y^ through the projection at the end, which factorize_end() has prepared.
  bool factorize_end(double t, Side side, std::span<const double> values);
  void project_back(double t, Side side, std::span<const double> values, Way& way, Vector& y1);
  /// Parameters gather in `way`, if there is one.
  void stage_back(int number, const Vector& k, Way* way);
  /// How many times what it may y^ misses by the step over which `way` went back.
  double excess(const Step& step, const Way& way);
  /// Of y0^ by one embedded error: of positions and velocities, in parts of y^.
  double error_back(double h, const StageSum& error, const Way& way);
  /// Whether it is to be looked at in a step of this length.
  bool is_due(double h) const;
  std::size_t begun() const;
  void add_parameters(double t, Side side, const AdjointWeights& weights, std::span<const double> qdd, Way& way);
  /// What pulses at an instant with this state add to y^ there.
  bool add_pulses(std::span<const Look> looks, double t, Side side, std::span<const double> values,
                  const std::function<Vector&(std::size_t)>& target);
  /// y^ at the end of a way.
  Vector& end_of(std::size_t measure) {
    ways_[measure].begun = true;
    return ways_[measure].y1;
  }
  /// Pulses at one instant inside of a step, to slopes and ends.
  bool add_inside(const Step& step, std::span<const Look> looks);
  std::optional<std::vector<Look>> looks_at(const std::vector<std::vector<MotionPulse>>& measures);
  static std::span<const Look> take_last(std::span<const Look>& looks);
  /// The pulses at and after the end of step k - 1, the last one left, and from y^ after that instant to y^ before it.
  bool go_back_to_end(std::size_t k, std::span<const Look>& looks);
  bool go_back_over_block(std::size_t& k, std::span<const Look>& looks, Step& joined);
  /// Step k - 1 into so many; k: the number of steps to its end.
  bool divide(std::size_t& k, int parts);
  bool cross_back(const MotionCrossing& crossing, const Step& last);
  bool find_passage(const MotionCrossing& crossing, Passage& passage);
  bool find_jump(const MotionCrossing& crossing, Passage& passage);
  /// To qd-^; what the instant weighs by it.
  double jump_back(const MotionCrossing& crossing, const Passage& passage, Way& way);
  void strike_back(const std::vector<DesignStrike>& strikes, Way& way);
  bool event_back(const MotionCrossing& crossing, const Passage& passage);
  bool add_start(const Vector& y0, Vector& gradient);

  std::size_t n_;  // coordinates
  GivenByModel given_start_;
  AdjointMechanism mechanism_;
  std::vector<std::unique_ptr<AdjointMechanism::Reached>> reached_;  // by group
  RecomputedSteps again_;
  std::vector<Vector> back_;    // Y^ by stage
  std::unique_ptr<Stage> end_;  // once it was asked for
  std::vector<Step> steps_;
  std::map<std::size_t, MotionCrossing> crossings_;  // by the number of the step that follows
  std::vector<Way> ways_;                            // by measure
  int blocks_ = 0;
  DerivativeAim aim_;
  bool bends_ = false;  // forces do
  BackChecks checks_;
  bool goes_on_ = false;  // the motion goes on from where the last step ended
  Vector w_, mu_, zero_rows_, zero_loads_, masses_, slope_;
};

}  // namespace catena
