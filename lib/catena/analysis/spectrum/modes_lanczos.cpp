#include "catena/analysis/spectrum/modes_lanczos.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/tridiagonal.hpp"

namespace catena {
namespace {

// Part of theta that a settled mode's residual may have, if it is above the rounding of the largest theta.
constexpr double settled_part = 1e-11;
// A vector that lost all but this of its length to orthogonality is rounding; one that lost much is put back into the
// null space, where its own rounding may have left it.
constexpr double lost_part = thresholds::carried_rounding, polluted_part = 1e-3;
// A start vector with no more than this outside the space found so far: the space is complete.
constexpr double nothing_new = 1e-7;
constexpr int steps_between_looks = 4;

double dot(std::span<const double> a, std::span<const double> b) {
  // Several lanes, so that the compiler may vectorise a sum whose order it must keep.
  double lanes[8] = {};
  std::size_t k = 0;
  for (; k + 8 <= a.size(); k += 8) {
    for (std::size_t l = 0; l < 8; ++l) lanes[l] += a[k + l] * b[k + l];
  }
  double sum = 0;
  for (; k < a.size(); ++k) sum += a[k] * b[k];
  for (double lane : lanes) sum += lane;
  return sum;
}

void add_scaled(double factor, std::span<const double> x, std::span<double> y) {
  for (std::size_t k = 0; k < y.size(); ++k) y[k] += factor * x[k];
}

}  // namespace

Lanczos::Lanczos(SpectralOperator& op, std::vector<std::vector<double>> locked)
    : op_(op), size_(static_cast<std::size_t>(op.columns())), locked_(std::move(locked)), work_(size_) {}

double Lanczos::length(const std::vector<double>& w) {
  op_.metric(w, work_);
  return std::sqrt(std::max(dot(w, work_), 0.0));
}

// `last`: gets the component along the newest basis vector.
void Lanczos::orthogonalise(std::vector<double>& w, double* last) {
  for (int pass = 0; pass < 2; ++pass) {
    op_.metric(w, work_);
    for (const auto* space : {&locked_, &basis_}) {
      for (const std::vector<double>& v : *space) {
        const double h = dot(work_, v);
        add_scaled(-h, v, w);
        if (last && !basis_.empty() && &v == &basis_.back()) *last += h;
      }
    }
  }
}

// A start without structure.
std::vector<double> Lanczos::random_vector() {
  const std::span<const double> typical = op_.typical();
  std::vector<double> v(size_);
  for (std::size_t k = 0; k < size_; ++k) {
    seed_ = seed_ * 1664525u + 1013904223u;
    v[k] = typical[k] * (static_cast<double>(seed_ >> 8) / (1 << 23) - 1);
  }
  return v;
}

bool Lanczos::begin_inverted() {
  std::vector<double> v = random_vector();
  op_.invert(v);
  const double one = length(v);
  if (!(one > 0) || !std::isfinite(one)) return false;
  for (double& x : v) x /= one;
  basis_.push_back(std::move(v));
  return true;
}

bool Lanczos::add_new_vector() {
  std::vector<double> v = random_vector();
  const double raw = length(v);
  op_.project(v);
  const double inside = length(v);
  if (!(inside > nothing_new * raw)) return false;
  orthogonalise(v, nullptr);
  const double left = length(v);
  if (!(left > nothing_new * inside) || !std::isfinite(left)) return false;
  for (double& x : v) x /= left;
  if (!clean(v)) return false;
  basis_.push_back(std::move(v));
  return true;
}

// Puts a vector of length 1 back into the null space; false if little of it lies there: then it was rounding.
bool Lanczos::clean(std::vector<double>& v) {
  op_.project(v);
  orthogonalise(v, nullptr);
  const double one = length(v);
  if (!(one > 0.5)) return false;
  for (double& x : v) x /= one;
  return true;
}

void Lanczos::find_spectrum() {
  TridiagonalSpectrum spectrum = tridiagonal_spectrum(alpha_, beta_);
  theta_ = std::move(spectrum.theta);
  coefficients_ = std::move(spectrum.vectors);
}

bool Lanczos::update_spectrum(const Choice& choose) {
  find_spectrum();
  const double largest = std::max(std::abs(theta_.front()), std::abs(theta_.back()));
  const std::vector<int> chosen = choose(theta_);
  for (int k : chosen) {
    const double residual =
        std::abs(beta_.back() * coefficients_[(static_cast<std::size_t>(k) + 1) * theta_.size() - 1]);
    if (residual >
        std::max(settled_part * std::abs(theta_[static_cast<std::size_t>(k)]), thresholds::sum_rounding * largest))
      return false;
  }
  return !chosen.empty();
}

bool Lanczos::advance(bool last) {
  std::vector<double> w = basis_.back();
  op_.invert(w);
  double along = 0;
  orthogonalise(w, &along);
  alpha_.push_back(along);
  double beta = length(w);
  scale_ = std::max({scale_, std::abs(along), beta});
  if (!std::isfinite(beta)) return false;
  if (beta <= lost_part * scale_) {
    beta = 0;
  } else if (!last) {
    for (double& x : w) x /= beta;
    if (beta <= polluted_part * scale_ && !clean(w)) {
      beta = 0;
    } else {
      basis_.push_back(std::move(w));
    }
  }
  beta_.push_back(beta);
  return true;
}

bool Lanczos::run(const Choice& choose, int most, const std::function<bool()>& go_on) {
  for (int next_look = 0; true;) {
    if (basis_.size() == alpha_.size() && !add_new_vector()) {
      exhausted_ = true;
      break;
    }
    const bool last = steps() + 1 >= most;
    if (!advance(last)) return false;
    if (last) break;
    if (steps() >= next_look) {
      if (update_spectrum(choose)) return true;
      next_look = steps() + steps_between_looks;
    }
    if (go_on && !go_on()) return false;
  }
  return !alpha_.empty() && update_spectrum(choose);
}

std::vector<double> Lanczos::combine(std::span<const double> coefficients) const {
  std::vector<double> v(size_, 0.0);
  for (std::size_t b = 0; b < coefficients.size(); ++b) add_scaled(coefficients[b], basis_[b], v);
  return v;
}

std::vector<double> Lanczos::vector(int k) const {
  const std::size_t n = theta_.size();
  return combine({coefficients_.data() + static_cast<std::size_t>(k) * n, n});
}

}  // namespace catena
