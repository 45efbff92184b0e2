// BlockFactorization: four right-hand sides at once, and rows of many.
#include <memory>

#include "catena/linalg/block/block_solve.hpp"
#include "catena/linalg/kernels/packs.hpp"

namespace catena {

void BlockFactorization::solve(std::span<Lanes> x, std::vector<Lanes>& work, Counters& counters) {
  counters.solves += Lanes::count;
  work.resize(work_.size());
  solve_in(x, work);
}

/// `work`: as many packs as there are rows, aligned to them.
struct BlockFactorization::RowsKernel {
  const BlockFactorization& factors;
  double* x;
  std::size_t width;
  void* work;

  template <class P>
  void run(std::size_t first) const {
    P* const y = static_cast<P*>(work);
    const int* const order = factors.structure_.order.data();
    const int size = factors.size();
    for (int k = 0; k < size; ++k) packs::load(y[k], x + static_cast<std::size_t>(order[k]) * width + first);
    factors.solve_in_order(y);
    for (int k = 0; k < size; ++k) packs::store(y[k], x + static_cast<std::size_t>(order[k]) * width + first);
  }
};

void BlockFactorization::solve_rows(double* x, std::size_t width, std::vector<double>& work, Counters& counters) {
  if (!factorized_) throw std::logic_error("BlockFactorization: no valid factors to solve with");
  counters.solves += static_cast<std::int64_t>(width);
  constexpr std::size_t widest = 4;  // numbers of a pack
  const std::size_t bytes = work_.size() * widest * sizeof(double);
  work.resize((work_.size() + 1) * widest);
  void* aligned = work.data();
  std::size_t room = work.size() * sizeof(double);
  packs::with_packs(RowsKernel{*this, x, width, std::align(widest * sizeof(double), bytes, aligned, room)}, width);
}

}  // namespace catena
