// A chain of uniform rods that falls from rest, in the least coordinates: what gradients of motions are held against,
// and what SUNDIALS is given.
//
//   a_ij = l_i l_j W_ij    W_ij = sum_k>j m_k + m_j / 2 (i < j),  sum_k>i m_k + m_i / 3 (i = j)
//   sum_j a_ij (cos(phi_i - phi_j) phidd_j + sin(phi_i - phi_j) phid_j^2) + g l_i cos(phi_i) (sum_k>i m_k + m_i / 2) =
//   0
//
// Start: angles 0.3 sin(k), k from 1. Measure: the mean height of all n rods' far ends, sum l_k sin(phi_k) (n - k + 1)
// / n. Parameters: all lengths, then all masses, at fixed angles of the start. Absolute angles, m, kg.
// The reference has derivatives by a step in the complex plane, in 64 bits, and the extrapolated midpoint rule of order
// 16: no code in common with the library. Source: J. Squire, G. Trapp, SIAM Review 40 (1998), for complex steps.
#pragma once

#include <array>
#include <cmath>
#include <complex>
#include <vector>

namespace bench {

inline constexpr double pendulum_gravity = 9.81;

/// Four of the parameters: the first and a middle length, and the masses of these rods.
inline constexpr int compared_parameters = 4;
inline std::array<int, compared_parameters> compared(int rods) { return {0, rods / 2, rods, rods + rods / 2}; }

inline double start_angle(std::size_t k) { return 0.3 * std::sin(static_cast<double>(k + 1)); }
/// How much the height of rod k counts, from 0.
inline double height_weight(std::size_t k, std::size_t rods) {
  return static_cast<double>(rods - k) / static_cast<double>(rods);
}

/// W and the moments of gravity of a chain with these masses, and its accelerations: by Cholesky.
template <class Real>
class PendulumChain {
 public:
  PendulumChain(std::vector<Real> length, std::vector<Real> mass) : length_(std::move(length)), mass_(std::move(mass)) {
    const std::size_t n = length_.size();
    beyond_.assign(n, Real(0));
    for (std::size_t k = n - 1; k-- > 0;) beyond_[k] = beyond_[k + 1] + mass_[k + 1];
    matrix_.resize(n * n);
    cosine_.resize(n);
    sine_.resize(n);
  }

  std::size_t rods() const { return length_.size(); }
  const std::vector<Real>& length() const { return length_; }
  const std::vector<Real>& mass() const { return mass_; }
  Real weight(std::size_t i, std::size_t j) const {
    const std::size_t k = std::max(i, j);
    return beyond_[k] + mass_[k] / Real(i == j ? 3 : 2);
  }
  Real lever(std::size_t i) const { return length_[i] * (beyond_[i] + mass_[i] / Real(2)); }

  /// Factors the matrix of masses at these angles.
  void factorize(const Real* angle) {
    const std::size_t n = rods();
    for (std::size_t i = 0; i < n; ++i) {
      using std::cos, std::sin;
      cosine_[i] = cos(angle[i]);
      sine_[i] = sin(angle[i]);
    }
    for (std::size_t j = 0; j < n; ++j) {
      for (std::size_t i = j; i < n; ++i) {
        Real sum = coupling(i, j) * cosine_of(i, j);
        for (std::size_t k = 0; k < j; ++k) sum -= matrix_[i * n + k] * matrix_[j * n + k];
        using std::sqrt;
        matrix_[i * n + j] = i == j ? sqrt(sum) : sum / matrix_[j * n + j];
      }
    }
  }
  void solve(Real* x) const {
    const std::size_t n = rods();
    for (std::size_t i = 0; i < n; ++i) {
      for (std::size_t k = 0; k < i; ++k) x[i] -= matrix_[i * n + k] * x[k];
      x[i] /= matrix_[i * n + i];
    }
    for (std::size_t i = n; i-- > 0;) {
      for (std::size_t k = i + 1; k < n; ++k) x[i] -= matrix_[k * n + i] * x[k];
      x[i] /= matrix_[i * n + i];
    }
  }
  /// At the angles that were factored.
  void accelerations(const Real* rate, Real* out) const {
    const std::size_t n = rods();
    for (std::size_t i = 0; i < n; ++i) {
      out[i] = -Real(pendulum_gravity) * lever(i) * cosine_[i];
      for (std::size_t j = 0; j < n; ++j) out[i] -= coupling(i, j) * sine_of(i, j) * rate[j] * rate[j];
    }
    solve(out);
  }

  Real coupling(std::size_t i, std::size_t j) const { return length_[i] * length_[j] * weight(i, j); }
  /// Of phi_i - phi_j.
  Real cosine_of(std::size_t i, std::size_t j) const { return cosine_[i] * cosine_[j] + sine_[i] * sine_[j]; }
  Real sine_of(std::size_t i, std::size_t j) const { return sine_[i] * cosine_[j] - cosine_[i] * sine_[j]; }
  Real cosine(std::size_t i) const { return cosine_[i]; }
  Real sine(std::size_t i) const { return sine_[i]; }

 private:
  std::vector<Real> length_, mass_, beyond_, matrix_, cosine_, sine_;
};

/// d(mean height)/d(parameter) after `duration` by the compared parameters of n rods of 1 m and 1 kg.
std::array<double, compared_parameters> pendulum_gradient(int rods, double duration);

/// The largest error of the compared ones, relative to the largest of them.
double gradient_error(const std::array<double, compared_parameters>& found,
                      const std::array<double, compared_parameters>& exact);

/// The problems that are compared: how many rods, and how long they fall.
struct PendulumProblem {
  int rods;
  double duration;
  const char* name;
};
inline constexpr std::array<PendulumProblem, 2> pendulum_problems{
    {{2, 2, "gradient of a double pendulum"}, {40, 1, "gradient of 40 rods that fall"}}};

}  // namespace bench
