// What a search for a static equilibrium is asked for, and what it returns.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "catena/analysis/spectrum/certificate.hpp"
#include "catena/analysis/statics/solvers/static_gaps.hpp"
#include "catena/analysis/statics/static_stability.hpp"
#include "catena/base/status.hpp"

namespace catena {

enum class StaticSolver { automatic, newton, ipopt, nlopt };

struct StaticSearchOptions {
  StaticSolver solver = StaticSolver::automatic;
  double tolerance = 1e-11;
  bool stationary = false;  ///< any stationary point will do
  bool warm = false;        ///< q and lambda are a solution for slightly different numbers
  bool verbose = false;
};

struct StaticResult {
  Report report;
  Certificate certificate;
  bool has_energy = true;
  std::optional<StaticStability> stability;  ///< where there is no energy, in place of the certificate
  std::vector<std::string> free_bodies{};    ///< that take part in motions without stiffness, with these forces
  std::string_view solver = "newton";
  int iterations = 0;
  double residual = 0;              ///< largest residual force, N
  std::vector<int> dependent_rows;  ///< constraint rows that follow from others
  ActiveSet gaps;                   ///< which are closed
};

}  // namespace catena
