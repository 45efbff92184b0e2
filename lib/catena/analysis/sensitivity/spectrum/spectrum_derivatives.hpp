// Derivatives of frequencies and of critical loads.
//
//   frequency       K v + Phi_q^T mu = omega2 M v, Phi_q v = 0, v^T M v = 1
//                   d omega2 = v^T (K_p - omega2 M_p) v + 2 mu^T (Phi_q)_p v
//                   of unsymmetric K, with the vector on its left too, as loads: circulatory_derivatives.cpp; of
//                   pairs that flutter, complex: flutter_derivatives.cpp
//   buckling load   K(P) v + Phi_q^T mu = 0:    dP = -(v^T K_p v + 2 mu^T (Phi_q)_p v) / (the same by P)
//   flutter load    two omega2 of unsymmetric K meet in one: dP of the load of divergence, K less omega2 M in place of
//   K limit load      F(q, lambda, P) = 0 with the left null vector w of its matrix:   dP = -(w^T F_p) / (w^T F_P)
//
// K_p is taken along q_p and lambda_p. v^T K v is the second derivative of V + lambda^T Phi along v: one evaluation as
// a series in dual numbers has all of it. Refused: double frequencies and loads, whose vectors turn into each other;
// branch points, where w^T F_P vanishes. Source: apps/manual/sensitivity.md; R. Nelson, AIAA J. 14 (1976), for simple
// vectors.
#pragma once

#include <complex>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/sensitivity/static_derivatives.hpp"

namespace catena {

/// An equilibrium, or a place that is none, with multipliers of the solver's rows; spans as in Snapshot.
struct StaticPlace {
  double t = 0;
  std::span<const double> q, lambda;
};

/// The metric (1, 1, radius^2) by coordinate; zero of bodies that do not move.
std::vector<double> length_metric(const Evaluator& evaluator);

/// Multipliers that balance the forces at a place best, in the metric (1, 1, radius^2), size rows; nothing where its
/// constraints are singular.
std::optional<std::vector<double>> balancing_multipliers(Evaluator& evaluator, double t, std::span<const double> q);

namespace inverse_iteration {
/// Of vectors of an omega2: the matrix is factored this part of it beside it, where it is regular, and every round
/// leaves of other omega2, at least 1e-6 away, a tenth of what a vector has of them; of a load this part of the largest
/// stiffness. They are thresholds::solved where they change by no more than the last.
inline constexpr double beside = 1e-7;
inline constexpr int most_rounds = 20;
}  // namespace inverse_iteration

class SpectrumDerivatives final : public StateDerivatives {
 public:
  /// `from_model`: a place that is no equilibrium follows from what the model gives; else it is where an earlier
  /// analysis ended, and constraints alone move it.
  SpectrumDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters, bool from_model);

  /// Takes the place's derivatives: those of the equilibrium that it is, or of assembly where forces are not in
  /// balance.
  bool find(const Snapshot& snapshot) override;
  /// Takes those of a place at which another load acts than the one that it is the equilibrium of: its configuration
  /// moves as `equilibrium` found it, but not with the last parameter, the load.
  bool find_held(const Snapshot& snapshot, const StateDerivatives& equilibrium);
  /// v^T (K - omega2 M) v + 2 mu^T Phi_q v by every parameter, v and mu fixed, at the place of the last find: the
  /// derivatives of omega2 of the mode `shape` (over columns, v^T M v = 1); of stiffness alone with omega2 = 0.
  /// Nothing, and why() says it, where they cannot be had.
  std::optional<std::vector<double>> gradient(double omega2, std::span<const double> shape);
  /// What vectors on the left are found with: the masses of a frequency, the metric (1, 1, radius^2) of a load.
  enum class Metric { masses, lengths };
  /// The same of a real omega2 where forces have no energy, and by `lengths`, with omega2 = 0, of a load of
  /// divergence: circulatory_derivatives.cpp.
  std::optional<std::vector<double>> gradient_without_energy(double omega2, std::span<const double> shape,
                                                             Metric metric = Metric::masses);
  /// The same of one complex omega2 of a pair that flutters, omega2 + i imaginary: flutter_derivatives.cpp.
  std::optional<std::vector<std::complex<double>>> gradient_of_pair(std::complex<double> omega2,
                                                                    std::span<const double> shape);
  /// h_p by every parameter, the last one the load, where two omega2 meet in this one: circulatory_derivatives.cpp.
  /// `shape`: about that of their vector.
  std::optional<std::vector<double>> gradient_of_meeting(double omega2, std::span<const double> shape);

 private:
  /// Vectors on both sides, over coordinates, with the multipliers that hold them.
  struct TwoVectors {
    std::span<const double> v, mu, w, nu;
  };
  bool is_in_balance();
  bool find_as_equilibrium(const Snapshot& snapshot);
  /// [Phi_q^T lambda - Q] and Phi at the group's q and lambda.
  void fill_residual(Group& group, double t);
  /// Multipliers of all groups at the evaluator's configuration, or of one, with the metric factored there.
  bool find_multipliers(double t);
  bool find_multipliers(Group& group, double t);
  /// mu with K v + Phi_q^T mu = omega2 M v.
  std::optional<std::vector<double>> holding_multipliers(double omega2, std::span<const double> v);
  /// w and nu with K^T w + Phi_q^T nu = omega2 M w.
  bool find_left(double omega2, Metric metric, std::span<const double> v, std::span<double> w, std::span<double> nu);
  /// v, w and nu of the least singular value of K - omega2 M on the null space of Phi_q.
  bool find_both(double omega2, std::span<double> v, std::span<double> w, std::span<double> nu);
  bool factorize_beside(SaddleSystem& system, double shift, std::span<const double> weight, bool transpose);
  /// False, and why() says it, where a force shows no slopes.
  bool knows_slopes();
  /// The sum of a group by parameter, over `scale`.
  std::vector<double> slopes_of(const TwoVectors& of, double omega2, double scale);
  std::vector<double> weights_of(Metric metric);
  DesignScalar left_and_right(Group& group, const TwoVectors& of, double omega2);

  bool from_model_;
  SaddleSystem metric_;
  std::vector<double> lambda_, rest_, values_;
};

/// dP/dp of a limit load at its place, `models` with P as their last parameter; nothing, and why, at a branch point.
std::optional<std::vector<double>> limit_load_gradient(const Evaluator& evaluator, const DesignModels& models,
                                                       int parameters, const StaticPlace& place, std::string& why);

}  // namespace catena
