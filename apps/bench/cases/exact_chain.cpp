#include "cases/exact_chain.hpp"

#include <cmath>

namespace bench {

using Real = long double;
using Vector = catena::Vec2<Real>;

namespace {

constexpr Real chain_gravity = 9.81L;

/// A symmetric 2 x 2 matrix a I + b n n^T has three entries; products of two of them are not symmetric.
struct Matrix {
  Real xx = 0, xy = 0, yx = 0, yy = 0;

  Vector operator*(const Vector& v) const { return {xx * v.x + xy * v.y, yx * v.x + yy * v.y}; }
  Matrix operator*(const Matrix& m) const {
    return {xx * m.xx + xy * m.yx, xx * m.xy + xy * m.yy, yx * m.xx + yy * m.yx, yx * m.xy + yy * m.yy};
  }
  Matrix operator-(const Matrix& m) const { return {xx - m.xx, xy - m.xy, yx - m.yx, yy - m.yy}; }
  Matrix inverse() const {
    const Real d = xx * yy - xy * yx;
    return {yy / d, -xy / d, -yx / d, xx / d};
  }
};

Matrix diagonal_and(Real a, Real b, const Vector& n) {
  return {a + b * n.x * n.x, b * n.x * n.y, b * n.x * n.y, a + b * n.y * n.y};
}

}  // namespace

std::vector<Real> ExactChain::solve(Vector& tip) const {
  const std::size_t n = angle.size();
  std::vector<Vector> u(n), across(n), force(n + 1);
  for (std::size_t k = 0; k < n; ++k) {
    u[k] = {std::cos(angle[k]), std::sin(angle[k])};
    across[k] = {-u[k].y, u[k].x};
  }
  // Elimination from the first pin on: F_k = held[k] - next[k] F_k+1.
  std::vector<Matrix> next(n);
  std::vector<Vector> held(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Matrix upper = diagonal_and(-1, 3, across[k]);
    Matrix here = diagonal_and(1, 3, across[k]);
    Vector right = Real(-0.5L) * rate[k] * rate[k] * u[k];
    if (k == 0) {
      right += Vector{0, chain_gravity};
    } else {
      const Matrix lower = diagonal_and(-1, 3, across[k - 1]), before = diagonal_and(1, 3, across[k - 1]);
      const Matrix carried = lower * next[k - 1];
      here = Matrix{here.xx + before.xx, here.xy + before.xy, here.yx + before.yx, here.yy + before.yy} - carried;
      right += Real(-0.5L) * rate[k - 1] * rate[k - 1] * u[k - 1];
      right = right - lower * held[k - 1];
    }
    const Matrix inverse = here.inverse();
    next[k] = inverse * upper;
    held[k] = inverse * right;
  }
  if (tail > 0) {
    // F_n-1 = held - next F_n with F_n = pull F_n-1.
    const Matrix pull{static_cast<Real>(tail) / (tail + 1), 0, 0, 0}, carried = next[n - 1] * pull;
    const Vector last = Matrix{1 + carried.xx, carried.xy, carried.yx, 1 + carried.yy}.inverse() * held[n - 1];
    force[n] = pull * last;
  }
  for (std::size_t k = n; k-- > 0;) force[k] = held[k] - next[k] * force[k + 1];
  std::vector<Real> alpha(n);
  for (std::size_t k = 0; k < n; ++k) {
    const Vector sum = force[k] + force[k + 1];
    alpha[k] = -6 * (across[k].x * sum.x + across[k].y * sum.y);
  }
  const std::size_t last = n - 1;
  tip = force[last] - Vector{0, chain_gravity} + Real(0.5L) * alpha[last] * across[last] -
        Real(0.5L) * rate[last] * rate[last] * u[last];
  return alpha;
}

std::vector<Real> ExactChain::angular_accelerations() const {
  Vector tip;
  return solve(tip);
}

Vector ExactChain::tip_acceleration() const {
  Vector tip;
  solve(tip);
  return tip;
}

void ExactChain::move(Real duration, int steps) {
  constexpr std::size_t levels = 8;  // order 16
  const std::size_t n = angle.size();
  const Real step = duration / steps;
  using Values = std::vector<Real>;
  for (int s = 0; s < steps; ++s) {
    std::vector<Values> previous, current;
    for (std::size_t level = 0; level < levels; ++level) {
      // y = (angles, rates); midpoint rule from one Euler step: y_m+1 = y_m-1 + 2 h f(y_m).
      const int parts = 2 * (static_cast<int>(level) + 1);
      const Real h = step / parts;
      ExactChain before = *this, here = *this;
      Values slope = angular_accelerations();
      for (std::size_t k = 0; k < n; ++k) here.angle[k] += h * rate[k], here.rate[k] += h * slope[k];
      for (int m = 1; m < parts; ++m) {
        slope = here.angular_accelerations();
        for (std::size_t k = 0; k < n; ++k) {
          const Real a = before.angle[k] + 2 * h * here.rate[k], w = before.rate[k] + 2 * h * slope[k];
          before.angle[k] = here.angle[k], before.rate[k] = here.rate[k];
          here.angle[k] = a, here.rate[k] = w;
        }
      }
      Values row = here.angle;
      row.insert(row.end(), here.rate.begin(), here.rate.end());
      current.assign(1, std::move(row));
      for (std::size_t k = 0; k < level; ++k) {
        const Real ratio = static_cast<Real>(level + 1) / static_cast<Real>(level - k);
        Values better = current[k];
        for (std::size_t i = 0; i < better.size(); ++i)
          better[i] += (current[k][i] - previous[k][i]) / (ratio * ratio - 1);
        current.push_back(std::move(better));
      }
      previous = current;
    }
    for (std::size_t k = 0; k < n; ++k) angle[k] = previous.back()[k], rate[k] = previous.back()[n + k];
  }
}

std::vector<Vector> ExactChain::ends() const {
  std::vector<Vector> places;
  Vector end{};
  for (const Real phi : angle) places.push_back(end += Vector{std::cos(phi), std::sin(phi)});
  return places;
}

std::vector<Vector> ends_at_rest(int n, Real span) {
  const auto tangent = [n](Real rate, int k) { return rate * (k - 0.5L * (n - 1)); };
  Real low = 0, high = 1e3L;
  for (int halving = 0; halving < 200; ++halving) {
    const Real middle = 0.5L * (low + high);
    Real reach = 0;
    for (int k = 0; k < n; ++k) reach += 1 / std::hypot(1.0L, tangent(middle, k));
    (reach > span * n ? low : high) = middle;
  }
  std::vector<Vector> places;
  Vector end{};
  for (int k = 0; k < n; ++k) {
    const Real t = tangent(low, k), length = std::hypot(1.0L, t);
    places.push_back(end += Vector{1 / length, t / length});
  }
  return places;
}

}  // namespace bench
