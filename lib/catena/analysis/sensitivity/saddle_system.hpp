// The equations that derivatives of states solve, whatever the analysis: symmetric or not, direct, with the true
// matrix.
//
//   [ A      Phi_q^T ] [ x      ]   [ f ]        A = 0         driven kinematics: two solves with Phi_q in one
//   [ Phi_q  0       ] [ lambda ] = [ b ]        A = M         accelerations and multipliers of a motion
//                                                A = K         equilibrium; W, the metric of a projection
//
// over the columns of the plan and a maximal independent set of those rows that hold: multipliers of the other rows are
// zero, and what they ask of x follows from the rest or contradicts it (contradicted_row). Singular where A is, on the
// null space of Phi_q: the equilibrium is neutral, the mechanism under-driven. Factors of other analyses are
// regularised or of other matrices; one more factorization an instant is the price for derivatives that are exact to
// rounding x condition. Source: apps/manual/sensitivity.md.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/assembly/systems/tangent.hpp"
#include "catena/linalg/factorization/factorization.hpp"
#include "catena/linalg/kernels/dense_factors.hpp"
#include "catena/linalg/kernels/lanes.hpp"

namespace catena {

class SaddleSystem {
 public:
  SaddleSystem(std::shared_ptr<const Plan> plan, SaddleBlock block);

  /// Rows that do not hold, ascending; the next begin() chooses independent ones anew if they are others.
  void leave_out(std::vector<int> rows);
  /// Solves with the rows that another system of this plan has chosen, for the same values of Phi_q.
  void use_rows_of(const SaddleSystem& other);
  /// Takes these values of Phi_q (size entries), and A = 0; false where no pattern of this kind can be solved.
  bool begin(std::span<const double> jacobian);
  /// Adds `value` to the diagonal at a coordinate.
  void add_diagonal(int coordinate, double value);
  /// The matrix between begin() and factorize(): K of the elements is added to it.
  Tangent& tangent() { return tangent_; }
  /// Factors what was filled in; false where the matrix is singular or not finite.
  bool factorize();
  /// begin(), what `fill` adds, and factorize(): where that fails once more, with independent rows chosen anew.
  template <class Fill>
  bool factorize(std::span<const double> jacobian, Fill&& fill) {
    for (int attempt = 0; attempt < 2; ++attempt) {
      if (begin(jacobian)) {
        fill();
        if (factorize()) return true;
      }
      rows_known_ = false;
    }
    return false;
  }

  /// Solves in place: f over coordinates, b over all rows of the plan; x and lambda take their places. Sizes
  /// coordinates() and rows; what is no unknown is left alone in f and zero in lambda. False where that fails.
  bool solve(std::span<double> f, std::span<double> b);
  /// Whether solve_places() can be used: A = 0 and Phi_q is square, regular and small.
  bool solves_in_lanes() const { return alone_is_solved_ && dependent_.empty(); }
  /// Phi_q x = b for four right-hand sides; sizes as in solve(); entries of x that are no unknowns stay as they are.
  void solve_places(std::span<const Lanes> b, std::span<Lanes> x);
  /// The dependent row that x of the last solve() does not meet, b of the rows it depends on asking for another change;
  /// -1 where all agree. The worst one.
  int contradicted_row() const;
  /// Rows that depend on others: their multipliers are not determined.
  const std::vector<int>& dependent_rows() const { return dependent_; }

 private:
  struct DependentEntry {
    int place;  // in dependent_
    int column, entry;
    double value;
  };

  /// Phi_q where it is factored by itself: by a list of its entries, or in full.
  struct Alone {
    bool listed = false, in_list = false;  // the list may be used; it has the factors
    bool has_units = false;
    std::vector<int> slot;  // per entry of Phi_q; -1: the row is not solved with
    DenseFactors factors;
    std::vector<double> solution;
    std::vector<Lanes> side, places;
  };

  void choose_rows(std::span<const double> jacobian);
  bool make_pattern();
  void find_dependent_entries();
  void find_dense_slots();
  bool factorize_alone();
  void solve_alone();

  std::shared_ptr<const Plan> plan_;
  SaddleBlock block_;
  Tangent tangent_;
  std::vector<int> left_out_, rows_, dependent_, place_of_row_;
  bool rows_known_ = false, analyzed_ = false;
  bool alone_is_solved_ = false;  // alone_ is solved with
  std::vector<double> values_;    // of Phi_q, for alone_
  std::vector<double> solution_;
  std::vector<DependentEntry> dependent_entries_;  // of Phi_q
  std::vector<double> asked_;                      // b of dependent rows at the last solve()
  Alone alone_;
  Factorization factorization_;  // of tangent_, or of alone_ where it has a list
  Counters counters_;
};

/// Why there is no derivative by a parameter that moves this row alone.
std::string describe_contradiction(const Model& model, const Plan& plan, int row);

}  // namespace catena
