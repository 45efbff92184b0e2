// How a symmetric matrix is to be factored: form and order of elimination.
#pragma once

#include <span>

namespace catena {

enum class SymmetricForm {
  ldl,  ///< A = L D L^T, D diagonal with any signs
  ll,   ///< A = L L^T, positive definite only
};

enum class SymmetricOrdering {
  amd,      ///< least fill-in by approximate minimum degree, free order
  natural,  ///< rows as they come
  given,    ///< the caller's permutation
  grouped,  ///< minimum degree, but a row of a lower group before its neighbours of higher groups (bodies 0, joints 1)
};

struct SymmetricOptions {
  SymmetricForm form = SymmetricForm::ldl;
  SymmetricOrdering ordering = SymmetricOrdering::amd;
  std::span<const int> permutation = {};  ///< for `given`: permutation[k] is the row eliminated in place k
  std::span<const int> groups = {};       ///< for `grouped`: group of every row, 0 ... n - 1
};

}  // namespace catena
