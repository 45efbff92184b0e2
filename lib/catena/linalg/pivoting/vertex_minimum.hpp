// The least of a linear function over the corners of a polytope, again and again for other coefficients.
//
//   min a^T w    subject to  A w = b,  w >= 0       (the polytope is bounded and stays, a changes)
//
// The simplex method; each search goes on from the corner at which the last one ended, which mostly is the corner
// still. The first corner is one of nonnegative least squares, whose columns are independent. Rows of A may depend on
// each other. Dense: A of some hundred columns. Source: Nocedal and Wright, Numerical Optimization (2006), chapter 13.
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace catena {

class VertexMinimum {
 public:
  /// An empty polytope.
  VertexMinimum() = default;
  /// A: column by column, b.size() rows.
  VertexMinimum(std::span<const double> A, std::span<const double> b);

  bool empty() const { return !polytope_; }
  /// The least value for the coefficients a, not of an empty polytope; nothing where no corner was found to be the
  /// least. The search goes on from the last corner, of copies as well.
  std::optional<double> least(std::span<const double> a);
  /// Columns that are not zero at the corner of the last search, which found one.
  std::vector<std::size_t> support() const;

 private:
  struct Polytope;
  std::shared_ptr<Polytope> polytope_;  // with the corner of the last search; copies share it
};

}  // namespace catena
