// BlockFactorization: four right-hand sides at once.
#include "catena/linalg/block/block_solve.hpp"

namespace catena {

void BlockFactorization::solve(std::span<Lanes> x, std::vector<Lanes>& work, Counters& counters) {
  counters.solves += Lanes::count;
  work.resize(work_.size());
  solve_in(x, work);
}

}  // namespace catena
