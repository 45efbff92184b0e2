// The inverse of a shifted stiffness on the null space of Phi_q: the operator of Lanczos' method.
//
//   [ K - sigma M  Phi_q^T ] [ x  ]   [ M v ]
//   [ Phi_q          0     ] [ mu ] = [ 0   ]        v := x
//
// through the factorization of equilibrium, whose inertia tells how many omega^2 lie below sigma; every solution is
// refined with the true matrix, since the factored one is regularised. M = diag(m, m, J), kg, kg m^2; sigma 1/s^2.
#pragma once

#include <vector>

#include "catena/analysis/balance/static_system.hpp"
#include "catena/analysis/spectrum/modes_lanczos.hpp"

namespace catena {

class ModeOperator final : public SpectralOperator {
 public:
  /// `mass`: per column. The system must be at the configuration. Not `refined`: with the regularised factors alone.
  ModeOperator(StaticSystem& system, std::vector<double> mass, bool refined = true);

  /// Factors K - sigma M, K with these multipliers. False: a pivot vanished, sigma is an eigenvalue.
  bool factorize(std::span<const double> lambda, double sigma);
  /// How many omega^2 lie below the sigma of the last factorization.
  int below() const { return system_.matrix().negative_modes(); }

  int columns() const override { return static_cast<int>(mass_.size()); }
  std::span<const double> typical() const override { return typical_; }
  void metric(std::span<const double> v, std::span<double> Gv) override;
  void invert(std::span<double> v) override;
  void project(std::span<double> v) override;

 private:
  StaticSystem& system_;
  bool refined_;
  std::vector<double> mass_, typical_, weight_, given_, solution_, correction_;
};

/// Weights (1, 1, radius^2) of the columns.
std::vector<double> length_weights(const StaticSystem& system);

/// The component that determines the sign of a shape, which is arbitrary: the largest angle or, where nothing turns,
/// the largest displacement.
double decisive_component(const Plan& plan, std::span<const double> shape);

/// Solves with the factors of the system's matrix for the right-hand side `given` = [columns; rows] and refines with
/// the matrix itself until rounding ends the gain. `weight`: in which corrections are measured; `correction`: work.
/// Returns the last correction as a part of the solution.
double solve_to_rounding(StaticSystem& system, std::span<const double> weight, std::span<const double> given,
                         std::span<double> x, std::span<double> correction);

/// Brings v (columns) into the null space of Phi_q with the factors of the system's matrix. `x`: work, columns + rows.
void project_to_null_space(StaticSystem& system, std::span<double> v, std::span<double> x);

}  // namespace catena
