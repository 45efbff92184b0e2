// The one solver of constrained least changes and motions: metric W, compliance C.
//
//   [W, Phi_q^T; Phi_q, -C] [x; lambda] = [f; g]
//   S lambda = Phi_q W^-1 f - g        x = W^-1 (f - Phi_q^T lambda)        S = Phi_q W^-1 Phi_q^T + C
//
// In motion W is the mass matrix, x the accelerations, f forces, g = gamma. Without f the least change, in the metric
// W, that meets the constraints: x = W^-1 Phi_q^T S^-1 b; with C > 0 on the diagonal that of least x^T W x + (Phi_q x -
// b)^T C^-1 (Phi_q x - b), in which rows need not be met. W is diagonal, a weight of zero holds its coordinate, so that
// S is assembled column by column of Phi_q straight into the place where it is factored; products of constant columns
// are formed once. Vectors are in coordinates: three a moving body.
//
// Massless coordinates (M only positive definite where the constraints leave freedom) get a small mass s, and the
// solution is refined with the true M until the residual at them is rounding: with r the constrained mass, which
// resists a motion of the coordinate, each round leaves s / (s + r). s should be small beside r, but not smaller than
// needed: it costs log(r / s) digits of every solve. Residuals are measured as forces over the root of s, compared with
// the largest such force.
//
// Very unequal masses: the inverse of a light one dominates the others in S, and accelerations as M^-1 (Q - Phi_q^T
// lambda) are differences of large numbers. One round of refinement with the residuals of both equations restores the
// digits, as far as the masses determine them.
//
// Equations that always depend on others (redundant constraints) make S singular along the motion. For each dependence
// one direction c among the equations of one element is left out: no multiplier acts along it, and its equation is not
// solved: C = sum c c^T. With as many directions as dependences, none of them orthogonal to the null space of S, the
// matrix is regular, and on the constraints C lambda = 0 holds by itself: the solution is the exact one, with
// multipliers that have no part along c. Off the constraints by d, where integrators evaluate their stages, the
// solution changes by O(d) and smoothly. (Regularising S instead gives multipliers of O(1/d) there, and accelerations
// that are wrong by O(1).)
//
// Singular case: equations that depend on each other for an instant, or in a pose that is looked for. As soon as a
// pivot keeps less than 1e-10 of its diagonal, 1e-12 of the diagonal is added and solutions are refined with the true
// S: changes and accelerations are then exact on the constraints, multipliers one of many; of a contradictory b the
// part that can be met is met. Limits of dependence: linalg/rank/dependence.hpp. Nothing allocates after the first
// factorization. Source: apps/manual/numerics.md#regularisation.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "catena/assembly/plan.hpp"
#include "catena/base/counters.hpp"
#include "catena/linalg/block/block_factorization.hpp"
#include "catena/linalg/patterns/sparse_vectors.hpp"

namespace catena {

/// What solutions are found in; V: numbers, or several in lanes.
template <class V>
struct SchurScratch {
  std::vector<V> right_hand_side, correction, change;  // over rows, rows, coordinates
};
/// Of one right-hand side of several, where each is solved for by itself.
struct SchurAlone {
  std::vector<double> Q, gamma, qdd, lambda;
};
struct SchurLanes : SchurScratch<Lanes> {
  std::vector<Lanes> work;
  SchurAlone own;
};
struct SchurRows {
  std::vector<double> work;
  SchurAlone own;
};

class ConstraintSolver {
 public:
  explicit ConstraintSolver(std::shared_ptr<const Plan> plan);

  /// W: masses or other weights by coordinate, size 3 plan.moving, and substitutes for those that are zero; where both
  /// are zero, or there are no substitutes, the coordinate is held. Coordinates without a column do not matter.
  void set_metric(std::span<const double> masses, std::span<const double> substitutes = {});

