// How many digits of the columns of a driven motion are right: a few rows are solved once more after the run, without
// errors and with errors put in.
//
//   e = |c(run) - c(0)| + 2 sqrt(mean over k of (c(k) - c(0))^2) / s
//
// c(0): the columns with fresh factors and one more correction of the position, so that the first term is what Newton's
// method and the refinement of rates left. c(k): with every equation off by s times its rounding, s = 2^20 so that the
// rounding of c itself does not count, less where places or rates would change by more than 1e-4:
//
//   Phi(q, t (1 + s eps))    = s (eps sum |terms| + residual)     terms: of row r, |Phi_q| |q|, |q| from the ground's
//   Phi_q qd  - nu           = s eps |Phi_q| |qd|                        origin and no angle below 1 rad
//   Phi_q qdd - gamma        = s eps |Phi_q| (|qdd| + omega |qd|)
//   Phi_q^T lambda - Q + M a = s eps (|Phi_q|^T |lambda| + |M a| + sum |Q|)
//
// each times a random number of [-1, 1], and with rates and multipliers off by their own rounding and by what
// refinement left of the largest of them in any row. The errors of a column follow from its values alone, whatever it
// is made of. Rows: the fastest, the worst conditioned, one in the middle, the last. Nothing is said of a motion that
// passes singular positions, where rows are interpolated, nor of work, which is summed up over time, nor of reactions
// where equations depend on each other, nor of large mechanisms with few rows, where it would cost what the run does.
// Source: J. Vignes, "A stochastic arithmetic for reliable scientific computation" (1993).
#pragma once

#include <vector>

#include "catena/analysis/accuracy/disturbance.hpp"
#include "catena/analysis/accuracy/row_terms.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/run/row_accuracy.hpp"
#include "catena/columns/column_errors.hpp"
#include "catena/columns/column_set.hpp"

namespace catena {

class KinematicAccuracy final : public RowAccuracy {
 public:
  /// Of the rows of analysis.run(); both must outlive this object, and so must the models that its evaluator has at the
  /// rows: those of ropes differ where they have met and left pulleys.
  KinematicAccuracy(Kinematics& analysis, const ColumnSet& columns);

  void take(const Snapshot& snapshot, std::span<const double> values) override;
  /// Moves the analysis' solver to its rows: nothing is solved with it afterwards.
  std::vector<double> digits(const AnalysisReport& report) override;

 private:
  struct Row {
    double t = 0;
    const Model* model = nullptr;
    std::vector<double> q, values;
    std::vector<CurvePlace> curves{};  // where contacts are at q
  };
  struct State {
    std::vector<double> q, qd, qdd, lambda;
  };
  void keep(Row& row, const Snapshot& snapshot, std::span<const double> values) const;
  bool examine(const Row& row);
  bool disturb(const Row& row, const State& exact);
  bool disturb_by(double size, const Row& row, const State& exact, State& state);
  double change(const State& exact, const State& state) const;
  bool solve_rates(State& state, const State* exact, double size);
  bool solve_loads(State& state, double size);
  /// x += Phi_q^-1 of `size` eps times the terms of the equations, and its own rounding, at random.
  bool add_response(std::span<double> x, double size, std::span<const double> moduli, std::span<const double> rates);
  std::vector<double>& values_at(const Row& row, const State& state, std::vector<double>& values);

  Kinematics& analysis_;
  const ColumnSet& columns_;
  const Plan& plan_;
  bool velocity_, acceleration_, multipliers_;
  ColumnErrors errors_;
  Disturbance random_;
  Row fastest_, worst_, middle_, last_;
  double fastest_rate_ = 0;
  double worst_rcond_ = 0, residual_ = 0;               // residual_: largest of all rows, m
  double left_of_rates_ = 0, left_of_multipliers_ = 0;  // by refinement, as parts of the largest
  std::int64_t count_ = 0, next_ = 1;
  RowTerms terms_;
  /// For their memory.
  struct {
    std::vector<double> change, moduli, loads;  // of a solve
    std::vector<double> first, other, square;   // of columns
    std::vector<double> unknown;                // works of drivers
  } kept_;
};

}  // namespace catena
