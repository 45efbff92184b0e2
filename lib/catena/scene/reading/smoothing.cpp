#include "catena/scene/reading/smoothing.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace catena {
namespace {

using Matrix = Eigen::SparseMatrix<double>;
using Vector = Eigen::VectorXd;

// The misfit is met to this part: the curve's shape follows it with a power below one.
constexpr double enough = 1e-10;
// Halvings after which the logarithm of the bracket's ends, 138 at first, is rounding.
constexpr int most_halvings = 60;
constexpr double widest = 1e30;

/// Of n knots: R (m x m) and Q (n x m); m = n - 2 inner knots, or all n of a closed curve.
struct SplineMatrices {
  Matrix r, q;

  SplineMatrices(std::span<const double> h, int n, bool periodic) {
    const int m = periodic ? n : n - 2;
    std::vector<Eigen::Triplet<double>> of_r, of_q;
    for (int k = 0; k < m; ++k) {
      const int left = k, here = periodic ? (k + 1) % n : k + 1, right = periodic ? (k + 2) % n : k + 2;
      const double a = h[static_cast<std::size_t>(k)];
      const double b = h[static_cast<std::size_t>(periodic ? (k + 1) % n : k + 1)];
      of_q.emplace_back(left, k, 1 / a);
      of_q.emplace_back(here, k, -1 / a - 1 / b);
      of_q.emplace_back(right, k, 1 / b);
      of_r.emplace_back(k, k, (a + b) / 3);
      if (periodic || k + 1 < m) {
        of_r.emplace_back(k, (k + 1) % m, b / 6);
        of_r.emplace_back((k + 1) % m, k, b / 6);
      }
    }
    r.resize(m, m);
    q.resize(n, m);
    r.setFromTriplets(of_r.begin(), of_r.end());
    q.setFromTriplets(of_q.begin(), of_q.end());
  }
};

void check(std::span<const double> knots, std::span<const std::vector<double>> columns, bool periodic) {
  if (knots.size() < 3) throw std::invalid_argument("smoothing needs at least 3 points");
  for (std::size_t k = 0; k < knots.size(); ++k) {
    if (!std::isfinite(knots[k]) || (k > 0 && !(knots[k] > knots[k - 1])))
      throw std::invalid_argument("smoothing needs places that increase");
  }
  for (const std::vector<double>& column : columns) {
    if (column.size() != knots.size()) throw std::invalid_argument("smoothing needs as many values as places");
    for (const double value : column) {
      if (!std::isfinite(value)) throw std::invalid_argument("smoothing needs finite values");
    }
    if (periodic && column.front() != column.back())
      throw std::invalid_argument("a periodic table must end with the value it begins with");
  }
}

}  // namespace

Smoothed smooth_values(std::span<const double> knots, std::span<const std::vector<double>> columns, double rms,
                       bool periodic) {
  check(knots, columns, periodic);
  Smoothed result;
  result.values.assign(columns.begin(), columns.end());
  const auto n = static_cast<int>(knots.size()) - (periodic ? 1 : 0);
  if (!(rms > 0) || n < 3) return result;
  // In units of the mean distance, so that weights are about one.
  const double unit = (knots.back() - knots.front()) / static_cast<double>(knots.size() - 1);
  std::vector<double> h;
  for (std::size_t k = 1; k < knots.size(); ++k) h.push_back((knots[k] - knots[k - 1]) / unit);
  const SplineMatrices spline(h, n, periodic);
  const Matrix square = Matrix(spline.q.transpose() * spline.q);
  std::vector<Vector> given;
  for (const std::vector<double>& column : columns) given.emplace_back(Eigen::Map<const Vector>(column.data(), n));
  std::vector<Vector> moved(given.size());
  Eigen::SimplicialLDLT<Matrix> factors;
  factors.analyzePattern(Matrix(spline.r + square));
  const auto misfit = [&](double weight) {
    // Divided by 1 + weight, so that neither end of the scale overflows.
    factors.factorize(Matrix(spline.r / (1 + weight) + square * (weight / (1 + weight))));
    double sum = 0;
    for (std::size_t c = 0; c < given.size(); ++c) {
      const Vector bend = factors.solve(Vector(spline.q.transpose() * given[c]));
      moved[c] = spline.q * bend * (weight / (1 + weight));
      sum += moved[c].squaredNorm();
    }
    return std::sqrt(sum / n);
  };
  double low = 1 / widest, high = widest;
  if (misfit(high) > rms) {
    for (int k = 0; k < most_halvings; ++k) {
      const double middle = std::sqrt(low) * std::sqrt(high), there = misfit(middle);
      if (std::abs(there - rms) <= enough * rms) break;
      (there < rms ? low : high) = middle;
    }
  }
  double sum = 0;
  for (int k = 0; k < n; ++k) {
    double distance = 0;
    for (std::size_t c = 0; c < given.size(); ++c) {
      result.values[c][static_cast<std::size_t>(k)] -= moved[c][k];
      distance += moved[c][k] * moved[c][k];
    }
    sum += distance;
    if (std::sqrt(distance) > result.largest) {
      result.largest = std::sqrt(distance);
      result.worst = static_cast<std::size_t>(k);
    }
  }
  result.rms = std::sqrt(sum / n);
  if (periodic) {
    for (std::vector<double>& column : result.values) column.back() = column.front();
  }
  return result;
}

}  // namespace catena
