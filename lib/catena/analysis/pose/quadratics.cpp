#include "catena/analysis/pose/quadratics.hpp"

#include <algorithm>
#include <cmath>
#include <random>

namespace catena {
namespace {

// Of their size: roots that are nearer to each other are one.
constexpr double same_root = 1e-3;
// As many as six quadrics can have.
constexpr std::size_t most_roots = 64;
constexpr int starts_per_root = 40;
constexpr int most_iterations = 60;

double square_sum(std::span<const double> x) {
  double sum = 0;
  for (double value : x) sum += value * value;
  return sum;
}

/// Solves (J^T J + damping I) x = -J^T f by elimination with pivots; J has k columns.
std::vector<double> damped_step(const std::vector<double>& jacobian, const std::vector<double>& f, std::size_t k,
                                double damping) {
  std::vector<double> m(k * (k + 1), 0.0);
  for (std::size_t r = 0; r < k; ++r) {
    for (std::size_t c = 0; c < k; ++c) {
      for (std::size_t i = 0; i < f.size(); ++i) m[r * (k + 1) + c] += jacobian[i * k + r] * jacobian[i * k + c];
    }
    m[r * (k + 1) + r] += damping;
    for (std::size_t i = 0; i < f.size(); ++i) m[r * (k + 1) + k] -= jacobian[i * k + r] * f[i];
  }
  for (std::size_t p = 0; p < k; ++p) {
    std::size_t best = p;
    for (std::size_t r = p + 1; r < k; ++r) {
      if (std::abs(m[r * (k + 1) + p]) > std::abs(m[best * (k + 1) + p])) best = r;
    }
    for (std::size_t c = 0; c <= k; ++c) std::swap(m[p * (k + 1) + c], m[best * (k + 1) + c]);
    for (std::size_t r = 0; r < k; ++r) {
      if (r == p) continue;
      const double factor = m[r * (k + 1) + p] / m[p * (k + 1) + p];
      for (std::size_t c = p; c <= k; ++c) m[r * (k + 1) + c] -= factor * m[p * (k + 1) + c];
    }
  }
  std::vector<double> x(k);
  for (std::size_t r = 0; r < k; ++r) x[r] = m[r * (k + 1) + k] / m[r * (k + 1) + r];
  return x;
}

/// Levenberg-Marquardt from `a`; true at a root.
bool solve_from(const Quadratics& system, std::vector<double>& a) {
  std::vector<double> f, jacobian, trial, trial_f, trial_jacobian;
  system.evaluate(a, f, jacobian);
  double now = square_sum(f), damping = 1e-6;
  for (int iteration = 0; iteration < most_iterations && now > 1e-30; ++iteration) {
    const std::vector<double> step = damped_step(jacobian, f, system.k, damping);
    trial = a;
    for (std::size_t j = 0; j < system.k; ++j) trial[j] += step[j];
    system.evaluate(trial, trial_f, trial_jacobian);
    const double then = square_sum(trial_f);
    if (!(then < now)) {
      damping = std::max(10 * damping, 1e-12);
      if (damping > 1e6) break;
      continue;
    }
    damping /= 10;
    a = trial;
    f = trial_f;
    jacobian = trial_jacobian;
    now = then;
  }
  return now < Quadratics::vanishing * Quadratics::vanishing;
}

}  // namespace

void Quadratics::evaluate(std::span<const double> a, std::vector<double>& f, std::vector<double>& jacobian) const {
  f.assign(constant.size(), 0);
  jacobian.assign(constant.size() * k, 0);
  for (std::size_t i = 0; i < constant.size(); ++i) {
    f[i] = constant[i];
    for (std::size_t j = 0; j < k; ++j) {
      double row = 0;
      for (std::size_t l = 0; l < k; ++l) row += quadratic[i][j * k + l] * a[l];
      f[i] += a[j] * (linear[i][j] + row);
      jacobian[i * k + j] = linear[i][j] + 2 * row;
    }
  }
}

std::vector<std::vector<double>> real_roots(const Quadratics& system, const std::vector<double>& first) {
  std::vector<std::vector<double>> roots;
  if (!first.empty()) roots.push_back(first);
  const auto distance = [](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t j = 0; j < a.size(); ++j) sum += (a[j] - b[j]) * (a[j] - b[j]);
    return std::sqrt(sum);
  };
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const int starts = starts_per_root << system.k;
  for (int s = 0; s < starts && roots.size() < most_roots; ++s) {
    std::vector<double> a(system.k);
    const double reach = std::exp(1.5 * normal(random));
    for (double& value : a) value = reach * normal(random);
    if (!solve_from(system, a)) continue;
    const double size = 1 + std::sqrt(square_sum(a));
    const bool known =
        std::any_of(roots.begin(), roots.end(), [&](const auto& root) { return distance(root, a) < same_root * size; });
    if (!known && size < 1e6) roots.push_back(a);
  }
  if (roots.empty()) return roots;
  const std::vector<double> origin = first.empty() ? std::vector<double>(system.k, 0.0) : first;
  std::stable_sort(roots.begin(), roots.end(),
                   [&](const auto& a, const auto& b) { return distance(a, origin) < distance(b, origin); });
  return roots;
}

}  // namespace catena
