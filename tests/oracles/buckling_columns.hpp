// Columns of rods and torsion springs under loads that depend on the parameter in any way, and their buckling loads
// from dense algebra and a scalar equation of their own.
//
//   N rods standing on each other, springs c_k at the joints, weights w_k(p) on top of every rod:
//   K(p) = C - sum over rods  diag(l_k W_k(p)),   W_k = what stands on rod k         stiffness in the rods' angles
//   all weights share one law w_k(p) = w_k f(p): K = C - f D, singular at the eigenvalues f_i of (C, D);  f(p) = f_i
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "catena/analysis/stability/buckling.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/forces/point_force.hpp"
#include "catena/elements/forces/torsion_spring.hpp"
#include "catena/model/model_add.hpp"
#include "references/dense.hpp"

namespace catena::testing {

class BucklingColumn {
  using Real = long double;

 public:
  explicit BucklingColumn(unsigned seed) {
    std::mt19937 random(seed);
    const auto uniform = [&](double a, double b) { return std::uniform_real_distribution<double>(a, b)(random); };
    length_ = std::pow(10.0, uniform(-9, 9));
    stiffness_ = std::pow(10.0, uniform(-9, 9));
    unit_ = std::pow(10.0, uniform(-6, 6));
    const int n = 1 + static_cast<int>(random() % 6);
    for (int k = 0; k < n; ++k) {
      lengths_.push_back(uniform(0.3, 2));
      springs_.push_back(uniform(0.5, 3));
      weights_.push_back(uniform(0.2, 1));
    }
    law_ = static_cast<int>(random() % 6);
    present_ = law_ == 0 || law_ == 4 ? 0 : uniform(0.05, 0.3);
  }

  /// What the weights are multiplied by at x = p / unit.
  template <class Number>
  Number factor(Number x) const {
    switch (law_) {
      case 0:
        return x;
      case 1:
        return x * x;
      case 2:
        return std::sin(x);
      case 3:
        return std::exp(x) - 1;
      case 4:
        return x * x * x + Number(0.2) * x;
      default:
        return x / (1 + std::abs(x));
    }
  }
  double present() const { return present_ * unit_; }

  std::shared_ptr<Model> model_at(double p) const {
    auto model = std::make_shared<Model>();
    double height = 0;
    const double force = stiffness_ * factor(p / unit_) * reduction();
    for (std::size_t k = 0; k < lengths_.size(); ++k) {
      const double l = lengths_[k] * length_;
      const int b = static_cast<int>(k);
      model->add_body("rod" + std::to_string(k), {.mass = 1, .inertia = 1, .position = {0, height + l / 2}});
      model->add("", Revolute<double>{.s_i = {0, k == 0 ? 0 : lengths_[k - 1] * length_ / 2}, .s_j = {0, -l / 2}},
                 b - 1, b);
      TorsionSpring<double> spring;
      spring.k = springs_[k] * stiffness_ * length_;
      spring.angle = 0;
      model->add_force("", spring, b - 1, b);
      model->add_force("", PointForce<double>{.s_i = {0, l / 2}}, b, ground, {0.0, -weights_[k] * force});
      height += l;
    }
    return model;
  }

  /// The load nearest to the present one, of both signs; NaN: there is none within 1e4 units.
  Real nearest() const {
    const std::vector<Real> f = critical_factors();
    // By a fine scan on both sides, then bisection: the factor passes one of the critical ones.
    const auto count = [&](Real x) { return std::count_if(f.begin(), f.end(), [&](Real v) { return v < factor(x); }); };
    for (Real step = 1e-3L, d = step; d < 1e4L; d += step, step = std::max(1e-3L, 1e-3L * d)) {
      Real best = std::nan("");
      for (const Real side : {1.0L, -1.0L}) {
        Real a = present_ + side * (d - step), b = present_ + side * d;
        if (count(a) == count(b)) continue;
        for (int k = 0; k < 100; ++k) (count((a + b) / 2) == count(present_ + side * (d - step)) ? a : b) = (a + b) / 2;
        if (std::isnan(best) || std::abs(b - present_) < std::abs(best - present_)) best = b;
      }
      if (!std::isnan(best)) return best * unit_;
    }
    return std::nan("");
  }

 private:
  // Makes the lowest critical factor of every column about 0.9: laws with an upper bound then reach it. A double, as
  // the model's weights are multiplied by it.
  double reduction() const { return static_cast<double>(raw_factors().front() / 0.9L); }
  std::vector<Real> critical_factors() const {
    std::vector<Real> f = raw_factors();
    const Real lowest = reduction();
    for (Real& v : f) v /= lowest;
    return f;
  }
  std::vector<Real> raw_factors() const {
    using Dense = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
    const auto n = static_cast<Eigen::Index>(lengths_.size());
    Dense c = Dense::Zero(n, n), d = c;
    Real above = 0;
    for (Eigen::Index k = n - 1; k >= 0; --k) {
      const auto i = static_cast<std::size_t>(k);
      above += weights_[i];
      d(k, k) = lengths_[i] * above;
      c(k, k) += springs_[i];
      if (k > 0) {
        c(k - 1, k - 1) += springs_[i];
        c(k, k - 1) -= springs_[i];
        c(k - 1, k) -= springs_[i];
      }
    }
    return generalized_eigenvalues<long double>(c, d);
  }

  double length_, stiffness_, unit_, present_;
  int law_ = 0;
  std::vector<double> lengths_, springs_, weights_;
};

/// The nearest load by the library against the column's own, in words; empty where they agree.
inline std::string compare_buckling(unsigned seed) {
  const BucklingColumn column(seed);
  Buckling buckling(column.model_at(column.present()), [&](double p) { return column.model_at(p); },
                    {.present = column.present(), .count = 1});
  const BucklingReport report = buckling.run();
  const auto wanted = static_cast<double>(column.nearest());
  const auto say = [&](const std::string& what) { return "seed " + std::to_string(seed) + ": " + what; };
  if (!report.ok()) return say(report.message);
  if (std::isnan(wanted)) return report.loads.empty() ? "" : say("found one where there is none near");
  if (report.loads.empty()) return say("none found, but " + std::to_string(wanted));
  const double found = report.loads.front();
  // Two as far on both sides are equally near.
  const double distance = std::abs(wanted - column.present());
  const bool mirrored = std::abs(std::abs(found - column.present()) - distance) <= 1e-8 * distance;
  if (mirrored || std::abs(found - wanted) <= 1e-8 * std::abs(wanted)) return "";
  return say(std::to_string(found / wanted) + " times the right one");
}

}  // namespace catena::testing
