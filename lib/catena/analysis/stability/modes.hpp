// Small oscillations about the current configuration: natural frequencies and shapes (apps/manual/statics.md#modes).
//
//   K v = omega^2 M v   on the null space of Phi_q,   K = V_qq + sum lambda Phi_qq,   M = diag(m, m, J)
//
// The lowest omega^2 in 1/s^2, ascending: negative ones (growth rates) first, zero for motions that nothing resists.
// Up to 500 degrees of freedom that are tied together dense algebra finds all of them (modes_dense.hpp); beyond,
// Lanczos' method the lowest (modes_search.hpp), and the inertia of K - mu M just below the highest one proves that
// none is missing. Functions of time, drivers among them, are frozen; damping and gyroscopic terms are left out, and
// warnings say so. Where forces are not in balance there are no small oscillations about that place: modes are given
// all the same, with a warning. Refused: bodies without mass that the constraints tie to no mass.
//
// Forces without a potential make K unsymmetric (circulatory_modes.hpp): a pair omega2 +- i b takes two places, that of
// the motion that grows first,
//
//   Re (v e^(growth t + i omega t)),   (growth + i omega)^2 = -(omega2 - i b)      shapes: Re v, then Im v
//
// Refused beside these: more than 500 degrees of freedom. A closed element with a stiffness k is rigid there, with a
// warning.
//
// One-sided elements that are closed with a force hold as equations, the others not at all (active_set_at.hpp); those
// that touch without force are named. A closed one with a stiffness k is a spring instead,
//
//   K + (k_t + N Psi'') Psi_q^T Psi_q - N Psi_qq,   k_t = dN/dd = e k^(1/e) N^(1 - 1/e)   of N = k d^e
//
// Psi'' by the depth: -2 / (max - min) of a stop between two bounds, whose Psi bends as the depth does not; else 0.
// N the force at this place: an equilibrium before, which takes it as rigid, is off by its depth d = (N/k)^(1/e).
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "catena/analysis/motion/mass_matrix.hpp"
#include "catena/analysis/run/analysis_report.hpp"
#include "catena/analysis/run/system_state.hpp"
#include "catena/analysis/spectrum/circulatory_modes.hpp"
#include "catena/analysis/spectrum/modes_dense.hpp"
#include "catena/analysis/spectrum/static_balance.hpp"
#include "catena/analysis/statics/solvers/static_gaps.hpp"

namespace catena {

struct ModesOptions {
  int count = 0;  ///< how many, 0: all, at most ten
};

struct ModesReport : AnalysisReport {
  std::vector<double> omega2;  ///< rad^2/s^2, ascending
  std::vector<double> omega;   ///< sqrt(|omega2|), rad/s; a growth rate, 1/s, where omega2 < 0
  /// Of omega2, by rounding: a Rayleigh quotient of a shape is off by the rounding of the stiffnesses in it before
  /// these cancel (StiffnessFloor), and by no more than the square of the shape's own error. 0 where omega2 is an exact
  /// zero.
  std::vector<double> errors;
  std::vector<std::vector<double>> shapes;  ///< over columns, v^T M v = 1 kg m^2; the largest angle or, where none
                                            ///< turns, the largest displacement is positive
  int unstable = 0;                         ///< how many omega^2 below zero there are in all, and pairs
  int flutter = 0;                          ///< how many pairs omega2 +- i imaginary
  std::vector<double> imaginary;            ///< rad^2/s^2, of every omega2; empty where all are real
  std::vector<double> growth;               ///< 1/s; of a pair omega is the frequency; empty where all are real
  int free_motions = 0;                     ///< how many zeros: in all, or among those found in a large mechanism
  std::vector<std::string> free_bodies;     ///< bodies that take part in them
  std::vector<std::string> active;          ///< one-sided elements that hold
};

class Modes {
 public:
  explicit Modes(std::shared_ptr<const Model> model, const PlanOptions& plan_options = {},
                 const ModesOptions& options = {});

  const Plan& plan() const { return *plan_; }
  Evaluator& evaluator() { return evaluator_; }

  /// The configuration, and the time at which functions are frozen; before that the given one at t = 0.
  void start_from(const SystemState& state);
  /// `go_on`: called now and then; false cancels.
  ModesReport run(const std::function<bool()>& go_on = {});

  double time() const { return t_; }
  /// The configuration, assembled, plan order.
  std::span<const double> q() const { return q_; }
  SystemState state() const;

 private:
  /// Makes springs of closed compliant elements, whose rows are left out from then on.
  void soften(ActiveSet& set, std::span<const double> lambda);
  /// Takes the system to the assembled place, with the multipliers that balance its loads best.
  Report take_place(std::span<double> lambda, Imbalance& left, ModesReport& report);
  Report find_modes(const MassMatrix& masses, std::span<const double> mass, std::span<const double> lambda,
                    double residual, int count, std::vector<Mode>& modes, const std::function<bool()>& go_on);
  Report undetermined(int column) const;
  /// The modes under forces without a potential, to the report.
  Report find_circulatory(std::span<const double> mass, std::span<const double> lambda, double residual, int count,
                          ModesReport& report);
  void list(const CirculatoryModes& found, int count, ModesReport& report);

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Plan> plan_;
  ModesOptions options_;
  EvaluationWork evaluation_;
  Evaluator evaluator_;
  StaticSystem system_;
  std::vector<AddedSpring> added_;
  bool moving_ = false;
  int hidden_unstable_ = 0;  // counted by the inertia of a large mechanism
  double t_ = 0;
  std::vector<double> q_;
};

}  // namespace catena
