// Gradients of measures of a motion with contacts, impacts, friction and events that act, by the way back over its
// phases: for any number of parameters what a few runs cost.
//
//   m = sum over pulses of weight x c(q, qd, qdd, lambda, p) at t        ^: derivatives of m        y = [q, qd]
//
// Within a phase as motion_adjoint.hpp, with the equations of the phase transposed (phase_transpose.hpp). Where a phase
// ends, because g(y, lambda, p) is zero there, y+ = J(y-, p), t*_p = -g_p / g', transposed:
//
//   r = m_t* - y'+^T y+^        y^ = J_y^T y+^,  p^ += J_p^T y+^        r += y'-^T y^ + what J weighs by the instant
//   y-^ = y^ - g_y r / g'       p^ -= g_p r / g'                        g_y along multipliers as well
//
// Slides of places that stick keep a value: what it weighs in the projections of the phase is gathered and goes to the
// state at which they began to. Equations and steps are those of phased_derivatives.hpp: both give the same gradient to
// rounding, but for steps that are too long for derivatives, which each of them divides by its own error.
//
// No gradient where those have none, and where several contacts close at once, several events act together or engage
// constraints: whether those hold whatever the parameters are is seen by carrying derivatives forward alone. Source:
// apps/manual/sensitivity.md; A. Griewank, A. Walther, Evaluating Derivatives, chapter 3; R. I. Leine, H. Nijmeijer,
// Dynamics and Bifurcations of Non-Smooth Mechanical Systems (2004), chapter 7.
#pragma once

#include <array>
#include <functional>
#include <map>
#include <memory>

#include "catena/analysis/adjoint/column_slopes.hpp"
#include "catena/analysis/adjoint/measure_adjoint.hpp"
#include "catena/analysis/motion/derivative_error.hpp"
#include "catena/analysis/sensitivity/phases/phase_transpose.hpp"
#include "catena/analysis/sensitivity/phases/phased_derivatives.hpp"

namespace catena {

class PhasedMeasures final : public StateDerivatives, public PhaseWitness, public MeasureAdjoint {
 public:
  PhasedMeasures(PhasedDesign design, GivenByModel start);
  ~PhasedMeasures() override;

  bool goes_back() const override { return true; }
  /// False: states have no derivatives here, only measures have.
  bool find(const Snapshot& snapshot) override;
  void begin(const MotionPhase& phase) override;
  void cover(const MotionStretch& stretch) override;
  void keep(const Snapshot& snapshot) override;
  std::optional<MeasureGradients> find_gradients(const ColumnSet& columns,
                                                 const std::vector<std::vector<ColumnPulse>>& pulses) override;

 protected:
  int seen_order() const override { return 3; }

 private:
  using Vector = std::vector<double>;
  using Point = PhaseTranspose::Point;
  struct Step {
    double from = 0, to = 0;
    Vector begin, end;  // y
    std::vector<CurvePlace> places;
    std::size_t phase = 0;
  };
  /// How the motion goes on in another way after a step: what determines the instant, and what happens.
  struct Crossing {
    MotionPhase phase;
    bool same_phase = false;              // functions of time jump alone
    std::optional<WatchedPlace> place{};  // whose phase ends
    int event = -1;                       // that acts
    std::optional<double> by_time{};      // g'; not known where it does not settle
    std::string trouble{};                // why not
    Vector rate{};                        // t*_p where functions of time jump
    bool is_found() const { return place || event >= 0; }
    bool moves() const {
      return is_found() || std::any_of(rate.begin(), rate.end(), [](double r) { return r != 0; });
    }
  };
  struct Look {
    double t;
    std::size_t measure, column;
    double weight;
  };
  /// One measure on its way back.
  struct Way {
    Vector y1{}, y0{}, gradient{}, anchor{};  // ^ at the end of the step and at its beginning, of parameters, of rows
    std::vector<Vector> slopes{}, back{};     // k_s^ by the interpolant; Y_s^
    std::array<std::vector<Vector>, 2> errors{};  // Y_s^ of the embedded errors E5 and E3
    bool begun = false;
    double instant = 0;  // r
  };
  /// What happens at a crossing, forwards.
  struct Passage {
    Point before{}, after{};
    struct Blow {
      VelocityJump jump;
      std::vector<int> released;
      std::vector<ContactState> states{};
      PhaseTranspose::Jump step{};
    };
    std::vector<Blow> blows{};
  };

