// SpectrumDerivatives: complex omega2, of pairs that flutter under forces that have no energy. As in
// circulatory_derivatives.cpp, with complex vectors on both sides:
//
//   K v + Phi_q^T mu = z M v,   K^T w + Phi_q^T nu = z M w,   Phi_q v = Phi_q w = 0,   z = omega2 - i b
//   dz = [ w^T (K_p - z M_p) v + mu^T (Phi_q)_p w + nu^T (Phi_q)_p v ] / (w^T M v)
//
// w^T, not conjugated: what stands in brackets is bilinear in [v, mu] and [w, nu], and is put together from their real
// and imaginary parts. Both vectors come from inverse iteration beside z. Singular where the pair begins, w^T M v = 0.
// Units: 1/s^2. Source: Seyranian, Mailybaev, Multiparameter Stability Theory (2003), chapter 2.
#include <Eigen/SparseLU>
#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/sensitivity/spectrum/spectrum_derivatives.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

using Complex = std::complex<double>;
using ComplexMatrix = Eigen::SparseMatrix<Complex>;

/// K - z M with Phi_q over columns and rows of the plan, or its transpose; `mass` over both.
ComplexMatrix saddle_of(const Evaluator& evaluator, std::span<const double> jacobian, std::span<const double> lambda,
                        const Eigen::VectorXd& mass, Complex z, bool transpose) {
  const Plan& plan = evaluator.plan();
  std::vector<Eigen::Triplet<Complex>> entries;
  const auto add = [&](int i, int j, const ElementMatrix& m) {
    for (int r = 0; r < 6; ++r) {
      for (int c = 0; c < 6; ++c) {
        const int row = plan.column_of(i, j, r), column = plan.column_of(i, j, c);
        if (row < 0 || column < 0) continue;
        entries.emplace_back(transpose ? column : row, transpose ? row : column, Complex(m[at(6 * r + c)]));
      }
    }
  };
  const std::vector<double> rest(at(plan.coordinates()), 0.0);
  evaluator.visit_stiffness(rest, add);
  evaluator.visit_constraint_hessians(lambda, add);
  for (int c = 0; c < plan.columns; ++c) {
    entries.emplace_back(c, c, -z * mass(c));
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
      const int row = plan.columns + plan.jacobian.row_index[at(k)];
      entries.emplace_back(row, c, Complex(jacobian[at(k)]));
      entries.emplace_back(c, row, Complex(jacobian[at(k)]));
    }
  }
  ComplexMatrix matrix(plan.columns + plan.rows, plan.columns + plan.rows);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

/// [x; multipliers] of the eigenvector whose z the matrix lies beside; false where it does not settle.
bool find_vector(const ComplexMatrix& matrix, const Eigen::VectorXd& mass, int columns, Eigen::VectorXcd& x) {
  Eigen::SparseLU<ComplexMatrix> factors(matrix);
  if (factors.info() != Eigen::Success) return false;
  for (int round = 0; round < inverse_iteration::most_rounds; ++round) {
    Eigen::VectorXcd next = factors.solve(Eigen::VectorXcd(mass.cast<Complex>().cwiseProduct(x)));
    Eigen::Index largest = 0;
    const double size = next.head(columns).cwiseAbs().maxCoeff(&largest);
    if (!(size > 0) || !std::isfinite(size)) return false;
    next /= Complex(next(largest));
    const double change = (next - x).head(columns).cwiseAbs().maxCoeff();
    x = std::move(next);
    if (change <= thresholds::solved) return true;
  }
  return false;
}

/// Real or imaginary parts of [x; multipliers], over coordinates and rows.
struct Part {
  std::vector<double> x, multipliers;
  Part(const Plan& plan, const Eigen::VectorXd& of)
      : x(at(plan.coordinates()), 0.0), multipliers(of.data() + plan.columns, of.data() + of.size()) {
    for (int c = 0; c < plan.columns; ++c) x[at(plan.coordinate[at(c)])] = of(c);
  }
};

}  // namespace

std::optional<std::vector<Complex>> SpectrumDerivatives::gradient_of_pair(Complex z, std::span<const double> shape) {
  if (!knows_slopes()) return {};
  const int columns = plan().columns, size = columns + plan().rows;
  Eigen::VectorXd mass = Eigen::VectorXd::Zero(size);
  for (int c = 0; c < columns; ++c) mass(c) = groups().front().mechanism.mass(plan().coordinate[at(c)]).v;
  std::array<Eigen::VectorXcd, 2> both;  // [v; mu], [w; nu]
  for (const bool left : {false, true}) {
    Eigen::VectorXcd& x = both[left ? 1 : 0] = Eigen::VectorXcd::Zero(size);
    for (int c = 0; c < columns; ++c) x(c) = shape[at(c)];
    const ComplexMatrix matrix =
        saddle_of(evaluator(), jacobian(), lambda_, mass, z * (1 + inverse_iteration::beside), left);
    if (find_vector(matrix, mass, columns, x)) continue;
    fail("the vectors of a pair that flutters did not settle");
    return {};
  }
  const Eigen::VectorXcd weighed = mass.cast<Complex>().cwiseProduct(both[0]);
  const Complex scale = (both[1].transpose() * weighed)(0);
  if (!(std::abs(scale) > thresholds::no_overlap * both[1].head(columns).norm() * weighed.norm())) {
    fail("the pair begins to flutter here, where it has one vector and no derivative");
    return {};
  }
  const Part v[] = {{plan(), both[0].real()}, {plan(), both[0].imag()}},
             w[] = {{plan(), both[1].real()}, {plan(), both[1].imag()}};
  std::vector<Complex> gradient(at(parameters()));
  const auto add = [&](int left, int right, Complex weight) {
    const std::vector<double> part =
        slopes_of({v[right].x, v[right].multipliers, w[left].x, w[left].multipliers}, 0, 1);
    for (std::size_t p = 0; p < part.size(); ++p) gradient[p] += weight * part[p];
  };
  add(0, 0, 1);
  add(1, 1, -1);
  add(0, 1, Complex(0, 1));
  add(1, 0, Complex(0, 1));
  std::size_t first = 0;
  for (Group& group : groups()) {
    for (int c = 0; c < columns; ++c) {
      const Complex moved = z * both[1](c) * both[0](c);
      for (std::size_t p = 0; p < at(group.count); ++p)
        gradient[first + p] -= moved * group.mechanism.mass(plan().coordinate[at(c)]).d[p];
    }
    first += at(group.count);
  }
  for (Complex& slope : gradient) slope /= scale;
  return gradient;
}

}  // namespace catena
