// The report of an analysis: outcome in words, counts, and facts about the mechanism.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "catena/base/counters.hpp"
#include "catena/base/status.hpp"

namespace catena {

struct AnalysisReport : Report {
  int bodies = 0;                      ///< of the model
  int rows = 0;                        ///< constraint rows, drivers included
  std::optional<int> rank;             ///< of Phi_q, where it was determined
  std::optional<int> dof;              ///< coordinates - rank, drivers counted as constraints
  std::optional<int> mobility;         ///< the same without the drivers
  int islands = 0;                     ///< groups of bodies tied by constraints
  std::vector<std::string> redundant;  ///< names of constraints with redundant rows
  double seconds = 0;                  ///< process CPU time
  Counters counters;
};

}  // namespace catena
