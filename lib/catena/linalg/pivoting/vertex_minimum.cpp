#include "catena/linalg/pivoting/vertex_minimum.hpp"

#include <Eigen/LU>
#include <Eigen/QR>
#include <algorithm>
#include <limits>

#include "catena/linalg/rank/nonnegative_least_squares.hpp"

namespace catena {
namespace {

// Of entries of size one: what depends on others, or is zero but for rounding.
constexpr double nothing_left = 1e-9;
// Of the coefficients: a slope that is zero but for rounding.
constexpr double flat = 1e-12;
// Steps by the steepest slope before the least index is taken, which cannot go in circles.
constexpr int steepest_steps = 50;
constexpr int most_steps = 2000;

using Index = Eigen::Index;

template <class V>
auto spanned(V& of) {
  return std::span(of.data(), static_cast<std::size_t>(of.size()));
}

}  // namespace

struct VertexMinimum::Polytope {
  Eigen::MatrixXd A;  // rows that do not depend on each other, turned
  Eigen::VectorXd b;
  std::vector<Index> basis;  // where the last search ended
  Eigen::MatrixXd inverse;   // of the columns of the basis
  Eigen::VectorXd weight;    // of the basis

  bool turn(const Eigen::MatrixXd& rows, const Eigen::VectorXd& right);
  bool find_corner();
  void complete_basis(const Eigen::VectorXd& corner);
  void factorize();
  Index entering(const Eigen::VectorXd& cost, int step) const;
  Index leaving(Index enters) const;
  double value(const Eigen::VectorXd& cost) const { return cost(basis).dot(weight); }
};

// False: rows contradict each other.
bool VertexMinimum::Polytope::turn(const Eigen::MatrixXd& rows, const Eigen::VectorXd& right) {
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors;
  factors.setThreshold(nothing_left);
  const Index rank = factors.compute(rows).rank();
  const Eigen::MatrixXd turned = factors.householderQ().transpose() * rows;
  const Eigen::VectorXd turned_right = factors.householderQ().transpose() * right;
  A = turned.topRows(rank);
  b = turned_right.head(rank);
  return rank > 0 && turned_right.tail(right.size() - rank).norm() <= nothing_left * right.norm();
}

// False: there is none.
bool VertexMinimum::Polytope::find_corner() {
  const Eigen::VectorXd opposite = -b;
  Eigen::VectorXd corner(A.cols());
  if (nonnegative_least_squares(spanned(A), spanned(opposite), spanned(corner)) > nothing_left * b.norm()) return false;
  complete_basis(corner);
  factorize();
  return true;
}

// Of the columns that a corner uses, and of others that do not depend on these, as many as there are rows.
void VertexMinimum::Polytope::complete_basis(const Eigen::VectorXd& corner) {
  Eigen::MatrixXd left = A;  // what columns have beside the chosen ones
  const auto take = [&](Index c) {
    const Eigen::VectorXd along = left.col(c).normalized();
    left -= along * (along.transpose() * left);
    basis.push_back(c);
  };
  for (Index c = 0; c < corner.size(); ++c) {
    if (corner(c) > 0) take(c);
  }
  while (static_cast<Index>(basis.size()) < A.rows()) {
    Index largest = 0;
    left.colwise().norm().maxCoeff(&largest);
    take(largest);
  }
}

void VertexMinimum::Polytope::factorize() {
  inverse = A(Eigen::all, basis).partialPivLu().inverse();
  weight = inverse * b;
}

// A column along which the value falls; -1: there is none.
Index VertexMinimum::Polytope::entering(const Eigen::VectorXd& cost, int step) const {
  const Eigen::RowVectorXd price = cost(basis).transpose() * inverse;
  const Eigen::RowVectorXd slope = cost.transpose() - price * A;
  const double rounding = flat * cost.lpNorm<Eigen::Infinity>();
  Index enters = -1;
  for (Index c = 0; c < slope.size() && (step < steepest_steps || enters < 0); ++c) {
    if (slope(c) < -rounding && (enters < 0 || slope(c) < slope(enters))) enters = c;
  }
  return enters;
}

// The place in the basis of what becomes zero first; of several the one of the least index.
Index VertexMinimum::Polytope::leaving(Index enters) const {
  const Eigen::VectorXd falls = inverse * A.col(enters);
  Index leaves = -1;
  double least = std::numeric_limits<double>::infinity();
  for (Index r = 0; r < falls.size(); ++r) {
    if (!(falls(r) > nothing_left)) continue;
    const double ratio = std::max(weight(r), 0.0) / falls(r);
    const auto index = [&](Index row) { return basis[static_cast<std::size_t>(row)]; };
    if (ratio < least || (ratio == least && index(r) < index(leaves))) least = ratio, leaves = r;
  }
  return leaves;
}

VertexMinimum::VertexMinimum(std::span<const double> A, std::span<const double> b) {
  const auto rows = static_cast<Index>(b.size()),
             columns = static_cast<Index>(A.size() / std::max<std::size_t>(b.size(), 1));
  auto polytope = std::make_shared<Polytope>();
  if (polytope->turn(Eigen::Map<const Eigen::MatrixXd>(A.data(), rows, columns),
                     Eigen::Map<const Eigen::VectorXd>(b.data(), rows)) &&
      polytope->find_corner())
    polytope_ = std::move(polytope);
}

std::optional<double> VertexMinimum::least(std::span<const double> a) {
  Polytope& p = *polytope_;
  const Eigen::VectorXd cost = Eigen::Map<const Eigen::VectorXd>(a.data(), static_cast<Index>(a.size()));
  for (int step = 0; step < most_steps; ++step) {
    const Index enters = p.entering(cost, step);
    const Index leaves = enters < 0 ? -1 : p.leaving(enters);
    if (leaves < 0) return p.value(cost);
    p.basis[static_cast<std::size_t>(leaves)] = enters;
    p.factorize();
  }
  return {};
}

std::vector<std::size_t> VertexMinimum::support() const {
  std::vector<std::size_t> columns;
  for (Index r = 0; r < polytope_->weight.size(); ++r) {
    const Index column = polytope_->basis[static_cast<std::size_t>(r)];
    if (polytope_->weight(r) > nothing_left) columns.push_back(static_cast<std::size_t>(column));
  }
  return columns;
}

}  // namespace catena
