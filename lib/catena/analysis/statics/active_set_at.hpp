// Which one-sided elements hold at a given place, and the multipliers there.
//
//   V_q + Phi_q^T lambda - Psi_q^T p = 0,   p >= 0 where Psi = 0,   p = 0 where Psi > 0
//
// The gaps that touch are closed first; those that would pull at the multipliers that balance the loads best
// (static_balance.hpp) are opened, until none does. Those that touch without a force are called weak: rounding, or the
// next load, decides whether they hold. Here they count as open, as a motion that they limit on one side only is no
// small oscillation. The place is changed by assembly alone, for which all are open. Units: m, rad, N, N m.
#pragma once

#include <cmath>
#include <string>
#include <vector>

#include "catena/analysis/spectrum/static_balance.hpp"
#include "catena/analysis/statics/solvers/static_gaps.hpp"

namespace catena {

/// The system is left with the gaps that are closed and not weak as equations, and lambda (rows) filled; `set` has them
/// in `closed`. A report that is not ok: there is no place near q that meets the constraints, or a gap is violated.
Report close_gaps_at(StaticSystem& system, std::vector<double>& q, std::span<double> lambda, ActiveSet& set,
                     Imbalance& left);

/// Plan options with one-sided elements.
inline PlanOptions with_gaps(PlanOptions options) {
  options.one_sided = true;
  return options;
}

/// The names of those that hold, in the order of the file.
std::vector<std::string> names_of_closed(const Evaluator& evaluator, const ActiveSet& set);

/// The law N = k d^exponent of a one-sided element; k = 0: it is rigid.
struct Compliance {
  double k = 0, exponent = 1;
  /// Psi'' by the depth where Psi = 0 and |Psi'| = 1: that of a stop between two bounds, 1/m or 1/rad; else Psi is the
  /// depth itself.
  double bend = 0;
  bool compliant() const { return k > 0; }
  /// dN/dd where it presses with N.
  double stiffness_at(double force) const {
    return exponent * std::pow(k, 1 / exponent) * std::pow(force, 1 - 1 / exponent);
  }
  /// The spring beside -N Psi_qq that makes it the second derivative of the law's energy: what Psi bends is no part.
  double stiffness_beside(double force) const { return stiffness_at(force) + force * bend; }
};
Compliance compliance_of(const Model& model, int element);

/// The remark on weak elements, with these names.
std::string taken_as_open(const std::string& names);
/// The remark on closed elements whose stiffness counts in motion only; empty: there are none.
std::string taken_as_rigid(const Evaluator& evaluator, const ActiveSet& set);
/// Remarks on a set: weak elements that are taken as open, and closed ones whose stiffness counts in motion only.
std::vector<std::string> remarks_on(const Evaluator& evaluator, const ActiveSet& set);

/// The names of the weak ones, the first few; empty: there are none.
std::string names_of_weak(const Evaluator& evaluator, const ActiveSet& set);

}  // namespace catena
