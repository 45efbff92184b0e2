// Newton's method for the stages of a step of Radau, and the estimate of its error.
#include <algorithm>
#include <cmath>

#include "catena/analysis/dynamics/implicit/implicit_step.hpp"
#include "catena/analysis/dynamics/implicit/radau.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// Corrections that are foreseen to leave this many times what is allowed are not made.
constexpr double hopeless = 10;

}  // namespace

// The polynomial through the stages of the last step, beyond its end.
void Radau::predict(double h) {
  const std::size_t n2 = 2 * motion_.coordinates();
  if (!is_.has_stages) {
    for (auto& z : z_) std::fill(z.begin(), z.end(), 0.0);
    return;
  }
  const std::array<double, 3>& c = radau_tableau().c;
  const double last = last_h_, ratio = h / last;
  for (std::size_t i = 0; i < 3; ++i) {
    const double s = 1 + c[i] * ratio;
    // Weights of Z_j in the polynomial that is zero at 0, at s; less Z_3, the end.
    std::array<double, 3> weight{};
    for (std::size_t j = 0; j < 3; ++j) {
      weight[j] = s / c[j];
      for (std::size_t k = 0; k < 3; ++k) {
        if (k != j) weight[j] *= (s - c[k]) / (c[j] - c[k]);
      }
    }
    weight[2] -= 1;
    for (std::size_t k = 0; k < n2; ++k)
      z_[i][k] = weight[0] * last_z_[0][k] + weight[1] * last_z_[1][k] + weight[2] * last_z_[2][k];
  }
}

// Within the step, where its second stage is expected: what the matrix misses at the stages is half of what it would at
// one end. Multipliers are those of that place: the last evaluation may be of another one, or of a row.
bool Radau::linearize(double h) {
  const double t = is_.has_stages ? t_ + radau_tableau().c[1] * h : t_;
  std::copy(y_.begin(), y_.end(), y_stage_.begin());
  for (std::size_t k = 0; k < 2 * motion_.coordinates(); ++k) y_stage_[k] += z_[1][k];
  if (motion_.derivative(t, Side::after, y_stage_, error_) && matrix_.linearize(t, Side::after, y_stage_)) return true;
  return motion_.derivative(t_, Side::after, y_, error_) && matrix_.linearize(t_, Side::after, y_);
}

// The matrix for a step of this length.
bool Radau::prepare(double h) {
  if (is_.linearized && factored_h_ == h) return true;
  if (!is_.linearized) {
    if (!linearize(h)) return false;
    is_.linearized = is_.fresh = true;
  }
  const RadauTableau& table = radau_tableau();
  const std::complex<double> pair(table.pair_real / h, table.pair_imaginary / h);
  factored_h_ = matrix_.factorize(table.real / h) && matrix_.factorize(pair) ? h : 0;
  return factored_h_ > 0;
}

Radau::Newton Radau::solve_stages(double h) {
  // A step that may not be shortened is solved for as long as corrections become smaller, by a tenth of a digit each.
  const bool fixed = options_.fixed_step > 0;
  const int most = fixed ? 2 * thresholds::most_bisections : most_corrections;
  double before = 0, theta = 0;
  for (corrections_ = 1; corrections_ <= most; ++corrections_) {
    double change = 0;
    if (!correct(h, change)) return Newton::failed;
    if (corrections_ > 1) {
      const double ratio = change / before;
      theta = corrections_ == 2 ? ratio : std::sqrt(theta * ratio);
      if (!(theta < 1)) return Newton::slow;
      const double left = theta / (1 - theta) * change;
      if (left <= 1) {
        convergence_ = theta;
        return Newton::converged;
      }
      if (!fixed && left * std::pow(theta, most - corrections_ - 1) > hopeless) return Newton::slow;
    } else if (change <= keeps_matrix) {
      convergence_ = 0;
      return Newton::converged;
    }
    before = change;
  }
  return Newton::slow;
}

