// Derivatives of a motion that goes on in another way at instants of its own: contacts that open, close, hit, stick and
// slip, constraints that events engage and release, blows.
//
// Between these instants as motion_derivatives.hpp, with the rows and forces of the phase (phase_equations.hpp). Where
// a phase ends, because g(y, p) is zero there, the instant t* moves, and the state's derivatives jump:
//
//   t*_p = -g_p / g'        g_p along y_p-, g' along the motion before
//   y_p+ = J_y (y_p- + y'- t*_p) + J_p - y'+ t*_p        y+ = J(y-, p): impacts, blows, constraints that are engaged
//
// (the saltation matrix). g: a gap; what presses; a slip; mu_static N - |T|; a column less the value of its event.
// Where a place begins to stick, its slide keeps the value it has there, with its derivative.
//
// None: a gap that closes without a speed that can be told from rounding; several places that close at once and move
// apart with the parameters; a motion that begins with an impact, or with a closed place that a parameter opens; phases
// whose end cannot be told. Sources: P. C. Mueller, Calculation of Lyapunov exponents for dynamic systems with
// discontinuities (1995); R. I. Leine, H. Nijmeijer, Dynamics and Bifurcations of Non-Smooth Mechanical Systems (2004),
// chapter 7; apps/manual/sensitivity.md.
#pragma once

#include <map>
#include <memory>
#include <optional>

#include "catena/analysis/motion/derivative_error.hpp"
#include "catena/analysis/motion/switch_instants.hpp"
#include "catena/analysis/motion/tableau.hpp"
#include "catena/analysis/sensitivity/phases/phase_equations.hpp"
#include "catena/analysis/sensitivity/phases/smooth_parts.hpp"
#include "catena/analysis/sensitivity/start_derivatives.hpp"
#include "catena/analysis/sensitivity/state_derivatives.hpp"

namespace catena {

/// An event of the list as derivatives see it.
struct DesignEvent {
  ColumnSet column;
  double value = 0;
  std::vector<double> value_rate;     ///< of its value, by parameter
  std::vector<DesignStrike> strikes;  ///< by group of parameters; empty: it strikes nothing
};

/// How instants of a motion move with the parameters, by instant; not a number where that is not known.
using InstantRates = std::map<double, std::vector<double>>;

/// What a motion with contacts and events is differentiated with.
struct PhasedDesign {
  ContactModel contacts;
  PlanOptions all_rows, open_rows;  ///< plans of contacts.model: with all equations; with those that always hold
  DesignModels models;              ///< see with_slides()
  int parameters = 0;
  std::vector<double> sizes{};  ///< of the parameters: what derivatives are measured by; empty: 1
  std::vector<DesignEvent> events{};
  DerivativeAim aim{};
};

class PhasedDerivatives final : public StateDerivatives, public PhaseWitness {
 public:
  /// `rates` is filled with the instants at which the motion goes on in another way, and of events.
  PhasedDerivatives(PhasedDesign design, GivenByModel start, std::shared_ptr<InstantRates> rates);
  ~PhasedDerivatives() override;

  void begin(const MotionPhase& phase) override;
  void cover(const MotionStretch& stretch) override;
  bool find(const Snapshot& snapshot) override;
  const std::vector<double>* phase_instant(double t) const override;

 protected:
  bool find_before(const Snapshot& snapshot) override;
  int seen_order() const override { return 3; }

