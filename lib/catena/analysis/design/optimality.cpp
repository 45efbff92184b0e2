#include <algorithm>
#include <cmath>

#include "catena/analysis/design/design_problem.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

double norm(const std::vector<double>& v) {
  double sum = 0;
  for (const double x : v) sum += x * x;
  return std::sqrt(sum);
}

/// Solves the small symmetric system A x = b by elimination with pivots on the diagonal; what depends on the rest gets
/// zero.
std::vector<double> solve_symmetric(std::vector<std::vector<double>> a, std::vector<double> b) {
  const std::size_t n = b.size();
  std::vector<char> used(n, 0);
  std::vector<std::size_t> order;
  double largest = 0;
  for (std::size_t k = 0; k < n; ++k) largest = std::max(largest, a[k][k]);
  for (std::size_t step = 0; step < n; ++step) {
    std::size_t pivot = n;
    for (std::size_t k = 0; k < n; ++k) {
      if (!used[k] && a[k][k] > 1e-12 * largest && (pivot == n || a[k][k] > a[pivot][pivot])) pivot = k;
    }
    if (pivot == n) break;
    used[pivot] = 1;
    order.push_back(pivot);
    for (std::size_t k = 0; k < n; ++k) {
      if (used[k] || a[k][pivot] == 0) continue;
      const double factor = a[k][pivot] / a[pivot][pivot];
      for (std::size_t j = 0; j < n; ++j) a[k][j] -= factor * a[pivot][j];
      b[k] -= factor * b[pivot];
    }
  }
  std::vector<double> x(n, 0.0);
  for (std::size_t i = order.size(); i-- > 0;) {
    const std::size_t k = order[i];
    double rest = b[k];
    for (std::size_t j = i + 1; j < order.size(); ++j) rest -= a[k][order[j]] * x[order[j]];
    x[k] = rest / a[k][k];
  }
  return x;
}

/// A limit that may hold the design: its gradient, and whether its multiplier may have either sign.
struct Limit {
  std::vector<double> gradient;
  bool equation = false;
  int unequal = -1;
};

/// Multipliers of least residual: of least squares, those of inequalities that come out negative dropped one by one.
std::vector<double> multipliers_of(const std::vector<double>& gradient, const std::vector<Limit>& limits) {
  std::vector<char> held(limits.size(), 1);
  std::vector<double> mu;
  for (std::size_t round = 0; round <= limits.size(); ++round) {
    std::vector<std::size_t> in;
    for (std::size_t k = 0; k < limits.size(); ++k) {
      if (held[k]) in.push_back(k);
    }
    std::vector<std::vector<double>> a(in.size(), std::vector<double>(in.size(), 0.0));
    std::vector<double> b(in.size(), 0.0);
    for (std::size_t r = 0; r < in.size(); ++r) {
      for (std::size_t v = 0; v < gradient.size(); ++v) {
        b[r] -= limits[in[r]].gradient[v] * gradient[v];
        for (std::size_t c = 0; c < in.size(); ++c) a[r][c] += limits[in[r]].gradient[v] * limits[in[c]].gradient[v];
      }
    }
    const std::vector<double> found = solve_symmetric(std::move(a), std::move(b));
    mu.assign(limits.size(), 0.0);
    std::size_t worst = limits.size();
    for (std::size_t r = 0; r < in.size(); ++r) {
      mu[in[r]] = found[r];
      if (!limits[in[r]].equation && found[r] < 0 && (worst == limits.size() || found[r] < mu[worst])) worst = in[r];
    }
    if (worst == limits.size()) break;
    held[worst] = 0;
  }
  return mu;
}

}  // namespace

Stationarity optimality_of(const DesignProblem& problem, std::span<const double> x, const DesignValues& values,
                           std::span<const double> unequal_size, double size) {
  const std::size_t n = x.size();
  const auto scaled = [&](const std::vector<double>& gradients, std::size_t row) {
    std::vector<double> gradient(n);
    for (std::size_t v = 0; v < n; ++v) gradient[v] = gradients[row * n + v] * (problem.upper[v] - problem.lower[v]);
    return gradient;
  };
  const std::vector<double> gradient = scaled(values.gradient, 0);
  std::vector<Limit> limits;
  for (std::size_t k = 0; k < values.unequal.size(); ++k) {
    if (values.unequal[k] >= -thresholds::same_value * unequal_size[k])
      limits.push_back({scaled(values.unequal_gradient, k), false, static_cast<int>(k)});
  }
  for (std::size_t k = 0; k < values.equal.size(); ++k) limits.push_back({scaled(values.equal_gradient, k), true});
  for (std::size_t v = 0; v < n; ++v) {
    const double part = (x[v] - problem.lower[v]) / (problem.upper[v] - problem.lower[v]);
    if (part > thresholds::same_value && part < 1 - thresholds::same_value) continue;
    std::vector<double> bound(n, 0.0);
    bound[v] = part <= thresholds::same_value ? -1 : 1;
    limits.push_back({std::move(bound)});
  }
  const std::vector<double> mu = multipliers_of(gradient, limits);
  std::vector<double> rest = gradient;
  double largest = std::max(norm(gradient), size);
  Stationarity result;
  for (std::size_t k = 0; k < limits.size(); ++k) {
    for (std::size_t v = 0; v < n; ++v) rest[v] += mu[k] * limits[k].gradient[v];
    largest = std::max(largest, std::abs(mu[k]) * norm(limits[k].gradient));
    if (limits[k].unequal >= 0) result.active_unequal.push_back(limits[k].unequal);
  }
  result.optimality = largest > 0 ? norm(rest) / largest : 0;
  result.rest = std::move(rest);
  return result;
}

}  // namespace catena
