// The motions that constraints allow, as dense bases of the null space of Phi_q, group by group.
//
//   Phi_q Z = 0,   Z^T W Z = I,   W = diag(weight) > 0        any allowed motion: v = Z y
//
// A group holds the coordinates that entries of K and Phi_q tie together. Groups are treated separately: a large
// stiffness in one costs no digits in another, and many small problems are cheaper than a large one. The rank is that
// of the analysis of mobility (jacobian_rank.hpp), judged in length scales; only then an independent set of rows is
// orthogonalised in the metric W (Householder), so that masses over many orders of magnitude do not affect the rank.
// Units: those of the coordinates, m and rad. Source: G. Golub, C. Van Loan, Matrix Computations, 4th ed., 5.2 and 8.7.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"

namespace catena {

struct MotionGroup {
  std::vector<int> columns;   ///< of Phi_q, ascending
  std::vector<int> rows;      ///< independent ones, ascending
  std::vector<double> basis;  ///< Z, columns.size() x freedoms(), one column after the other

  int freedoms() const { return static_cast<int>(columns.size() - rows.size()); }
};

class MotionGroups {
 public:
  /// At the system's configuration. `split`: groups by what is not zero in K as the matrix holds it now; else one group
  /// of everything, for stiffnesses that will change.
  MotionGroups(StaticSystem& system, bool split);

  /// Whether dense algebra is affordable for all of them: a second or so at the limits.
  bool are_small(int most_freedoms = usual_freedoms) const;
  int freedoms() const;
  /// Fills the bases. `go_on`: called between decompositions; where it gives false so does this, and bases are missing.
  bool orthonormalise(std::span<const double> weight, const std::function<bool()>& go_on = {});

  std::vector<MotionGroup>& groups() { return groups_; }
  const std::vector<MotionGroup>& groups() const { return groups_; }

  /// See are_small().
  static constexpr int usual_freedoms = 500;

 private:
  StaticSystem& system_;
  std::vector<MotionGroup> groups_;
};

/// Z^T K Z of a group, freedoms() x freedoms(), with the K that the matrix holds.
void reduce_stiffness(const KktMatrix& matrix, const MotionGroup& group, std::vector<double>& reduced);

/// Per body of the plan, m: the distance from its origin at which constraints and forces act on it, the scene's length
/// where all act at the origin. It makes turning and travel comparable in any units.
std::vector<double> body_arms(StaticSystem& system, std::span<const double> lambda);
/// The metric W in which turning over these arms and travel count alike, over columns: 1, or the arm's square, m^2.
std::vector<double> metric_of_arms(StaticSystem& system, std::span<const double> lambda);

/// The part of v^T K v that cannot be distinguished from zero, N m (v over columns): the rounding of all stiffnesses
/// that act on the bodies that move, before they cancel; that of places far from the origin; that of the stiffest body
/// to which they are tied; and the effect of the force that was left unbalanced.
class StiffnessFloor {
 public:
  /// `residual`, N: the unbalanced force; without `groups` no body is tied to another.
  StiffnessFloor(StaticSystem& system, std::span<const double> lambda, double residual,
                 const MotionGroups* groups = nullptr);
  double operator()(std::span<const double> v) const;
  /// The same for u^T K v.
  double between(std::span<const double> u, std::span<const double> v) const;

 private:
  std::vector<double> floor_;  // per column
};

}  // namespace catena
