// All eigenvalues of K v = omega^2 M v on the null space of Phi_q by dense algebra, group by group.
//
//   Z^T K Z y = omega^2 y,   v = Z y,   Z^T M Z = I        Z as in motion_groups.hpp, with the masses as its metric
//
// The standard symmetric problem in mass-weighted coordinates: complete by construction, equal eigenvalues as often as
// they are there, each to rounding of its group's largest. Coordinates without mass first get a substitute metric;
// singular where a motion of them moves no mass at all. Values are Rayleigh quotients of the shapes with the sparse K,
// wrong by the square of the shapes' errors only; one that cannot be distinguished from rounding (StiffnessFloor) is 0.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include "catena/analysis/spectrum/motion_groups.hpp"

namespace catena {

struct Mode {
  double omega2 = 0;
  std::vector<double> shape;  ///< over columns, v^T M v = 1
  double error = 0;           ///< of omega2, by rounding: see ModesReport
};
/// A stiffness k g g^T beside K: of compliant contacts, whose bodies K may not tie together. N/m or N m; g over
/// columns.
struct AddedSpring {
  double k = 0;
  std::vector<double> g;
};
inline bool lower(const Mode& a, const Mode& b) { return a.omega2 < b.omega2; }

class DenseModes {
 public:
  /// The matrix must hold K; `mass`: per column. `go_on`: called between decompositions; false cancels. With `added`
  /// ones all must be one group.
  DenseModes(StaticSystem& system, MotionGroups& groups, std::span<const double> mass,
             const std::function<bool()>& go_on = {}, std::span<const AddedSpring> added = {});

  /// Then there are no results.
  bool cancelled() const { return cancelled_; }

  /// A column of the motion that moves no mass, if there is one: then there are no other results.
  std::optional<int> massless_column() const { return massless_; }
  /// False where the iteration of the dense solver did not end: with numbers that are not finite.
  bool ok() const { return ok_; }
  /// The `count` lowest modes, and all that are zero or negative, ascending.
  std::vector<Mode> lowest(int count, const StiffnessFloor& floor) const;

 private:
  struct Found {
    double value = 0;
    int group = 0, place = 0;
  };
  void solve(MotionGroup& group, int number, const std::function<bool()>& go_on);

  StaticSystem& system_;
  MotionGroups& groups_;
  std::span<const AddedSpring> added_;
  std::vector<Found> found_;  // ascending
  std::vector<double> reduced_;
  std::optional<int> massless_;
  bool ok_ = true, cancelled_ = false;
};

}  // namespace catena
