// The Hessian of the Lagrangian, factor V_qq + sum lambda Phi_qq, as a list of entries: for optimisers, which need the
// true second derivatives without the augmentation of the library's own factorization. Lower triangle over columns;
// entries that no element writes are left out. Nothing allocates after construction.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"

namespace catena {

class StaticHessian {
 public:
  explicit StaticHessian(StaticSystem& system);

  /// Values at the configuration where the system is; lambda over rows.
  void evaluate(double factor, std::span<const double> lambda);

  std::vector<int> slot;         ///< of the entries in the values of the system's matrix
  std::vector<int> row, column;  ///< columns of the plan, column <= row
  std::vector<double> value;

 private:
  void add(double factor, std::span<const double> lambda);

  StaticSystem& system_;
  std::vector<double> scaled_;
};

}  // namespace catena