  /// Directions c to leave out, each within the rows of one element and of the size of row_sizes() there; none: all
  /// rows are solved for. Takes effect with the next factorize().
  void leave_out(SparseVectors directions);
  const SparseVectors& left_out() const { return left_out_; }
  /// x = S^-1 x. On the constraints the solutions for all c span the left null space of Phi_q.
  void solve_rows(std::span<double> x, Counters& counters);
  /// The root of the diagonal of S without the directions left out, of the last factorize(), by row: the size of a unit
  /// multiplier in the metric.
  std::vector<double> row_sizes() const;

  /// Factors S at the given values of Phi_q (as many as it has entries, or more); they must stay where they are for the
  /// solves. False if that is impossible: a value that is not finite.
  bool factorize(std::span<const double> jacobian, Counters& counters);
  /// The same with a part `damping` > 0 of the diagonal on top, for steps that must stay short: refinement takes the
  /// most of it back where rows are independent.
  bool factorize_damped(std::span<const double> jacobian, double damping, Counters& counters);
  /// The same with `compliance` > 0, by row, on the diagonal of C; it must stay where it is for the solves.
  bool factorize_compliant(std::span<const double> jacobian, std::span<const double> compliance, Counters& counters);

  /// qdd and lambda from Q and gamma. Sizes: coordinates (Q, qdd), rows (gamma, lambda). `lambda` may be `gamma`.
  void solve_motion(std::span<const double> Q, std::span<const double> gamma, std::span<double> qdd,
                    std::span<double> lambda, Counters& counters);
  /// The same for four right-hand sides at once, rounded as one by one.
  void solve_motion(std::span<const Lanes> Q, std::span<const Lanes> gamma, std::span<Lanes> qdd,
                    std::span<Lanes> lambda, SchurLanes& scratch, Counters& counters);
  /// The same for `width` of them, a multiple of four, in rows (linalg/kernels/packs.hpp): x holds Q and then qdd, over
  /// coordinates, `rows` -gamma and then lambda. What is no unknown is overwritten.
  void solve_motion_rows(std::span<double> x, std::span<double> rows, std::size_t width, SchurRows& scratch,
                         Counters& counters);
  /// Part of M qdd - Q + Phi_q^T lambda that the last solve_motion() left at massless coordinates, relative to the
  /// forces in it; 0 without such coordinates. Near 1: nothing that has mass determines their motion.
  double massless_residual() const { return massless_residual_; }
  /// The coordinate where it was largest.
  int worst_massless() const { return worst_massless_; }
  /// s / (s + r) of every massless coordinate, in the order of their numbers, or a somewhat larger value: estimated by
  /// a few solves with random loads. Overwrites the results of solve_motion().
  std::vector<double> massless_shares(Counters& counters);

  /// The least x with Phi_q x + C lambda = b, refined until the residual is rounding, at most five times. Sizes: rows
  /// (b, lambda), coordinates (x).
  void solve(std::span<const double> b, std::span<double> x, std::span<double> lambda, Counters& counters);

  /// The same for steps that are repeated: refined once, and only where pivots are small.
  void least_change(std::span<const double> b, std::span<double> x, std::span<double> lambda, Counters& counters);

  /// The same without refinement: good to the last digits where rows are independent, to 1e-12 / sin^2 elsewhere.
  void least_change_rough(std::span<const double> b, std::span<double> x, std::span<double> lambda, Counters& counters);

  /// out += Phi_q x.
  void multiply_add(std::span<const double> x, std::span<double> out) const;

  /// Smallest part of a diagonal entry of S that elimination left: sin^2 of the angle between a row and those before.
  double smallest_pivot_ratio() const { return smallest_ratio_; }
  int weakest_row() const { return weakest_row_; }
  /// Diagonal entry of S that belongs to the row; 1 where none of its bodies can move.
  double diagonal(int row) const { return diagonal_values_[static_cast<std::size_t>(row)]; }
  /// The part of the row's diagonal entry of S that elimination left.
  double pivot(int row) const { return factors_.pivot(row); }
  bool is_regularised() const { return regularised_; }

