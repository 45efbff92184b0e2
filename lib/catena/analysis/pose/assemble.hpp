// Assembly: the configuration nearest to a given estimate that meets all constraints
// (apps/manual/kinematics.md#assembly).
//
//   min sum_b |dr_b|^2 + rho_b^2 dphi_b^2   subject to   Phi(q, t) = 0        rho: RMS attachment distance of the body
//
// Whole turns are moved first; then damped Gauss-Newton steps of least weighted size, none of which may enlarge the
// residual; then, where freedom is left, Newton steps along the constraints to the nearest place. Sketches from which
// steps lead to a saddle of the misfit, as links drawn in one line, are displaced a little from it. Never returns a
// worse configuration than the given one and never reports success above the tolerance, or the rounding of the
// coordinates. Where constraints cannot be met the conflicting ones are named (misfits.hpp).
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/pose/misfits.hpp"
#include "catena/analysis/pose/scaling.hpp"
#include "catena/assembly/evaluate.hpp"
#include "catena/assembly/systems/constraint_solver.hpp"
#include "catena/base/status.hpp"

namespace catena {

struct AssemblyOutcome : Report {
  int iterations = 0;
  double residual = 0;          ///< largest, in length scales or rad
  double moved = 0;             ///< how far the estimate was off: weighted RMS over bodies, m
  double shifted = 0;           ///< the same: largest shift of a body's centroid, m
  double turned = 0;            ///< and largest angle, but for whole turns, rad
  std::vector<Misfit> misfits;  ///< the worst first, at most ten; filled when not assembled
};

class Assembler {
 public:
  explicit Assembler(Evaluator& evaluator);

  /// Assembles q (plan order) in place at the evaluator's time. `tolerance` is relative to the length scale.
  AssemblyOutcome assemble(std::span<double> q, double tolerance = 1e-12);

 private:
  bool restore(std::span<double> q, double tolerance, int most_iterations, AssemblyOutcome& outcome);
  /// Why no configuration was found; q is the given one again.
  void give_up(std::span<double> q, std::span<const double> given, std::span<const double> estimate,
               AssemblyOutcome& outcome);
  bool restore_from_beside(std::span<double> q, std::span<const double> estimate, double tolerance, bool far_too,
                           AssemblyOutcome& outcome);
  void land_on_crossing(std::span<double> q);
  void approach_estimate(std::span<double> q, std::span<const double> estimate, double tolerance,
                         AssemblyOutcome& outcome);
  /// z: the part of W^-1 r that the constraints allow, at the place that was factored. r becomes W z: the part that
  /// they take up may be much larger and is taken out, as its rounding would hide z. Multipliers go to lambda_.
  void project(std::span<double> r, std::span<double> z);
  /// Fills step_ with the step along the constraints to where the distance from the estimate is least. Returns the
  /// slope of the distance along it, which is 0 where q is nearest already.
  double find_approach(std::span<const double> q, std::span<const double> estimate);
  /// An element whose residual at q overflows when it is squared, or -1.
  int element_out_of_range(std::span<const double> q);
  double merit(std::span<const double> q);
  /// Largest coordinate relative to the bodies' origins, in length scales; angles in rad.
  double extent(std::span<const double> q) const;
  void advance(std::span<const double> from, double factor, std::span<double> to) const;
  double weighted_distance(std::span<const double> a, std::span<const double> b) const;

  Evaluator& evaluator_;
  const Plan& plan_;
  Scaling scaling_;
  std::optional<ConstraintSolver> solver_;  // made where there is something to assemble
  std::vector<double> weights_;             // per coordinate of a moving body; 0 of what is held
  std::vector<double> reach_;               // the same: what a displacement of 1 is, m or rad
  std::vector<CurvePlace> curve_places_;    // of contacts, where a trial begins
  std::vector<double> values_, phi_, lambda_, step_, trial_;
  bool ends_beside_crossing_ = false;  // restore() came slowly to a place where branches cross or fold
};

}  // namespace catena
