// Which contacts press, stick and slide: the complementarity problem of impulses or forces at several places at once.
//
//   w = b + D x                               two entries a place: across the contact, and along it
//   x_n >= 0,  w_n >= 0,  x_n w_n = 0         an impact: w_n = v_n+ + e v_n-; forces: w_n = acceleration of the gap
//   sticks: w_t = 0, |x_t| <= mu_static x_n   slides: x_t = -mu s x_n, s = sign of w_t, or of the slip there is
//
// A rope's place presses with its tension T_0 at the end i; its grips (rope_grips.hpp) follow it, in order:
//
//   T_n = T_n-1 + x_t      sticks: w_t = 0, 1/g <= T_n / T_n-1 <= g      slides: T_n = T_n-1 g^-s
//
// The rope and its grips are solved for together: grips that may stick do at first, and the first one that cannot is
// changed until all can (Murty's least index).
//
// D = J M^-1 J^T on the constraints is symmetric and positive semidefinite. Places are solved one after the other, over
// and over, until nothing changes (nonlinear Gauss-Seidel); the states found are then solved for at once, so that the
// answer is exact to rounding however slow that was. Sweeps need not settle where places share a body, and cannot tell
// what several that stick hold together: up to six places are then searched for states that fit (contact_search.cpp),
// more are found by pivots (contact_pivots.cpp), which need no sweeps before. Several places of one body may be
// redundant: the least x is taken. Forces of different units are compared as x_r sqrt(D_rr), in which energy has one
// unit.
// Not solvable where friction wedges a place (D_nn <= mu |D_tn|): solve() is then false.
// Source: Stewart (2000), see contact_loads.hpp; Jean and Moreau, Unilaterality and dry friction (1992).
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include "catena/analysis/run/thresholds.hpp"

namespace catena {

class ContactProblem {
 public:
  struct Place {
    bool has_normal = true;  ///< false: what presses is known: it sticks up to `limit` and slides with `kinetic`
    bool has_friction = false;
    double mu = 0, mu_static = 0;
    double limit = 0, kinetic = 0;
    int slip = 0;       ///< sign of the slip there is already; 0: it may stick
    int head = -1;      ///< of a rope's grip: the rope's place, before it
    double growth = 1;  ///< of a rope's grip: g = e^E
  };
  /// Places of which all states are tried: four each, 4096 choices, some 20 us each.
  static constexpr std::size_t most_searched = 6;
  enum class State : unsigned char { open, slides, sticks };

  explicit ContactProblem(std::size_t places)
      : place(places),
        b(2 * places, 0.0),
        b_terms(2 * places, 0.0),
        x(2 * places, 0.0),
        state(places, State::open),
        direction(places, 0),
        d_(4 * places * places, 0.0),
        units_(2 * places, 0.0) {}

  /// Of D in the units of unit(), or of a response without constraints: what is left of none, 1e-16 times the condition
  /// of the constrained system that D is solved from.
  static constexpr double no_response = 1e-11;
  /// Of the terms of a sum: what is left of none. States that do not fit miss by parts of their loads.
  static constexpr double rounding_of_sums = 1e-9;

  double& D(std::size_t row, std::size_t column) { return d_[row * b.size() + column]; }
  double D(std::size_t row, std::size_t column) const { return d_[row * b.size() + column]; }

  /// Finds x and the states. False: there is no solution, or none that the iteration finds.
  bool solve();
  /// solve() tries `state` and `direction` as they are now first.
  void prefer_states() {
    preferred_state_ = state;
    preferred_direction_ = direction;
  }
  /// What solve() finds from now on has other states than `state` and `direction` are now.
  void rule_out_states() {
    ruled_out_state_ = state;
    ruled_out_direction_ = direction;
  }

  struct Sum {
    double value = 0, terms = 0;
  };
  /// w in a row, with the sizes of its terms together.
  Sum sum(std::size_t row) const;
  /// After solve(): of x in a row, at which it counts as one: 1 / sqrt(D_rr), of a grip that of its rope; 0 where
  /// nothing gives way.
  double unit(std::size_t row) const { return units_[row]; }
  /// Whether a row of D depends on others of it.
  bool depends(std::size_t row, const std::vector<std::size_t>& others) const;
  /// x that goes with the present states, whatever its limits; what slides under a known force keeps its own.
  void solve_states();
  /// Whether x goes with the present states, and what sticks holds no more than it can; of what presses by itself
  /// nothing is asked.
  bool fits_states() const { return keeps_states() && keeps_limits(); }

  std::vector<Place> place;
  std::vector<double> b;
  std::vector<double> b_terms;  ///< sizes of the sums that b is made of, for its rounding; at least |b| is meant
  std::vector<double> x;        ///< impulses or forces
  std::vector<State> state;     ///< `slides` without friction: closed
  std::vector<int> direction;   ///< of the slip, where it slides with friction

 private:
  bool solve_place(std::size_t k);
  struct Unknown {
    std::size_t row;
    std::vector<std::pair<std::size_t, double>> parts;  // of x that one unit of it makes
  };
  bool solve_rope(std::size_t head);
  void add_sliding_grips(std::size_t from, std::vector<std::pair<std::size_t, double>>& parts) const;
  void solve_rope_states(std::size_t head);
  void solve_unknowns(const std::vector<Unknown>& unknowns, const std::vector<double>& known);
  std::vector<std::size_t> grips_of(std::size_t head) const;
  /// Tension before a grip.
  double tension_before(std::size_t grip) const;
  double misfit(std::size_t grip) const;
  void solve_along(std::size_t k, double w_t);
  /// w at place k, across (0) or along (1), but for the part of its own x.
  double without_own(std::size_t k, std::size_t along) const;
  void find_units();
  /// Of x, and of a change of x, without a unit.
  double size() const;
  double size_of(std::size_t row, double change) const;
  double rounding() const;
  bool is_wedged() const;
  /// Whether constraints and drivers move place k along whatever acts there, at the rate w_t.
  bool is_carried(std::size_t k, double w_t) const;
  bool sweep(double& size);
  bool close_redundant(double size);
  bool fits(double size) const;
  // contact_search.cpp
  bool sticks_together() const;
  bool search();
  bool try_states();
  bool keeps_states() const;
  bool keeps_limits() const;
  // contact_pivots.cpp
  class Pivots;
  /// Of a place: the slip that it has or is meant to have, whether it slipped where it could have stuck, whether it is
  /// meant to be open.
  struct Choice {
    int slip = 0;
    bool slipped = false, left_out = false;
  };
  bool is_many() const;
  bool pivot();
  bool pivot(std::vector<Choice> choices);
  void read_states(const std::vector<Choice>& choices);
  void refine();
  bool is_ruled_out() const;

  std::vector<double> d_, units_;
  std::vector<State> preferred_state_, ruled_out_state_;  // empty: none
  std::vector<int> preferred_direction_;
  std::vector<int> ruled_out_direction_;
  bool has_grips_ = false;
  double grip_change_ = 0;  // of x at grips, in a sweep, without a unit
};

}  // namespace catena
