// The tangent of the equations of a mechanism as the full matrix of a saddle point, symmetric or not.
//
//   [ A      Phi_q^T ]        A = 0, a diagonal (c M, s W), or with the elements' K = -dQ/dq + sum lambda Phi_qq
//   [ Phi_q    -E    ]        E: compliance of equations, a diagonal, only where it is asked for
//
// over the columns of the plan and those of its rows that are chosen. Forces that turn with a body and laws of state
// make -dQ/dq unsymmetric, and a law ties its bodies to all that it reads. Pattern and slots are made once from the
// plan, for every entry of every element; values are written straight into the matrix that is factored. Where all
// forces have a potential, KktMatrix keeps the lower triangle of the same matrix. Velocities are zero, functions of
// time frozen at the evaluator's time. Units: those of the coordinates and rows.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena {

/// What of A may differ from zero.
enum class SaddleBlock { none, diagonal, elements };

class Tangent {
 public:
  Tangent(std::shared_ptr<const Plan> plan, SaddleBlock block) : plan_(std::move(plan)), block_(block) {}

  /// Makes the pattern with these rows of the plan, which take their places in the order given; `yielding`: with E.
  void arrange(std::span<const int> rows, bool yielding = false);
  const SparsePattern& pattern() const { return pattern_; }
  /// By entries of the pattern.
  std::span<const double> values() const { return std::span(values_).first(pattern_.row_index.size()); }

  /// Takes Phi_q (size entries of the plan's pattern), A = 0 and E = 0.
  void begin(std::span<const double> jacobian);
  void add_diagonal(int column, double value) { values_[at(diagonal_slot_[at(column)])] += value; }
  /// E of every row.
  void set_compliance(double e);
  /// A += K at the evaluator's configuration, or K^T; lambda: of all rows of the plan.
  void add_stiffness(const Evaluator& evaluator, std::span<const double> lambda, bool transposed = false);
  /// A += sum lambda Phi_qq alone.
  void add_curvature(const Evaluator& evaluator, std::span<const double> lambda);

  /// y = the matrix without E, or its transpose, times x; of sizes `columns` A alone.
  void multiply(std::span<const double> x, std::span<double> y, bool transposed = false) const;
  /// Largest |A_ij| / (arm_i arm_j); without arms, which are given as their inverses, |A_ij|.
  double largest_stiffness(std::span<const double> inverse_arms = {}) const;

 private:
  std::shared_ptr<const Plan> plan_;
  SaddleBlock block_;
  SparsePattern pattern_;
  std::vector<double> values_;      // one more, for entries at coordinates that are no unknowns and rows left out
  std::vector<int> diagonal_slot_;  // per column, and per row where there is E
  std::vector<int> jacobian_slot_;  // two per entry of Phi_q: below and above the diagonal
  // 36 an element, in the order in which the evaluator visits them: forces, laws, constraints.
  std::vector<int> force_slot_, curvature_slot_;
};

/// Calls f(row, column, value) for every entry of an element's matrix at coordinates of moving bodies.
template <class F>
void visit_entries(const Plan& plan, int body_i, int body_j, const ElementMatrix& matrix, F&& f) {
  int place[6];
  for (int k = 0; k < 6; ++k) {
    const int body = k < 3 ? body_i : body_j;
    place[k] = body >= 0 && body < plan.moving ? 3 * body + k % 3 : -1;
  }
  for (int r = 0; r < 6; ++r) {
    for (int c = 0; c < 6 && place[r] >= 0; ++c) {
      if (place[c] >= 0) f(place[r], place[c], matrix[at(6 * r + c)]);
    }
  }
}

/// The same for all elements: every entry of K, or of sum lambda Phi_qq alone, as many times as elements add to it.
template <class F>
void visit_curvature(const Evaluator& evaluator, std::span<const double> lambda, F&& f) {
  evaluator.visit_constraint_hessians(
      lambda, [&](int i, int j, const ElementMatrix& m) { visit_entries(evaluator.plan(), i, j, m, f); });
}
template <class F>
void visit_tangent(const Evaluator& evaluator, std::span<const double> lambda, F&& f) {
  evaluator.visit_stiffness({},
                            [&](int i, int j, const ElementMatrix& m) { visit_entries(evaluator.plan(), i, j, m, f); });
  visit_curvature(evaluator, lambda, f);
}

}  // namespace catena
