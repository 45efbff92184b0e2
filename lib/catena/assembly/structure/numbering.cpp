#include "catena/assembly/structure/numbering.hpp"

#include <algorithm>
#include <cstdlib>
#include <numeric>

#include "catena/base/at.hpp"
#include "catena/model/disjoint_sets.hpp"

namespace catena {
namespace {

// Mean distance of tied bodies above which the given order is not local enough to keep.
constexpr double acceptable_distance = 8;

double mean_distance(std::span<const BodyPair> ties, const std::vector<int>& place) {
  double sum = 0;
  for (const BodyPair& t : ties) sum += std::abs(place[at(t.i)] - place[at(t.j)]);
  return ties.empty() ? 0 : sum / static_cast<double>(ties.size());
}

struct Neighbours {
  std::vector<int> start, list;
  int degree(int b) const { return start[at(b) + 1] - start[at(b)]; }
};

Neighbours neighbours_of(int bodies, std::span<const BodyPair> ties) {
  Neighbours n{std::vector<int>(at(bodies) + 1, 0), std::vector<int>(2 * ties.size())};
  for (const BodyPair& t : ties) ++n.start[at(t.i) + 1], ++n.start[at(t.j) + 1];
  std::partial_sum(n.start.begin(), n.start.end(), n.start.begin());
  std::vector<int> next(n.start.begin(), n.start.end() - 1);
  for (const BodyPair& t : ties) {
    n.list[at(next[at(t.i)]++)] = t.j;
    n.list[at(next[at(t.j)]++)] = t.i;
  }
  return n;
}

std::vector<int> breadth_first(int bodies, std::span<const BodyPair> ties) {
  const Neighbours n = neighbours_of(bodies, ties);
  std::vector<int> by_degree(at(bodies));
  std::iota(by_degree.begin(), by_degree.end(), 0);
  std::stable_sort(by_degree.begin(), by_degree.end(), [&](int a, int b) { return n.degree(a) < n.degree(b); });
  std::vector<int> order;
  order.reserve(at(bodies));
  std::vector<char> seen(at(bodies), 0);
  for (int root : by_degree) {
    if (seen[at(root)]) continue;
    seen[at(root)] = 1;
    std::size_t head = order.size();
    order.push_back(root);
    for (; head < order.size(); ++head) {
      const int b = order[head];
      for (int k = n.start[at(b)]; k < n.start[at(b) + 1]; ++k) {
        const int other = n.list[at(k)];
        if (!seen[at(other)]) seen[at(other)] = 1, order.push_back(other);
      }
    }
  }
  return order;
}

std::vector<BodyPair> ties_of_moving(std::span<const BodyPair> ties, const std::vector<char>& immobile) {
  std::vector<BodyPair> kept;
  kept.reserve(ties.size());
  for (const BodyPair& t : ties) {
    if (t.i >= 0 && t.j >= 0 && t.i != t.j && !immobile[at(t.i)] && !immobile[at(t.j)]) kept.push_back(t);
  }
  return kept;
}

}  // namespace

std::vector<int> number_bodies(int bodies, std::span<const BodyPair> ties, const std::vector<char>& immobile) {
  const std::vector<BodyPair> kept = ties_of_moving(ties, immobile);
  std::vector<int> order(at(bodies)), place(at(bodies));
  std::iota(order.begin(), order.end(), 0);
  std::iota(place.begin(), place.end(), 0);
  const double given = mean_distance(kept, place);
  if (given > acceptable_distance) {
    const std::vector<int> other = breadth_first(bodies, kept);
    for (int k = 0; k < bodies; ++k) place[at(other[at(k)])] = k;
    if (mean_distance(kept, place) < given) order = other;
  }
  std::stable_partition(order.begin(), order.end(), [&](int b) { return !immobile[at(b)]; });
  return order;
}

std::vector<int> find_islands(int bodies, std::span<const BodyPair> ties, const std::vector<char>& immobile,
                              int* count) {
  DisjointSets sets(bodies);
  for (const BodyPair& t : ties_of_moving(ties, immobile)) sets.join(t.i, t.j);
  std::vector<int> island(at(bodies), -1), number(at(bodies), -1);
  *count = 0;
  for (int b = 0; b < bodies; ++b) {
    if (immobile[at(b)]) continue;
    int& n = number[at(sets.root(b))];
    if (n < 0) n = (*count)++;
    island[at(b)] = n;
  }
  return island;
}

}  // namespace catena
