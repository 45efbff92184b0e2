// Motions that neither constraints nor forces resist, to second order: the free motions in results of equilibrium,
// modes and check.
//
//   Phi_q v = 0,   v^T (V_q + Phi_q^T lambda) = 0,   K v = 0 but for rounding       v over columns, m and rad
//
// Found in lengths, without masses, from the same dense spectrum as small oscillations (modes_dense.hpp).
#pragma once

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"
#include "catena/analysis/run/system_state.hpp"

namespace catena {

/// Part of sum |v_i K_ij v_j| below which a stiffness counts as none: the place itself is known no better.
inline constexpr double neutral_part = 1e-10;

struct FreeMotions {
  int count = 0;                    ///< how many independent ones
  int negative = 0;                 ///< modes of negative stiffness beside them
  std::vector<double> lowest;       ///< shape of the most negative of these, over columns; empty where there is none
  std::vector<std::string> bodies;  ///< names of those that take part in any free motion, in the model's order
  std::vector<std::vector<double>> shapes;  ///< of the free ones, over columns
};

/// At the configuration and with the K that the system's matrix holds. `second_order`: neutral_part, or 0:
/// rounding alone. Nothing where the mechanism is too large for dense algebra.
std::optional<FreeMotions> find_free_motions(StaticSystem& system, std::span<const double> lambda, double second_order);

/// The same at a state as it is, balanced or not, with one-sided elements open. Nothing too where forces have no
/// energy.
std::optional<FreeMotions> find_free_motions(const std::shared_ptr<const Model>& model, const SystemState& state);

/// Names, in the model's order, of the bodies that move in any of these motions.
std::vector<std::string> names_of_moving(StaticSystem& system, std::span<const double> lambda,
                                         const std::vector<std::vector<double>>& shapes);

/// "2 motions of "crab", "load"".
std::string describe_free_motions(int count, const std::vector<std::string>& bodies);

}  // namespace catena