// One correction of all stages; `change`: the largest, in units of what may be left.
bool Radau::correct(double h, double& change) {
  const RadauTableau& table = radau_tableau();
  const std::size_t n2 = 2 * motion_.coordinates();
  for (std::size_t i = 0; i < 3; ++i) {
    std::copy(y_.begin(), y_.end(), y_stage_.begin());
    for (std::size_t k = 0; k < n2; ++k) y_stage_[k] += z_[i][k];
    const double t = i == 2 ? t_new_ : t_ + table.c[i] * h;
    if (!motion_.derivative(t, i == 2 ? Side::before : Side::after, y_stage_, f_[i])) return false;
  }
  for (std::size_t k = 0; k < n2; ++k) {
    std::array<double, 3> r{};
    for (std::size_t i = 0; i < 3; ++i) {
      r[i] = f_[i][k];
      for (std::size_t j = 0; j < 3; ++j) r[i] -= table.inverse[i][j] * z_[j][k] / h;
    }
    for (std::size_t i = 0; i < 3; ++i) {
      residual_[i][k] = 0;
      for (std::size_t j = 0; j < 3; ++j) residual_[i][k] += table.basis_inverse[i][j] * r[j];
    }
  }
  matrix_.solve(residual_[0]);
  matrix_.solve(residual_[1], residual_[2]);
  for (std::size_t k = 0; k < n2; ++k) {
    const std::array<double, 3> w{residual_[0][k], residual_[1][k], residual_[2][k]};
    for (std::size_t i = 0; i < 3; ++i) {
      residual_[i][k] = 0;
      for (std::size_t j = 0; j < 3; ++j) residual_[i][k] += table.basis[i][j] * w[j];
      z_[i][k] += residual_[i][k];
    }
  }
  change = 0;
  for (const std::vector<double>& part : residual_)
    change = std::max(change, size_of(part, h, implicit_step::left_part));
  return std::isfinite(change);
}

// The largest entry of a change of [q, qd], in units of `part` of the allowed error and of what rounding makes of it.
double Radau::size_of(std::span<const double> change, double h, double part) {
  const std::size_t n = motion_.coordinates();
  double largest = 0;
  for (std::size_t c = 0; c < motion_.moving(); ++c) {
    const auto unit = implicit_step::units(scale_, c, h, y_[n + c], part);
    const double v = unit.velocity > 0 ? change[n + c] / unit.velocity : 0, q = change[c] / unit.place;
    const double size = std::max(std::abs(v), std::abs(q));
    if (!(size <= largest)) {
      largest = size;
      culprit_ = static_cast<int>(c);
    }
  }
  return largest;
}

double Radau::error_of_step(double h) {
  const std::array<double, 3>& weight = radau_tableau().error;
  const std::size_t n2 = 2 * motion_.coordinates();
  const auto estimate = [&](std::span<const double> slope) {
    for (std::size_t k = 0; k < n2; ++k)
      error_[k] = slope[k] + (weight[0] * z_[0][k] + weight[1] * z_[1][k] + weight[2] * z_[2][k]) / h;
    matrix_.solve(std::span(error_).first(n2));
    return size_of(std::span(error_).first(n2), h, 1);
  };
  const double size = estimate(slope_);
  if (size < 1 || !(is_.first || is_.rejected)) return size;
  // Beside a fast transient f(y) is that of a state which the motion has left: once more from where the error leads.
  std::copy(y_.begin(), y_.end(), y_stage_.begin());
  for (std::size_t k = 0; k < n2; ++k) y_stage_[k] += error_[k];
  if (!motion_.derivative(t_, Side::after, y_stage_, y_new_)) return size;
  return estimate(y_new_);
}

void Radau::sum_up_work(double h) {
  const RadauTableau& table = radau_tableau();
  for (std::size_t k = 2 * motion_.coordinates(); k < y_.size(); ++k) {
    for (std::size_t i = 0; i < 3; ++i)
      z_[i][k] = h * (table.a[i][0] * f_[0][k] + table.a[i][1] * f_[1][k] + table.a[i][2] * f_[2][k]);
  }
}

// The same estimate of the work of loads and of what dampers take, which have no part in J; of drivers as
// RungeKutta::error_of_work asks.
double Radau::error_of_work(double h) const {
  const RadauTableau& table = radau_tableau();
  const std::span<const double> end(f_[2]);
  const std::size_t usual = ErrorScale::judged(motion_.works()).size();
  double largest = 0;
  for (std::size_t place = 0; place < judged_works(); ++place) {
    const std::size_t k = 2 * motion_.coordinates() + place;
    double error = h * slope_[k];
    for (std::size_t i = 0; i < 3; ++i) error += table.error[i] * z_[i][k];
    error = std::abs(error) / table.real;
    const bool bends = place < usual ? switches_.laws : switches_.any();
    if (bends) error = std::max(error, ErrorScale::error_of_switch(h, slope_[k], f_[2][k], z_[2][k]));
    largest = std::max(largest, scale_.size_of_work(error, {h, y_[k], y_[k] + z_[2][k]},
                                                    motion_.equations().applied_forces(), motion_.qd(end)));
  }
  return largest;
}

}  // namespace catena
