// A configuration at which the constraint Jacobian loses rank: what is known of it, and how messages describe it.
//
//   w_i^T Phi_q = 0,  Phi_q z_j = 0:   w_i the combinations of rows that vanish, z_j the motions that become possible
//
// In columns and rows z and w are in m and rad; bodies and drivers are named by their part in them, lengths measured in
// length scales. Kinds and their conditions: branches.hpp for motions that come to such a place or start
// there, dead_point.hpp for places that no velocity leaves.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "catena/analysis/pose/jacobian_rank.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/status.hpp"

namespace catena {

struct SingularPoint {
  enum class Kind {
    branch_point,  ///< branches with different velocities meet
    tangency,      ///< branches touch with the same velocity, or second derivatives show only one branch
    rest,          ///< the drivers rest there, and the motion goes through or turns back
    isolated,      ///< no velocity continues the motion from here
    lock_up,       ///< the drivers ask for a motion that is not possible
  };
  Kind kind = Kind::branch_point;
  double t = 0;
  int nullity = 1;                            ///< of the driven Jacobian
  std::vector<double> q;                      ///< the configuration, plan order
  std::vector<std::vector<double>> tangents;  ///< velocities of the branches, plan order; the first one goes on as
                                              ///< before. Drivers at rest: for a speed of 1 of the fastest driver
  std::vector<std::string> branches;          ///< the same in words: which bodies move how
  std::vector<std::string> bodies;            ///< those that take part in the null vectors, the most mobile first
  int driver = -1;                            ///< the one concerned: whose row weighs most, else the first; -1: none
  double driver_value = 0;                    ///< its value there, m or rad
  /// Whether positions near this one are reached only by moving the drivers: no null vector can be followed.
  bool held_to_second_order = false;
  /// Of a lock-up: the place that drivers ask for lies at infinity; q is one on the way there, and the first of
  /// `bodies` the one that runs away.
  bool at_infinity = false;

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
  /// The status `lock_up`, in the words that every analysis has for it.
  Report report_lock_up(const Model& model) const;
};

/// Phi_q at a singular configuration and its null spaces.
struct NullSpaces {
  RankReport rank;
  std::vector<double> values;
  std::vector<std::vector<double>> z;  // right null vectors by coordinate, largest entry (rad, length scales) one
};

/// At q and the evaluator's time; `threshold`: length below which rows count as dependent, see RankOptions.
NullSpaces find_null_spaces(Evaluator& evaluator, std::span<const double> q, double threshold);

/// A combination of rows that vanishes, and its part of b: |w^T b| / (|w| |b|) as in disagreement().
struct Opposed {
  std::vector<double> w;
  double part = 0;
};

/// Of the left null vectors the one that b disagrees with most.
Opposed most_opposed(const Evaluator& evaluator, const RankReport& rank, std::span<const double> b);

/// Bodies ordered by `share`, those with less than a thousandth of the largest left out.
std::vector<int> most_concerned(std::span<const double> share, std::size_t most);

/// |w^T b| / (|w| |b|) in length scales and rad. Where equations depend on each other, w^T Phi_q = 0, it tells whether
/// they agree: b = nu for velocities, gamma for accelerations. 0 where b vanishes.
double disagreement(const Evaluator& evaluator, std::span<const double> w, std::span<const double> b);
/// A disagreement() above this is not rounding: configurations, and hence their null vectors, are known to some 1e-7.
inline constexpr double clear_disagreement = thresholds::same_value;
/// w^T b below this part of its terms, or of |w| |b|, vanishes where w is known to a tenth of that alone, as at places
/// beside the singular one.
inline constexpr double vanishing_part = 1e-2;

}  // namespace catena