 private:
  /// Of one group: y = [q, qd] where the present step begins, where it ends, just before the last crossing; its stages
  /// and those of the interpolant; and what its rows keep, see PhaseEquations::project().
  struct Track {
    DesignVector begin, end, before, anchor;
    std::vector<DesignVector> stage;
  };
  PhaseEquations::Design design(std::size_t group);
  std::span<DesignScalar> q(DesignVector& y) const { return std::span(y).first(n_); }
  std::span<DesignScalar> qd(DesignVector& y) const { return std::span(y).subspan(n_); }
  bool start(double t, std::span<const double> q, std::span<const double> qd);
  void find_anchors(std::size_t group);
  void check_rows(std::size_t group, double t, bool starts);
  void lose(std::size_t group, std::size_t p, Track& track);
  bool take_values(const MotionStretch& stretch, double t, DesignVector Track::*y);
  bool factorize(double t, Side side, const DesignVector& y);
  bool slope(std::size_t group, double t, Side side, const DesignVector& y, DesignVector& out);
  bool make_step(double h);
  // Steps in parts: phased_parts.cpp.
  bool step_on(double to);
  bool cover_part(const MotionStretch& stretch, double to);
  /// The same, in parts of it where it is too long for derivatives (motion/derivative_error.hpp).
  bool cover_in_parts(const MotionStretch& stretch, double to);
  /// How many times what it may the present part misses derivatives.
  double excess() const;
  bool undo_part(const MotionStretch& stretch, bool is_first);
  bool go_to_part(double t);
  void keep_part();
  // Switches of laws of state: phased_switches.cpp.
  using Switches = std::vector<SwitchInstants::Switch>;
  /// Covers the parts of a stretch that end there, between switches.
  bool cover_between(const MotionStretch& stretch, std::span<const double> ends, const Switches& switches);
  bool project(double t, Side side, DesignVector Track::*y);
  bool prepare_interpolant();
  /// Before the crossing there, if the step ends with one.
  const DesignVector& end_of_step(const Track& track) const;
  bool take_state(std::size_t group, const Snapshot& snapshot, Side side, const DesignVector& y);
  bool singular(double t);
  bool not_shown(double t);
  // Instants and crossings: phased_instants.cpp, phased_crossing.cpp.
  void find_rates(const MotionStretch& stretch);
  std::optional<std::vector<double>> rate_of_place(const MotionStretch* stretch, const WatchedPlace& watched);
  std::optional<std::vector<double>> rate_of_event(const MotionStretch& stretch, const DesignEvent& event,
                                                   bool is_first);
  std::vector<double> rates_of(const MotionPhase& phase);
  bool has_passed(const WatchedPlace& watched);
  void note_landings(const MotionPhase& phase, const std::vector<double>& rate);
  bool cross(const MotionPhase& phase, const std::vector<double>& rate);
  bool cross_functions();
  std::span<const double> rates_of_group(const std::vector<double>& rate, std::size_t group);
  bool jump(const VelocityJump& jump, const std::vector<double>& rate, std::vector<DesignVector>& there);
  template <class Target>
  bool jump_on(const VelocityJump& jump, const std::vector<double>& rate, std::vector<DesignVector>& there,
               Target&& target);
  std::vector<int> released_in(const VelocityJump& jump) const;
  void check_hits(const VelocityJump& jump, std::size_t group, const DesignVector& there);
  void end_crossing(std::size_t group, const std::vector<double>& rate, const DesignVector& slope_before, bool jumps);
  /// Whether a parameter has no derivatives any more.
  bool lacks() const;
  double rounding(std::size_t group, std::size_t p) const;
  static void move_along(DesignVector& y, const DesignVector& slope, std::span<const double> rate, double sign);
  DesignScalar end_value(std::size_t group, const WatchedPlace& watched);
  static void note_instant(InstantRates& instants, double t, const std::vector<double>& rate);
  std::string name(std::size_t place) const;

  std::size_t n_;  // coordinates
  DesignModels models_;
  ContactModel contacts_;
  std::vector<std::vector<DesignPlace>> places_;  // by group
  std::shared_ptr<const Plan> open_plan_;
  std::vector<char> always_;  // by row: in that plan
  std::vector<DesignEvent> events_;
  std::vector<double> sizes_;
  GivenByModel given_start_;
  DerivativeAim aim_;
  std::shared_ptr<InstantRates> instants_;
  std::unique_ptr<PhaseEquations> equations_;
  SwitchInstants switches_;
  MotionPhase phase_;
  std::vector<Track> tracks_;
  struct {
    bool phase = false, start = false, step = false, interpolant = false;
  } has_;
  double from_ = 0, to_ = 0, length_scale_ = 1;
  /// Of the present step those parts (smooth_parts.hpp) that are not the one in from_, to_ and tracks_.
  struct Part {
    double from = 0, to = 0;
    bool has_interpolant = false;
    std::vector<Track> tracks;
    bool has_step = true;
  };
  std::vector<Part> parts_;
  struct {
    std::optional<double> t;   // where functions of time jumped
    std::vector<double> rate;  // of the instant at which a phase ended
  } crossed_;                  // last
  // Of the end of the present phase, by the event or transition found there.
  std::map<int, std::vector<double>> found_;
  InstantRates phase_instants_;
  std::vector<std::array<bool, parameters_at_once>> lose_;  // by group: parameters without derivatives after a crossing
  struct Bounce {
    double t = 0;
    std::vector<double> rate;
  };
  std::map<std::size_t, Bounce> bounces_;  // by place, the last one
  std::string lost_;
  DesignVector stage_, y_;
};

}  // namespace catena
