#include "catena/linalg/pivoting/lemke.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <numeric>
#include <vector>

namespace catena {
namespace {

// Of entries of size one after some hundred pivots: what is no pivot but rounding.
constexpr double no_pivot = 1e-10;
// Of the largest value at the start: ratios that differ by less are one, the largest pivot among them is taken.
constexpr double same_ratio = 1e-12;
// Random problems of 1 to 60 places end within 3 n pivots.
constexpr Eigen::Index most_pivots = 20;  // times n

using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
using Index = Eigen::Index;

/// Basic variables as functions of the others: basic = value + entries * nonbasic. Variables: w is 0 to n - 1, z is n
/// to 2 n - 1, z_0 is 2 n.
class Tableau {
 public:
  Tableau(std::span<const double> M, std::span<const double> q)
      : n_(static_cast<Index>(q.size())),
        entries_(n_, n_ + 1),
        value_(Eigen::Map<const Eigen::VectorXd>(q.data(), n_)),
        basic_(q.size()),
        other_(q.size() + 1) {
    entries_.leftCols(n_) = Eigen::Map<const RowMajor>(M.data(), n_, n_);
    std::uint64_t draw = 0x9e3779b97f4a7c15u;
    for (Index r = 0; r < n_; ++r) {
      draw = draw * 6364136223846793005u + 1442695040888963407u;
      entries_(r, n_) = 1 + std::ldexp(static_cast<double>(draw >> 11), -53);
    }
    std::iota(basic_.begin(), basic_.end(), Index{0});
    std::iota(other_.begin(), other_.end(), n_);
    rounding_ = same_ratio * value_.lpNorm<Eigen::Infinity>();
  }

  bool solve() {
    if (n_ == 0 || value_.minCoeff() >= 0) return true;
    Index first = 0;
    for (Index r = 1; r < n_; ++r) {
      if (value_(r) * entries_(first, n_) < value_(first) * entries_(r, n_)) first = r;
    }
    Index entering = exchange(first, n_);
    for (Index pivots = 0; pivots < most_pivots * n_; ++pivots) {
      const auto column = std::find(other_.begin(), other_.end(), complement(entering)) - other_.begin();
      const Index row = leaving_row(column);
      if (row < 0) return false;
      entering = exchange(row, column);
      if (entering == 2 * n_) return true;
    }
    return false;
  }

  void read(std::span<double> z) const {
    std::fill(z.begin(), z.end(), 0.0);
    for (Index r = 0; r < n_; ++r) {
      const Index variable = basic_[static_cast<std::size_t>(r)];
      if (variable >= n_ && variable < 2 * n_) z[static_cast<std::size_t>(variable - n_)] = std::max(value_(r), 0.0);
    }
  }

 private:
  Index complement(Index variable) const { return variable < n_ ? variable + n_ : variable - n_; }

  // The first basic variable that would become negative; z_0 where it is among the first.
  Index leaving_row(Index column) const {
    double least = std::numeric_limits<double>::infinity();
    for (Index r = 0; r < n_; ++r) {
      const double falls = -entries_(r, column);
      if (falls > no_pivot) least = std::min(least, (std::max(value_(r), 0.0) + rounding_) / falls);
    }
    Index row = -1;
    for (Index r = 0; r < n_; ++r) {
      const double falls = -entries_(r, column);
      if (!(falls > no_pivot) || value_(r) > least * falls) continue;
      if (basic_[static_cast<std::size_t>(r)] == 2 * n_) return r;
      if (row < 0 || falls > -entries_(row, column)) row = r;
    }
    return row;
  }

  // Returns what becomes nonbasic.
  Index exchange(Index row, Index column) {
    const double pivot = entries_(row, column);
    const Eigen::RowVectorXd along = entries_.row(row) / pivot;
    const Eigen::VectorXd across = entries_.col(column);
    const double step = -value_(row) / pivot;
    entries_.noalias() -= across * along;
    value_.noalias() += across * step;
    entries_.row(row) = -along;
    entries_.col(column) = across / pivot;
    entries_(row, column) = 1 / pivot;
    value_(row) = step;
    std::swap(basic_[static_cast<std::size_t>(row)], other_[static_cast<std::size_t>(column)]);
    return other_[static_cast<std::size_t>(column)];
  }

  Index n_;
  RowMajor entries_;
  Eigen::VectorXd value_;
  std::vector<Index> basic_, other_;
  double rounding_ = 0;
};

}  // namespace

bool lemke(std::span<const double> M, std::span<const double> q, std::span<double> z) {
  Tableau tableau(M, q);
  const bool found = tableau.solve();
  tableau.read(z);
  return found;
}

}  // namespace catena
