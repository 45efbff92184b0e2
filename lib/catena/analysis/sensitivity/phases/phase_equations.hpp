// Accelerations, projections and jumps of velocities of one phase of a motion with contacts, with derivatives.
//
// One plan has the equations of all contacts and slides; those that do not hold in a phase are left out. A place that
// presses by a force has a known multiplier of its equation, -N, and one that slides has one that follows from others:
//
//   [ M      Phi_q^T ] [ qdd    ]   [ Q     ]
//   [ Phi_q  0       ] [ lambda ] = [ gamma ]      lambda_slide = -f,   f + mu sigma N(lambda) = 0
//
// The sizes f of friction forces follow from as many equations (contact_loads.hpp), lambda being linear in them; their
// derivatives from the same matrix with the residual's. A jump of velocities is of the same form:
//
//   M (qd+ - qd-) + Phi_q^T p = F,   Phi_q qd+ = nu,   w+ = -e w-,   p_slide = -f,   f + mu s N(p) = 0
//
// and its derivatives run along an instant that moves: those of positions include qd- t*_p, those of nu nu_t t*_p.
// Singular where friction wedges (Painleve), where constraints are. Sources: as contact_loads.hpp, contact_switch.hpp;
// apps/manual/sensitivity.md.
#pragma once

#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/sensitivity/design_steps.hpp"
#include "catena/analysis/sensitivity/motion_crossing.hpp"
#include "catena/analysis/sensitivity/phases/place_law.hpp"
#include "catena/analysis/sensitivity/saddle_system.hpp"
#include "catena/columns/design_state.hpp"

namespace catena {

// A row that holds from now on is met along the parameters to this part of what places move by, and places that close
// at once do so to this part: of bounces that accumulate those below rest_speed, 1e-4 of the speed, are left out, and
// what comes to rest together does so to that part. What meets by chance misses by all of it.
inline constexpr double same_place = 1e-4;

class PhaseEquations {
 public:
  /// A mechanism with derivatives by some parameters, and its places.
  struct Design {
    DesignMechanism& mechanism;
    const std::vector<DesignPlace>& places;
    std::size_t count;  ///< of parameters
  };

  /// `evaluator`: of the plan with all equations. Both must outlive this object.
  PhaseEquations(Evaluator& evaluator, const ContactModel& contacts);

  /// These elements have no equations from now on, and places do this.
  void hold(const std::vector<int>& released, std::vector<ContactState> states);
  /// What place k does now, by these numbers of it, and what its forces follow from, at the mechanism's state.
  PlaceLaw law(const DesignPlace& place, std::size_t k) const;
  PlaceMotion motion(const DesignMechanism& mechanism, std::size_t k) const;
  /// The same of what its forces ask for alone: where nothing is asked the mechanism may be anywhere.
  PlaceMotion motion_of_forces(const DesignMechanism& mechanism, const PlaceLaw& law) const;
  /// How fast what ends a phase changes, where the state shows it; nothing where it follows from forces. `speed`: the
  /// fastest of the motion (contact_loads.hpp).
  struct EndRate {
    std::optional<double> rate;
    std::string trouble;  ///< why the instant has no derivative, as a sentence without full stop; empty: it may have
  };
  EndRate rate_of_end(const DesignMechanism& mechanism, const DesignPlace& place, const WatchedPlace& watched,
                      double speed) const;
  /// Whether exact friction sticks at a place.
  bool sticks(std::size_t place) const;
  /// Rows of mechanisms in which joints share friction that is not unique (same_slides.hpp): how has no derivative.
  /// Empty where none do.
  std::span<const char> shared_rows() const { return shared_; }
  bool shares_row(int row) const { return !shared_.empty() && shared_[static_cast<std::size_t>(row)] != 0; }
  /// The row of a place's gap, of its slide; -1: none.
  int gap_row(std::size_t place) const;
  int slide_row(std::size_t place) const;

