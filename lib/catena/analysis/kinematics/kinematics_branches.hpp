// Branches at a singular configuration: the velocities with which the mechanism may go on
// (apps/manual/kinematics.md#singular-configurations).
//
//   Phi_q qd = nu  has the solutions  qd = qd0 + sum_j a_j z_j,  z_j the right null vectors of Phi_q;
//   a motion goes on along qd only if  Phi_q qdd = gamma(q, qd)  can be solved as well:
//   w_i^T gamma(q, qd0 + sum_j a_j z_j) = 0  for all left null vectors w_i
//
// quadratic equations in a, one for one at a simple branch point: two real roots = two branches, a double root = they
// touch, none = the configuration is isolated. With more null vectors the real roots are searched for by Newton's
// method from many starts, up to a nullity of `most_nullity`; above it only the nullity and the bodies are reported.
// Where the drivers rest (nu = 0) all branches have the same velocity; they differ in the direction in which the
// mechanism moves once the drivers do. These directions follow from the same equations with the driver speeds of a
// moment later and without driver accelerations.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catena/assembly/evaluate.hpp"

namespace catena {

struct SingularPoint {
  enum class Kind {
    branch_point,  ///< branches with different velocities meet
    tangency,      ///< branches touch with the same velocity, or the configuration is regular again to second order
    rest,          ///< the drivers rest there, and the motion goes through or turns back
    isolated,      ///< no velocity continues the motion from here
    lock_up,       ///< the drivers ask for a motion that is not possible
  };
  Kind kind = Kind::branch_point;
  double t = 0;
  int nullity = 1;                            ///< of the driven Jacobian
  std::vector<double> q;                      ///< the configuration, plan order
  std::vector<std::vector<double>> tangents;  ///< velocities of the branches, plan order; the first one goes on as
                                              ///< before. At rest: for a fastest driver of speed 1
  std::vector<std::string> branches;          ///< the same in words: which bodies move how
  std::vector<std::string> bodies;            ///< those that take part in the null vectors, the most mobile first
  int driver = -1;                            ///< the one concerned: whose row weighs most, else the first; -1: none
  double driver_value = 0;                    ///< its value there, m or rad
  /// Whether positions near this one are reached only by moving the drivers: no null vector can be followed.
  bool held_to_second_order = false;

  /// Names the bodies that take part in motions, given by coordinate.
  void name_bodies(const Evaluator& evaluator, std::span<const std::vector<double>> motions);
  /// Finds the driver concerned, at the evaluator's time; `w`: weights of the equations in a vanishing combination.
  void find_driver(const Evaluator& evaluator, std::span<const double> w, std::span<const double> nu);
  /// Makes branch k, counted from zero, the first one.
  void put_first(std::size_t k);
  /// The name used in result files.
  std::string_view kind_name() const;
  /// "branch 1 (goes on as before): ...; branch 2: ..."
  std::string describe_branches() const;
  /// The same for drivers that rest: where the branches lead once they move.
  std::string describe_ways() const;
};

inline constexpr int most_nullity = 6;

/// |w^T b| / (|w| |b|) in length scales and rad. Where equations depend on each other, w^T Phi_q = 0, it tells whether
/// they agree: b = nu for velocities, gamma for accelerations. 0 where b vanishes.
double disagreement(const Evaluator& evaluator, std::span<const double> w, std::span<const double> b);
/// A value above this one is not rounding: configurations, and hence their null vectors, are given to some 1e-7.
inline constexpr double clear_disagreement = 1e-6;

enum class Drivers {
  moving,         ///< at the evaluator's time as in the motion
  about_to_move,  ///< they rest, and the evaluator's time is a moment later: tangents for a fastest driver of speed 1
};

/// The branches at the evaluator's time and the singular configuration q. `along`: the velocity of the motion on
/// arrival, empty if it starts here. `threshold`: length below which equations count as dependent, see RankOptions.
SingularPoint find_branches(Evaluator& evaluator, std::span<const double> q, std::span<const double> along,
                            double threshold, Drivers drivers = Drivers::moving);

}  // namespace catena
