// Which of the numbers 0 ... n - 1 are tied together: sets without a common element, joined pair by pair (union-find).
//
// Every element points to a lesser one of its set, the least to itself; root() halves the way that it goes, so that n
// calls take little more than n steps. Source: R. Tarjan, J. van Leeuwen, "Worst-case analysis of set union
// algorithms" (1984).
#pragma once

#include <algorithm>
#include <numeric>
#include <vector>

namespace catena {

class DisjointSets {
 public:
  /// Elements 0 ... count - 1, each a set of its own.
  explicit DisjointSets(int count) : next_(static_cast<std::size_t>(count)) {
    std::iota(next_.begin(), next_.end(), 0);
  }
  void join(int a, int b) {
    const int i = root(a), j = root(b);
    next(std::max(i, j)) = std::min(i, j);
  }
  /// The least element of the set.
  int root(int a) {
    while (next(a) != a) a = next(a) = next(next(a));
    return a;
  }
  bool are_joined(int a, int b) { return root(a) == root(b); }

 private:
  int& next(int a) { return next_[static_cast<std::size_t>(a)]; }

  std::vector<int> next_;
};

}  // namespace catena
