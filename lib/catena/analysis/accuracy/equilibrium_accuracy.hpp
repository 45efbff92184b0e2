// How many digits of the columns of an equilibrium are right: its equations are solved once more, without errors and
// with errors put in (see kinematic_accuracy.hpp, whose estimate this is).
//
//   [ K      Phi_q^T ] [ dq      ]     [ r   ]         e = |c(found) - c(0)| + 2 sqrt(mean (c(k) - c(0))^2) / s
//   [ Phi_q  0       ] [ dlambda ] = - [ Phi ]
//
// c(0): after one more Newton step with the true K; c(k): with s rounding of the balance (balance/static_accuracy.hpp)
// and s eps |Phi_q| |q| put in at random, and the time of frozen functions off by s eps of itself. Closed gaps are
// equations, open ones none. Nothing is said of an equilibrium along whose free motions nothing brings it back, of
// several, nor of reactions where equations depend on each other.
#pragma once

#include <vector>

#include "catena/analysis/accuracy/disturbance.hpp"
#include "catena/analysis/accuracy/row_terms.hpp"
#include "catena/analysis/run/row_accuracy.hpp"
#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/columns/column_errors.hpp"
#include "catena/columns/column_set.hpp"

namespace catena {

class EquilibriumAccuracy final : public RowAccuracy {
 public:
  /// Of the one row of analysis.run(); both must outlive this object.
  EquilibriumAccuracy(Equilibrium& analysis, const ColumnSet& columns)
      : analysis_(analysis), columns_(columns), errors_(columns.size()), terms_(analysis.evaluator()) {}

  /// Nothing is to be said: of a neutral equilibrium, whose place is one of many.
  void withhold() { withheld_ = true; }
  void take(const Snapshot& snapshot, std::span<const double> values) override;
  /// Moves the analysis' equations: the next solution starts from where they were left.
  std::vector<double> digits(const AnalysisReport& report) override;

 private:
  bool correct();
  bool disturb();
  void leave_what_closes(std::span<double> gap);
  bool answer(std::span<double> force, std::span<double> gap);
  std::vector<double>& values_at(std::span<const double> q, std::span<const double> lambda,
                                 std::vector<double>& values);

  Equilibrium& analysis_;
  const ColumnSet& columns_;
  ColumnErrors errors_;
  RowTerms terms_;
  Disturbance random_;
  int rows_ = 0;
  bool withheld_ = false;
  bool unique_ = true;  // the multipliers are
  std::vector<double> values_, q_, lambda_, rounding_, change_, change_lambda_;
  std::vector<double> first_, other_, square_;  // of columns
};

}  // namespace catena
