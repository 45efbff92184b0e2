#include "catena/analysis/balance/static_tangent.hpp"

#include <numeric>

#include "catena/analysis/balance/refine_to_rounding.hpp"
#include "catena/base/at.hpp"

namespace catena {

StaticTangent::StaticTangent(StaticSystem& system)
    : system_(system), matrix_(system.evaluator().shared_plan(), SaddleBlock::elements) {
  std::vector<int> rows(at(system.plan().rows));
  std::iota(rows.begin(), rows.end(), 0);
  matrix_.arrange(rows, true);
  weight_.resize(at(system.plan().columns));
  correction_.resize(at(matrix_.pattern().columns));
  usable_ = factorization_.analyze(matrix_.pattern(), Kernel::automatic, system.evaluator().counters).ok();
}

void StaticTangent::fill(std::span<const double> lambda, double damping) {
  const std::span<const double> inverse_arms = system_.matrix().inverse_arms();
  matrix_.begin(system_.jacobian());
  for (std::size_t c = 0; c < weight_.size(); ++c) {
    weight_[c] = 1 / (inverse_arms[c] * inverse_arms[c]);
    matrix_.add_diagonal(static_cast<int>(c), damping * weight_[c]);
  }
  matrix_.add_stiffness(system_.evaluator(), lambda);
}

bool StaticTangent::factorize() {
  return usable_ && factorization_.factorize(matrix_.values(), system_.evaluator().counters).ok();
}

bool StaticTangent::solve(std::span<double> x) {
  return factorization_.solve_checked(matrix_.values(), x, system_.evaluator().counters).ok();
}

void StaticTangent::solve_to_rounding(std::span<const double> given, std::span<double> x, bool transposed) {
  Counters& counters = system_.evaluator().counters;
  const auto solve_once = [&](std::span<double> b) {
    if (transposed)
      factorization_.solve_transposed(b, counters);
    else
      static_cast<void>(factorization_.solve_checked(matrix_.values(), b, counters));
  };
  const auto multiply = [&](std::span<const double> v, std::span<double> y) { matrix_.multiply(v, y, transposed); };
  refine_to_rounding(weight_, given, x, correction_, solve_once, multiply);
}

}  // namespace catena