 private:
  struct Column {
    int coordinate;
    int first, last;  // entries of Phi_q
  };
  bool begin(const double* jacobian, const double* compliance, Counters& counters);
  /// What is done once for a metric, and for all.
  bool prepare(Counters& counters);
  bool analyze(Counters& counters);
  bool analyze_factors(const SparsePattern& lower, Counters& counters);
  void assemble(std::span<const Column> columns, const int* slot, std::span<double> values) const;
  void place_left_out();
  /// S, its diagonal increased by a part of itself, to where it is factored.
  void fill(double regularised_part);
  bool factor_values(double regularised_part, Counters& counters);
  /// The same; false if a pivot vanishes.
  bool factor_once(double part, Counters& counters);
  // V: numbers, or several in lanes.
  void eliminate(std::span<double> x, SchurScratch<double>&, Counters& counters) { factors_.solve(x, counters); }
  void eliminate(std::span<Lanes> x, SchurLanes& scratch, Counters& counters) {
    factors_.solve(x, scratch.work, counters);
  }
  template <class V>
  void add_product(std::span<const V> x, std::span<V> out) const;
  /// out += C lambda.
  template <class V>
  void add_compliance(std::span<const V> lambda, std::span<V> out) const;
  /// x = W^-1 Phi_q^T lambda.
  template <class V>
  void spread(std::span<const V> lambda, std::span<V> x) const;
  /// r = b - S lambda with x = W^-1 Phi_q^T lambda.
  template <class V>
  void find_residual(std::span<const V> b, std::span<const V> lambda, std::span<V> x, std::span<V> r) const;
  template <class V, class S>
  void solve_refined(std::span<V> lambda, std::span<const V> b, S& scratch, Counters& counters);
  template <class V, class S>
  void solve_with_masses(std::span<const V> Q, std::span<const V> gamma, std::span<V> qdd, std::span<V> lambda,
                         S& scratch, Counters& counters);
  /// Whether a solution is refined as often as it needs, which each tells by itself.
  bool refines_each() const;
  void solve_each_of(std::span<double> x, std::span<double> rows, std::size_t width, SchurAlone& own,
                     Counters& counters);
  struct EliminationKernel;
  struct SpreadKernel;
  double find_massless_residual(std::span<const double> Q, std::span<const double> lambda);
  void refine_motion(std::span<const double> Q, std::span<const double> gamma, std::span<double> qdd,
                     std::span<double> lambda, Counters& counters);

  /// What coordinates weigh, by coordinate.
  struct Masses {
    std::vector<double> given, inverse;  // inverse: of the substitutes where masses are zero; 0: the coordinate is held
    std::vector<int> massless;           // coordinates that have a substitute
  };
  /// Where the products of the columns of Phi_q go in the factored matrix.
  struct Places {
    std::vector<Column> varying, constant;
    std::vector<int> varying_slot, constant_slot;  // of the products of each column
    std::vector<int> diagonal;                     // by row
    std::vector<int> pair_start, pair_slot;        // of every row: pairs with the rows of its element up to itself
  };
  /// What a solution leaves of both equations with the true masses, and the solution for that.
  struct Rest {
    std::vector<double> Q, gamma, qdd, lambda;
  };

  std::shared_ptr<const Plan> plan_;
  Masses masses_;
  const double* jacobian_ = nullptr;    // of the last factorize()
  const double* compliance_ = nullptr;  // the same, by row; nullptr: none
  std::vector<int> column_start_;       // of Phi_q, by coordinate
  Places places_;
  SparseVectors left_out_;
  std::vector<int> left_out_slot_;  // of the products of each direction
  std::vector<double> constant_values_, diagonal_values_;
  SchurScratch<double> scratch_;
  Rest rest_;  // where solutions are refined: massless coordinates, unequal masses, bodies that are light to turn
  BlockFactorization factors_;
  bool analyzed_ = false, constants_known_ = false, regularised_ = false, unequal_ = false;
  double smallest_ratio_ = 1;
  double massless_residual_ = 0;
  int weakest_row_ = -1, worst_massless_ = -1;
};

}  // namespace catena