  bool lose(double t, std::string_view what);
  bool singular_at(double t);
  PhaseGroup group_of(std::size_t g) { return {groups()[g].mechanism, places_[g], *reached_[g]}; }
  ContactSlopes contact_slopes();
  // While the motion runs: phased_measures.cpp.
  bool look_at(const MotionStretch& stretch, double t, Vector& y, std::vector<CurvePlace>* places);
  Point point_of(double t, Side side, const Vector& y) const;
  void hold(const MotionPhase& phase) { equations_->hold(phase.released, phase.states); }
  bool keep_steps(const MotionStretch& stretch);
  void find_rate(const MotionStretch& stretch);
  Crossing crossing_of(const MotionPhase& phase);
  std::string obstacle_of(const MotionPhase& phase, const Crossing& crossing) const;
  bool holds_for_sure(int element, const MotionPhase& phase, const Crossing& crossing) const;
  bool crosses_at(double t) const;
  // The way back: phased_measures_back.cpp.
  bool go_back_to_end(std::size_t k, std::span<const Look>& looks);
  /// Over the last of the first k steps; k: the number of those that are left.
  bool go_back_over(std::size_t& k, std::span<const Look>& looks);
  bool recompute(const Step& step, bool interpolated);
  /// `checks`: errors are carried along.
  bool stages_back(const Step& step, bool interpolated, bool checks);
  bool stage_back(std::size_t stage, const Vector& k, Vector& back);
  /// The same of both embedded errors.
  bool errors_back(double h, std::size_t stage, Way& way);
  /// How many times what it may y^ misses of the step over which all went back.
  double excess() const;
  std::size_t begun() const;
  bool divide(std::size_t& k, int parts);
  bool project_back(const Point& point, Way& way, Vector& y);
  bool add_looks(std::span<const Look> looks, const Point& there, const std::function<Vector&(std::size_t)>& target);
  bool add_inside(const Step& step, std::span<const Look> looks);
  bool add_slopes(const Point& point, const StateSlopes& slopes, Way& way, Vector& y);
  void add_weights(const Point& point, Way& way);
  void add_gradient(std::size_t g, const PhaseTranspose::ByParameter& part, Way& way);
  bool add_start();
  void release_anchors(const Point& point, Way& way);
  // Across crossings: phased_measures_crossings.cpp.
  bool find_passage(const Crossing& crossing, const Step& last, Passage& passage);
  void find_blows(const Crossing& crossing, Passage& passage) const;
  bool cross_back(const Crossing& crossing, const Step& last);
  bool end_back(const Crossing& crossing, const Step& last, Passage& passage, Way& way);
  bool bends(const Passage& passage) const;

  std::size_t n_;  // coordinates
  ContactModel contacts_;
  DesignModels models_;
  std::vector<std::vector<DesignPlace>> places_;  // by group
  std::shared_ptr<const Plan> open_plan_;
  std::vector<DesignEvent> events_;
  Vector sizes_;
  GivenByModel given_start_;
  DerivativeAim aim_;
  BackChecks checks_;
  std::unique_ptr<AdjointMechanism> adjoint_;
  std::vector<std::unique_ptr<AdjointMechanism::Reached>> reached_;  // by group
  std::unique_ptr<PhaseEquations> equations_;
  std::unique_ptr<PhaseTranspose> transpose_;
  std::vector<MotionPhase> phases_;
  std::vector<Step> steps_;
  std::map<std::size_t, Crossing> crossings_;  // by the number of the step that follows
  std::map<double, Vector> states_;            // y where measures look
  struct {
    int number = -1;
    std::optional<double> by_time{};
    std::string trouble{};
  } ended_by_;                            // what ended the last stretch
  std::unique_ptr<ColumnSlopes> slopes_;  // of the columns of measures, on the way back
  std::vector<DesignContacts> what_contacts_do_;
  std::vector<Point> stage_;
  std::vector<Vector> slope_;  // of stages
  std::vector<Way> ways_;
};

}  // namespace catena
