// The search for the lowest eigenvalues of K v = omega^2 M v: choice of the shift and the number of vectors, and the
// proof that none is missing.
//
//   nothing unstable        sigma a little below zero; the largest theta = 1 / (omega^2 - sigma) are the lowest omega^2
//   a few unstable modes    the same sigma; the unstable ones are the negative theta
//   more than are wanted    sigma just below the lowest omega^2, found by bisection with the inertia
//
// With motions that nothing resists the lowest omega^2 is accurate to about 1e-16 (|sigma| / |omega^2| + omega^2 /
// |sigma|): where the first sigma turns out far from the lowest omega^2 that is not zero, one nearer to it is taken.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "catena/analysis/spectrum/modes_dense.hpp"
#include "catena/analysis/spectrum/modes_operator.hpp"
#include "catena/base/status.hpp"

namespace catena {

class ModeSearch {
 public:
  /// `lambda`: multipliers at the system's configuration; `mass`: per column; `floor`: stiffnesses below it count as
  /// zero.
  ModeSearch(StaticSystem& system, std::span<const double> lambda, std::vector<double> mass,
             const StiffnessFloor& floor, const std::function<bool()>& go_on);

  /// The `count` lowest modes, ascending; fewer if there are no more.
  Report find(int count, std::vector<Mode>& modes);
  /// How many omega^2 lie below zero in all; those that cannot be distinguished from zero do not count.
  int unstable() const { return unstable_; }

 private:
  /// Around `sigma`, which moves; `complete`: there are no more modes than those.
  Report find_most(int count, double& sigma, bool& complete, std::vector<Mode>& modes);
  Report find_missing(int count, double sigma, std::vector<Mode>& modes);
  Report no_factors() const;
  Report cancelled() const;
  /// Factors at `sigma`, moved down by `margin` where it is an eigenvalue.
  bool factorize(double& sigma, double margin);
  double lowest_shift(double upper);
  std::vector<Mode> modes_of(Lanczos& lanczos, double sigma, int count) const;
  void refine_values(std::vector<Mode>& modes, double sigma);
  double better_shift(const std::vector<Mode>& modes, double sigma) const;
  bool is_cancelled() const { return go_on_ && !go_on_(); }

  StaticSystem& system_;
  std::span<const double> lambda_;
  std::vector<double> mass_;
  const StiffnessFloor& floor_;
  const std::function<bool()>& go_on_;
  ModeOperator op_;
  double size_ = 0;  // estimate of the largest omega^2
  int unstable_ = 0;
};

}  // namespace catena
