// The outcome of an analysis. Numerical outcomes are values, never exceptions; the names are those of the result files.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace catena {

enum class Status {
  ok,
  not_assembled,   ///< the constraints cannot all be met from the given configuration
  under_driven,    ///< fewer independent constraints than coordinates
  singular,        ///< the Jacobian lost rank where it must not
  lock_up,         ///< w^T nu != 0 at a singular configuration: no continuation
  bifurcation,     ///< branches meet and none was chosen
  inconsistent,    ///< redundant rows contradict each other
  infeasible,      ///< no design was found that meets its constraints
  unbounded,       ///< the energy has no minimum
  not_converged,   ///< iterations exhausted
  step_too_small,  ///< the integrator could not make a step
  cancelled,       ///< stopped by the user; rows so far are kept
  refused,         ///< asked for something that this scene does not allow
};

/// The name used in result files.
std::string_view to_string(Status status);

/// Outcome of an analysis in words: `message` names the worst constraint and one likely cause when not ok.
struct Report {
  Status status = Status::ok;
  std::string message;
  std::vector<std::string> warnings;

  bool ok() const { return status == Status::ok; }
};

}  // namespace catena
