// The least of all multipliers that balance the same loads, where redundant constraints leave a choice:
//
//   min sum_k |F_k|^2 + (T_k / Lc)^2   subject to   Phi_q^T lambda = Q - M qdd
//
// F_k, T_k: what constraint k exerts on its body j about the attachment point there
// (apps/manual/dynamics.md#reactions), Lc the mean attachment distance, so that units do not matter. Per constraint
// lambda_k^T W_k lambda_k with the small matrix W_k, so
//
//   lambda_k = W_k^-1 Phi_k y,   (sum_k Phi_k^T W_k^-1 Phi_k) y = Q - M qdd
//
// whose matrix is singular by the motions that the constraints leave; the right-hand side has no part there. It is
// factored with 1e-12 of its diagonal added and the solution refined. One symbolic analysis; nothing allocates later.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/linalg/factorization/symmetric_factorization.hpp"

namespace catena {

class MinimumNorm {
 public:
  explicit MinimumNorm(const Evaluator& evaluator);

  /// Factors at the evaluator's configuration. False: not possible.
  bool factorize();
  /// lambda (solver's rows) from Q - M qdd, by coordinate of moving bodies. Returns the relative residual left.
  double solve(std::span<const double> loads, std::span<double> lambda);
  /// The elements whose reactions are not unique at the configuration of the last factorize(), ascending.
  std::vector<int> find_ambiguous();
  /// The names of find_ambiguous(), in quotes, as text; empty if there are none.
  std::string name_ambiguous();
  /// The same as a remark, found at the first call; empty where all reactions are unique.
  const std::string& ambiguity();

 private:
  struct Block {
    int element = 0, first_row = 0, rows = 0, columns = 0;
    int column[6] = {};        ///< of the plan; -1: cannot move
    double jacobian[18] = {};  ///< of the published equations, rows x 6
    double inverse_metric[9] = {};
    double scale = 1;    ///< published multiplier = scale x the solver's
    int first_slot = 0;  ///< of the lower triangle of its products
  };
  void load(Block& block) const;
  void make_pattern();

  const Evaluator& evaluator_;
  std::vector<Block> blocks_;
  std::vector<int> slot_, diagonal_;
  SparsePattern pattern_;
  std::vector<double> values_, right_hand_side_, y_;
  SymmetricFactorization factorization_;
  std::optional<std::string> ambiguity_;
  bool analyzed_ = false;
};

}  // namespace catena
