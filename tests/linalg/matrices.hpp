// Matrices for the tests of linalg, sparse and dense at once, from a generator that gives the same numbers everywhere.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "catena/linalg/patterns/sparse_pattern.hpp"

namespace catena::testing {

/// SplitMix64: uniform numbers, identical with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  std::uint64_t bits() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  double uniform(double low, double high) { return low + (high - low) * static_cast<double>(bits() >> 11) * 0x1p-53; }
  int below(int bound) { return static_cast<int>(bits() % static_cast<std::uint64_t>(bound)); }

 private:
  std::uint64_t state_;
};

struct Matrix {
  SparsePattern pattern;
  std::vector<double> values;
};

/// Entries given twice are added.
struct Triplet {
  int row;
  int column;
  double value;
};

inline Matrix assemble(int rows, int columns, const std::vector<Triplet>& triplets) {
  std::vector<MatrixEntry> entries;
  entries.reserve(triplets.size());
  for (const Triplet& t : triplets) entries.push_back({t.row, t.column});
  SlottedPattern built = build_pattern(rows, columns, entries);
  Matrix matrix{std::move(built.pattern), {}};
  matrix.values.assign(matrix.pattern.row_index.size(), 0.0);
  for (std::size_t k = 0; k < triplets.size(); ++k) matrix.values[built.slot[k]] += triplets[k].value;
  return matrix;
}

inline Eigen::MatrixXd dense(const Matrix& matrix) {
  Eigen::MatrixXd full = Eigen::MatrixXd::Zero(matrix.pattern.rows, matrix.pattern.columns);
  for (int j = 0; j < matrix.pattern.columns; ++j)
    for (int k = matrix.pattern.column_start[j]; k < matrix.pattern.column_start[j + 1]; ++k)
      full(matrix.pattern.row_index[k], j) += matrix.values[k];
  return full;
}

inline Matrix sparse(const Eigen::MatrixXd& full) {
  std::vector<Triplet> triplets;
  for (int j = 0; j < full.cols(); ++j)
    for (int i = 0; i < full.rows(); ++i)
      if (full(i, j) != 0) triplets.push_back({i, j, full(i, j)});
  return assemble(static_cast<int>(full.rows()), static_cast<int>(full.cols()), triplets);
}

inline Eigen::VectorXd random_vector(int size, Random& random) {
  Eigen::VectorXd x(size);
  for (double& value : x) value = random.uniform(-1, 1);
  return x;
}

/// About `per_row` entries in every row plus, for square matrices, a full diagonal.
inline Matrix random_matrix(int rows, int columns, int per_row, Random& random) {
  std::vector<Triplet> triplets;
  for (int i = 0; i < rows; ++i) {
    if (rows == columns) triplets.push_back({i, i, random.uniform(-1, 1)});
    for (int k = 0; k < per_row; ++k) triplets.push_back({i, random.below(columns), random.uniform(-1, 1)});
  }
  return assemble(rows, columns, triplets);
}

/// Jacobian of a driven chain of dyads (crank, then coupler + rocker, the rocker driving the next coupler): square,
/// 3 (1 + 2 dyads) columns, one block of at most six rows and columns for each dyad.
inline Matrix dyad_chain(int dyads, Random& random) {
  std::vector<Triplet> triplets;
  int row = 0;
  const auto arm = [&] { return random.uniform(0.2, 1.0) * (random.below(2) ? 1 : -1); };
  const auto joint = [&](int a, int b) {
    for (int axis = 0; axis < 2; ++axis, ++row) {
      for (int body : {a, b}) {
        if (body < 0) continue;
        const double sign = body == a ? 1 : -1;
        triplets.push_back({row, 3 * body + axis, sign});
        triplets.push_back({row, 3 * body + 2, sign * arm()});
      }
    }
  };
  triplets.push_back({row++, 2, 1.0});
  joint(0, -1);
  for (int k = 0; k < dyads; ++k) {
    const int previous = k == 0 ? 0 : 2 * k;
    joint(previous, 2 * k + 1);
    joint(2 * k + 1, 2 * k + 2);
    joint(2 * k + 2, -1);
  }
  return assemble(row, row, triplets);
}

/// |A x - b| relative to |A| |x|, the backward error.
inline double backward_error(const Eigen::MatrixXd& a, const Eigen::VectorXd& x, const Eigen::VectorXd& b) {
  return (a * x - b).lpNorm<Eigen::Infinity>() /
         (a.cwiseAbs().rowwise().sum().maxCoeff() * x.lpNorm<Eigen::Infinity>());
}

}  // namespace catena::testing
