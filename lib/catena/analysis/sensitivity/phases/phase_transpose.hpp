// The equations of a phase of a motion with contacts (phase_equations.hpp), transposed: what adjoints ask of them.
//
//   M qdd + Phi_q^T lambda = Q       Phi_h'' = 0       lambda_c - L_c(g, g', w', lambda) = 0
//
// h: rows that hold; c: rows whose multipliers are known, of places that press by a force or slide (place_law.hpp).
// ^ marks derivatives of a measure. Of the accelerations and multipliers of a state:
//
//   [ M      Phi_h^T ] [ w  ]   [ qdd^                     ]       nu = lambda_c^ - Phi_c w
//   [ Phi_h  0       ] [ mu ] = [ lambda_h^ + L_lambda^T nu ]
//   y^ += w^T (Q - M qdd - Phi_q^T lambda)_y - mu^T Phi_h''_y + nu^T L_y        y = [q, qd], or the parameters
//
// As many equations for nu follow as places slide whose friction depends on multipliers. Of a jump of velocities,
// M (qd+ - qd-) + Phi_q^T p = F with F a blow, the same follows with qd+^ in place of qdd^ and p_c = mu s N(p); rows of
// places that come back are Psi'+ + e Psi'- = 0, so that
//
//   qd-^ = M w - sum mu_r e Psi_r,q        e^ = -mu_r Psi'-_r
//
// Singular where phase_equations.hpp is. Units of those. Source: apps/manual/sensitivity.md.
#pragma once

#include <array>

#include "catena/analysis/sensitivity/phases/phase_equations.hpp"
#include "catena/assembly/design/adjoint_mechanism.hpp"

namespace catena {

/// A group of parameters.
struct PhaseGroup {
  DesignMechanism& mechanism;
  const std::vector<DesignPlace>& places;
  const AdjointMechanism::Reached& reached;
};

class PhaseTranspose {
 public:
  using Vector = std::vector<double>;
  using ByParameter = std::array<double, parameters_at_once>;
  /// A state with its accelerations and multipliers.
  struct Point {
    double t = 0;
    Side side = Side::after;
    Vector q{}, qd{}, qdd{}, lambda{};
  };

  /// `plain`: any mechanism of the design, whose derivatives are left aside, as those of `places` are. All must outlive
  /// this object.
  PhaseTranspose(PhaseEquations& equations, AdjointMechanism& adjoint, DesignMechanism& plain,
                 const std::vector<DesignPlace>& places);

  /// Factors at the point, and what follows there from q and qd; false where they are singular, friction wedges or
  /// constraints depend on each other.
  bool evaluate(Point& point);
  /// The same where all but the factors is known.
  bool restore(const Point& point) { return factorize(point) && find_terms(point); }
  /// The factors alone.
  bool factorize(const Point& point);

  /// w, mu and nu at the point of the last evaluate(); empty: zero.
  bool weigh(std::span<const double> by_qdd, std::span<const double> by_lambda);
  /// y^ += ... of the last weigh().
  void add_by_state(const Point& point, std::span<double> by_q, std::span<double> by_qd);
  /// The same by the parameters of a group, after add_by_state().
  ByParameter by_parameters(const Point& point, const PhaseGroup& group);

  /// [q, qd]^ back through the projection at a point, after factorize(); `anchor` += what kept values of rows weigh,
  /// `parameters` the weights of rows by their values and by their rates, for rows_by_parameters().
  bool project_back(const Point& point, std::span<double> q, std::span<double> qd, std::span<double> anchor,
                    std::span<Vector, 2> parameters);
  /// What rows weigh by their values and rates, by the parameters of a group, at the point of project_back().
  ByParameter rows_by_parameters(const Point& point, std::span<const double> values, std::span<const double> rates,
                                 const PhaseGroup& group);
  /// out += Phi_q^T rows.
  void add_rows(std::span<const double> rows, std::span<double> out) const;

  /// What is zero where a phase ends, at the point of the last evaluate(): value, by parameters of a group, and what it
  /// changes by with the state and the multipliers, times a weight.
  double end_value(const Point& point, const WatchedPlace& watched);
  PhaseEquations::EndRate rate_of_end(const Point& point, const WatchedPlace& watched);
  DesignScalar end_value(const Point& point, const WatchedPlace& watched, const PhaseGroup& group);
  void add_end(const Point& point, const WatchedPlace& watched, double weight, std::span<double> by_q,
               std::span<double> by_qd, std::span<double> by_lambda);

  /// One step of a jump of velocities, whose equations are held.
  struct Jump {
    const VelocityJump* jump = nullptr;
    const std::vector<DesignStrike>* strikes = nullptr;  ///< by group; nullptr: no blow
    Point before{}, after{};  ///< of the latter, impulses for multipliers and qd+ - qd- for accelerations
  };
  /// `after` from `before`.
  bool jump(Jump& jump);
  /// qd+^ in by_qd becomes qd-^; `instant` += what the instant weighs. After jump().
  bool jump_back(const Jump& jump, std::span<double> by_q, std::span<double> by_qd, double& instant);
  ByParameter jump_by_parameters(const Jump& jump, const PhaseGroup& group, std::size_t number);

 private:
  /// What a function of a place changes by.
  struct Partials {
    double gap = 0, gap_rate = 0, slip = 0;
    std::array<double, 3> lambda{};
  };
  using Rows = std::array<int, 3>;  // -1: none
  /// A row whose multiplier is known.
  struct Term {
    int row;
    std::size_t place;
    bool is_slide;
    int direction;  // of an impact's slip; 0: no impact
    PlaceMotion motion{};
    Partials by{};
    Rows lambda_rows{-1, -1, -1};
    double nu = 0;
    Vector w{}, mu{}, along{};  // of a unit of nu, where the row depends on multipliers; along: Phi_q w
    bool is_coupled() const { return !w.empty(); }
  };
  bool find_terms(const Point& point);
  bool find_terms(const Jump& jump);
  bool complete(Term& term);
  DesignScalar known(const Term& term, const DesignPlace& place, const PlaceMotion& motion) const;
  template <class F>
  Partials partials(const PlaceMotion& motion, const Rows& rows, F&& f);
  Rows normal_rows(std::size_t place) const;
  PlaceMotion motion_at(const Point& point, std::size_t place);
  void set_state(DesignMechanism& mechanism, const Point& point);
  void take_multipliers(const Point& point);
  void add_place(std::size_t place, const PlaceMotion& motion, const Partials& by, double weight);
  Vector rebound_rows(const Jump& jump) const;
  Vector rates_of_rows(const Vector& qd) const;
  bool solve(Vector& w, Vector& mu);
  const Plan& plan() const { return equations_.plan(); }

  PhaseEquations& equations_;
  AdjointMechanism& adjoint_;
  DesignMechanism& plain_;
  std::vector<DesignPlace> places_;  // without derivatives
  std::vector<Term> terms_;
  Vector w_, mu_, phi_, rate_, masses_, zero_rows_, zero_loads_;
  DesignVector q_, qd_, qdd_, lambda_;  // lambda_: multipliers that laws read
};

}  // namespace catena