  /// Factors for the equations that hold, at this place.
  bool factorize(double t, Side side, std::span<const DesignScalar> q, const DesignMechanism& masses);
  /// qdd and lambda with derivatives at q, qd, where the evaluator is factored; the mechanism is at the time of the
  /// factors, and at this state then. Values come in plain numbers; without parameters they are all that is found, and
  /// the mechanism's state is not defined.
  bool accelerate(const Design& design, std::span<const DesignScalar> q, std::span<const DesignScalar> qd,
                  std::span<DesignScalar> qdd, std::span<DesignScalar> lambda);
  /// What contacts do at the state of the last accelerate().
  void contacts(const Design& design, std::span<const DesignScalar> lambda, DesignContacts& out) const;
  DesignScalar pressing(const Design& design, std::size_t k, std::span<const DesignScalar> lambda) const;
  /// What presses place k, with derivatives, from multipliers; the mechanism is at the state.
  DesignScalar normal(const Design& design, std::size_t k, std::span<const DesignScalar> lambda) const;
  /// Moves derivatives of positions and velocities onto the constraints, least in the metric of the masses. `anchor`:
  /// of each row, how what it keeps moves with the parameters.
  bool project(const Design& design, std::span<const DesignScalar> anchor, std::span<DesignScalar> q,
               std::span<DesignScalar> qd);
  /// A row that holds, but not whatever parameter p is, by rows at q and qd with derivatives; -1: all do. `anchor`: as
  /// project(); `none`: what a derivative of a place may be though it is none; `except`: rows that are met in any case.
  int row_not_met(std::span<const Taylor<DesignScalar>> rows, std::span<const DesignScalar> anchor,
                  std::span<const DesignScalar> q, std::span<const DesignScalar> qd, std::size_t p, double none,
                  const std::vector<char>& except) const;
  /// qd- to qd+ by one step of a jump, whose equations are held and factored. `target`: what rates of rows become.
  /// `instant`: dt/dp.
  bool jump(const Design& design, const VelocityJump& jump, const DesignStrike* strike,
            std::span<const DesignScalar> target, std::span<const double> instant, std::span<const DesignScalar> q,
            std::span<DesignScalar> qd);
  /// Impulses of the last jump(), by row.
  const DesignVector& impulse() const { return impulse_; }
  /// With the factors, in place: f over coordinates, b over the rows that hold; of the others b is zero then.
  bool solve(std::span<double> f, std::span<double> b) { return system_->solve(f, b); }
  /// Phi_q of the factors, size entries of its pattern.
  std::span<const double> jacobian() const { return std::span(jacobian_).first(jacobian_.size() - 1); }
  const std::vector<int>& dependent_rows() const { return system_->dependent_rows(); }
  const Plan& plan() const { return evaluator_.plan(); }
  Evaluator& evaluator() { return evaluator_; }

 private:
  /// A friction force that depends on multipliers: f = -factor N.
  struct Coupled {
    std::size_t place;
    int slide_row;
    DesignScalar factor;  // mu sigma
  };
  struct Response {
    std::vector<double> x, lambda;
  };
  double normal_value(const Design& design, std::size_t k, std::span<const double> lambda,
                      std::span<const double> along, double& slope) const;
  std::vector<Coupled> find_known(const Design& design, std::span<const DesignScalar> q,
                                  std::span<const DesignScalar> qd, std::span<DesignScalar> lambda) const;
  void find_sides(std::span<const DesignScalar> qd, std::span<const DesignScalar> lambda);
  void add_loads(std::span<const double> lambda, std::span<double> f);
  bool respond(std::span<const Coupled> coupled);
  void find_shared_rows();
  bool solve_values(const Design& design, std::span<const Coupled> coupled);
  void add_slopes(const Design& design, std::span<const Coupled> coupled, std::span<DesignScalar> x,
                  std::span<DesignScalar> lambda);
  void find_slope(const Design& design, std::span<const Coupled> coupled, std::span<const double> lambda);

  Evaluator& evaluator_;
  const ContactModel& contacts_;
  std::vector<ContactState> states_;
  std::vector<char> held_;                            // by row
  std::vector<char> shared_;                          // by row; see shared_rows()
  std::map<std::vector<int>, SaddleSystem> systems_;  // by the rows that are left out
  SaddleSystem* system_ = nullptr;
  std::vector<double> jacobian_, values_, columns_, f_, b_;
  std::vector<double> sizes_, slope_;  // of friction forces; d(f + mu sigma N)/df, row by row
  std::vector<Response> response_;
  std::vector<Taylor<DesignScalar>> rows_;
  DesignVector loads_, impulse_;
};

}  // namespace catena
