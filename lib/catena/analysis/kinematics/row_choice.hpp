// Kinematics with more equations than coordinates: the choice of the equations that are solved with, and the check that
// the others follow from them at every instant.
//
//   |Phi_k| <= 1e-8 (length scales, rad),   |Phi_k,q qd - nu_k| and |Phi_k,q qdd - gamma_k| relative to the rates
//
// Where there are as many equations as coordinates nothing is chosen or checked.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catena/analysis/kinematics/driven_solver.hpp"
#include "catena/analysis/pose/mobility.hpp"
#include "catena/base/status.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {

class RowChoice {
 public:
  /// Both must outlive this object.
  RowChoice(Evaluator& evaluator, DrivenSolver& solver)
      : evaluator_(evaluator), plan_(evaluator.plan()), solver_(solver), mobility_(plan_.driver_rows) {}

  /// Whether there are more equations than coordinates.
  bool has_redundant_rows() const { return plan_.rows > plan_.columns; }
  /// Of more equations than needed an independent set at q, then the best one. False: they do not determine it.
  bool choose(std::span<const double> q);
  /// Other equations, if they make the matrix at q better conditioned, which is factored there. False: none do.
  bool choose_better(std::span<const double> q);
  /// Factors the matrix at q: its condition is what later ones are compared with.
  void note_condition(std::span<const double> q) { chosen_rcond_ = solver_.factor_at(q); }
  /// Whether the condition of the equations in use has become much worse than where they were chosen.
  bool has_drifted() const { return chosen_rcond_ > 0 && solver_.rcond() < dependence::fallen * chosen_rcond_; }
  /// The elements with redundant equations, for the report, and how many freedoms the drivers take away.
  void name_redundant(const MobilityReport& mobility);
  void forget_names() { names_.clear(), mobility_ = plan_.driver_rows; }
  /// Degrees of freedom without the drivers, of which some may follow from others.
  int mobility() const { return mobility_; }
  const std::vector<std::string>& names() const { return names_; }

  // `now`: the evaluator and the solver are there.

  /// `inconsistent` where an equation that is not solved with does not hold.
  Report check_places(const DrivenInstant& now);
  /// The same of its velocity or acceleration: drivers may agree in place and differ in speed. `allowed`: part of the
  /// largest rates. Unless `in_words`, only the status is set.
  Report check_rates(const DrivenInstant& now, double allowed, bool in_words);

 private:
  Report contradicts(const DrivenInstant& now, int row, const std::string& how);
  const char* unit_of(int row) const;

  Evaluator& evaluator_;
  const Plan& plan_;
  DrivenSolver& solver_;
  std::vector<std::string> names_;
  int mobility_;
  std::vector<double> rest_, rates_;  // of redundant rows, by row; of a check, by column
  double chosen_rcond_ = 0;           // of the rows in use, where they were chosen
};

}  // namespace catena
