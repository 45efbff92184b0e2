// Mobility of a mechanism: degrees of freedom by count and by rank, redundant constraints, islands.
//
//   DOF = n - rank(Phi_q)        mobility: the same without the drivers        Grübler: n - rows
//
// The rank is that of Phi_q at one configuration, by sparse QR with rows and columns in comparable units; redundant
// equations are named, as consistent (their residual vanishes with the others') or contradictory.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/base/status.hpp"

namespace catena {

struct MobilityReport {
  int columns = 0, rows = 0;
  int rank = 0;  ///< of Phi_q
  int rank_without_drivers = 0;
  std::vector<int> redundant_elements;         ///< elements with redundant rows (redundancy.hpp), model numbering
  std::vector<std::vector<int>> dependent_on;  ///< per redundant element: the elements it depends on
  std::vector<int> contradictory_elements;     ///< redundant ones whose velocities the others do not allow
  std::vector<std::string> free_bodies;        ///< bodies that take part in the free motions, the most mobile first
  std::vector<std::string> warnings;

  int dof() const { return columns - rank; }
  int mobility() const { return columns - rank_without_drivers; }
  /// The free motions in a sentence for a report.
  std::string describe_freedom() const;
};

/// Rank analysis at the configuration q (plan order) and the evaluator's time.
MobilityReport analyse_mobility(Evaluator& evaluator, std::span<const double> q);

/// The other elements of a dependence that this one belongs to; none if it belongs to none. Drivers first: they are the
/// most likely cause of a contradiction.
std::vector<int> elements_against(const MobilityReport& mobility, const Model& model, int element);

}  // namespace catena
