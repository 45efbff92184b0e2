// A list of sparse vectors, stored one after the other.
#pragma once

#include <span>
#include <vector>

namespace catena {

/// Vector k has the entries start[k] ... start[k + 1] - 1.
struct SparseVectors {
  std::vector<int> start{0};
  std::vector<int> index;
  std::vector<double> value;

  int count() const { return static_cast<int>(start.size()) - 1; }
  std::span<const int> indices(int k) const { return {index.data() + start[k], index.data() + start[k + 1]}; }
  std::span<const double> values(int k) const { return {value.data() + start[k], value.data() + start[k + 1]}; }
};

}  // namespace catena
