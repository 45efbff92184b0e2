#include "peers/motion_references.hpp"

#include "cases/exact_chain.hpp"
#include "cases/parallelogram.hpp"

namespace motion_peer {

std::vector<Place> ends_of_falling_chain(int rods, double duration) {
  bench::ExactChain chain(rods);
  chain.move(duration, static_cast<int>(100 * duration));
  std::vector<Place> ends;
  for (const auto& end : chain.ends()) ends.push_back({static_cast<double>(end.x), static_cast<double>(end.y)});
  return ends;
}

std::vector<Place> crank_ends_of_a02(int n) {
  bench::Parallelogram exact(n);
  std::vector<Place> ends;
  for (int k = 0; k <= samples_of_a02; ++k) {
    const auto end = exact.crank_end(duration_of_a02 * k / samples_of_a02);
    ends.push_back({end.x, end.y});
  }
  return ends;
}

}  // namespace motion_peer
