// Multipliers of a driven motion, from its positions and rates:
//
//   Phi_q^T lambda = Q - M qdd
//
// and the friction of joints (driven_friction.hpp), which needs reactions that are unique.
//
// Where equations depend on each other the least of all multipliers that give these accelerations
// (minimum_norm.hpp), and a remark names the elements whose reactions are not unique. At a singular configuration the
// limit of the multipliers on both sides, NaN where there is none, and a remark that says so. Units: those of the
// solver's rows. Nothing allocates after the first row that is not singular.
#pragma once

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/kinematics/course/bridged_stretch.hpp"
#include "catena/analysis/kinematics/driven_friction.hpp"
#include "catena/analysis/kinematics/driven_solver.hpp"
#include "catena/analysis/pose/minimum_norm.hpp"
#include "catena/base/status.hpp"

namespace catena {

class DrivenReactions {
 public:
  /// All must outlive this object.
  DrivenReactions(Evaluator& evaluator, DrivenSolver& solver, const FixedCoordinates& fixed)
      : evaluator_(evaluator), plan_(evaluator.plan()), solver_(solver), fixed_(fixed), friction_(evaluator) {}

  // `now`: the evaluator and the solver are there.

  /// Solves for the multipliers; `singular` where they are not determined.
  Report solve(const DrivenInstant& now);
  /// Takes their limit, from the motion that the stretch gives on both sides of a singular instant.
  void take_limit(const DrivenInstant& now, const BridgedStretch& stretch);
  std::span<const double> multipliers() const { return lambda_; }
  /// Of joints with friction, by element; empty: there are none.
  std::span<const ContactLoad> friction() const { return friction_.loads(); }
  double dissipation() const { return friction_.dissipation(); }
  void read_pressing(std::span<const double> qd, std::vector<Vec2<double>>& pressing) const {
    friction_.read_pressing(lambda_, qd, pressing);
  }
  /// What is to be said of the multipliers of all rows so far.
  void add_remarks(std::vector<std::string>& warnings) const;

 private:
  /// The value at the singular instant of the polynomials through lambda and (t - t*) lambda, and the largest entry of
  /// the latter, in comparable units.
  struct Limit {
    bool known = false;
    std::vector<double> pole;
    double scale = 0;
  };
  void find_loads(std::span<const double> qd, std::span<const double> qdd);
  void choose_least(const DrivenInstant& now);
  Report add_friction(const DrivenInstant& now);
  double solve_least(std::span<double> lambda);
  Limit extrapolate(const DrivenInstant& now, const BridgedStretch& stretch);
  bool solve_on_bridge(const MotionBridge& bridge, double t, std::span<const double> known, std::span<double> lambda);
  bool balances_loads(double scale) const;
  void note_limit(double t, const std::vector<int>& without);
  double row_unit(std::size_t row) const { return plan_.row_is_angle[row] ? 1 : evaluator_.length_scale(); }

  Evaluator& evaluator_;
  const Plan& plan_;
  DrivenSolver& solver_;
  const FixedCoordinates& fixed_;
  std::vector<double> lambda_, least_lambda_;
  std::vector<double> loads_, applied_;      // Q - M qdd by columns; by coordinates
  std::vector<double> columns_;              // of a unit of friction
  std::optional<MinimumNorm> minimum_norm_;  // where rows depend on each other
  DrivenFriction friction_;                  // of joints
  std::string ambiguity_;                    // in words: the elements whose reactions are not unique
  // Rows whose multipliers are limits: how many, the first instant, and the elements without a limit, in words.
  std::int64_t limit_rows_ = 0;
  double limit_t_ = 0;
  std::string without_limit_;
};

}  // namespace catena
