// Static equilibrium: the minimum of the potential energy under the constraints, with a certificate
// (apps/manual/statics.md#equilibrium).
//
//   min V(q)   subject to   Phi(q, t) = 0      functions of time frozen at t
//
// Solvers: Newton's method from any start (StaticNewton), descent on the constraints with few degrees of freedom, which
// finds the minimum nearest downhill from the start (StaticDescent), Ipopt, NLopt. `automatic` tries them one after the
// other and refines results of the last two by Newton's method. Forces that follow a body have no potential: their
// balance is found by settling and judged by its small motions (static_stability.hpp). Every result is certified; a
// stationary point that is no minimum is left along its most negative mode, and minimising goes on, unless stationary
// points were asked for. Refused, with the motion named: bodies that nothing holds; energies without a minimum.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "catena/analysis/run/analysis_report.hpp"
#include "catena/analysis/run/row_observer.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/system_state.hpp"
#include "catena/analysis/run/time_grid.hpp"
#include "catena/analysis/spectrum/certificate.hpp"
#include "catena/analysis/statics/static_search.hpp"

namespace catena {

enum class Accept { stable, stationary };

struct EquilibriumOptions {
  StaticSolver solver = StaticSolver::automatic;
  double tolerance =
      1e-11;  ///< of residual forces relative to the largest force, and of constraints to the length scale
  Accept accept = Accept::stable;
  int find = 1;          ///< how many different equilibria to look for
  bool verbose = false;  ///< the solvers' own logs, to standard error
};

/// One of several equilibria.
struct FoundEquilibrium {
  double energy = 0;  ///< J
  bool stable = false;
  int negative_modes = 0;
  double residual = 0;  ///< N
};

/// Outcome of the last equilibrium computed; see apps/manual/scenes.md#analyses.
struct EquilibriumReport : AnalysisReport {
  double energy = 0;       ///< potential energy, J
  bool has_energy = true;  ///< false beside forces without a potential (follower forces, laws of state)
  bool certified = false;  ///< false where stability could not be judged: then the next five say nothing
  bool stable = false;
  bool neutral = false;  ///< to second order
  int negative_modes = 0;
  int flutter = 0;                       ///< pairs of complex omega2, without an energy only
  int free_motions = 0;                  ///< that nothing resists to second order: how many
  std::vector<std::string> free_bodies;  ///< and which bodies take part in them
  double softest_stiffness = 0;          ///< N/m, of the mode below
  std::string softest_mode;              ///< the body that moves most in it
  std::vector<double> softest_shape;     ///< model order, three a body; v^T W v = 1, W = (1, 1, radius^2)
  double residual = 0;                   ///< largest residual force, N
  std::string solver;                    ///< the one that found it
  int iterations = 0;
  std::vector<std::string> active;      ///< one-sided elements whose gap is closed
  std::vector<FoundEquilibrium> found;  ///< with `find`: one a row, the lowest energy first
};

class Equilibrium {
 public:
  explicit Equilibrium(std::shared_ptr<const Model> model, const PlanOptions& plan_options = {},
                       const EquilibriumOptions& options = {});

  const Plan& plan() const { return *plan_; }
  Evaluator& evaluator() { return evaluator_; }

  /// Starts from a state of an earlier analysis instead of the given configuration at t = 0.
  void start_from(const SystemState& state);
  /// Takes over changed parameter values of a model with the same structure: the last solution is the next start.
  void set_model(std::shared_ptr<const Model> model);
  /// One equilibrium at every instant of the grid, each from the one before; one row each. With `find` above 1: up to
  /// as many different ones at the first instant, from random starts, a row each, the lowest energy first.
  EquilibriumReport run(const TimeGrid& grid, const Needs& needs, RowObserver& observer);
  /// One equilibrium at the present time; no row.
  EquilibriumReport solve();

  double time() const { return t_; }
  /// Whether the last one was found; the equations at it, with the factors that it was certified by.
  bool is_solved() const { return solved_; }
  StaticSystem& system() { return system_; }
  /// Whether there is a motion that nothing resists at the last equilibrium, or, while rows are sent, at that of the
  /// row.
  bool is_neutral() const { return neutral_; }
  std::span<const double> q() const { return q_; }
  /// Multipliers of the solver's rows: V_q + Phi_q^T lambda = 0; the least ones where constraints are redundant.
  std::span<const double> lambda() const { return lambda_; }
  /// The present state, absolute and in model order, at rest.
  SystemState state() const;
  /// Where a body is: the frame in which its points and attachments were given. By its number in the model; throws
  /// std::out_of_range for one that no body has.
  Frame<double> frame(int body) const { return frame_of(evaluator_, q_, body); }

 private:
  void choose_least_reactions(Report& report);
  EquilibriumReport find_several(const Needs& needs, RowObserver& observer);
  bool send_row(const Needs& needs, RowObserver& observer, Report& report);

  std::shared_ptr<const Model> model_;
  std::shared_ptr<const Plan> plan_;
  EquilibriumOptions options_;
  EvaluationWork evaluation_;
  Evaluator evaluator_;
  StaticSystem system_;
  bool solved_ = false, neutral_ = false;
  double t_ = 0;
  std::vector<double> q_, lambda_;
};

}  // namespace catena
