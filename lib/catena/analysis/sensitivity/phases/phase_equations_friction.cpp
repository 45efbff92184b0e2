// PhaseEquations: sizes of the friction forces that depend on multipliers.
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/analysis/sensitivity/phases/phase_equations.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Of the sizes: a step of Newton's method that is their rounding.
constexpr double settled_size = 1e-15;

}  // namespace

// What the friction of a place is a part of, in plain numbers, and its slope along a change of the multipliers.
double PhaseEquations::normal_value(const Design& design, std::size_t k, std::span<const double> lambda,
                                    std::span<const double> along, double& slope) const {
  const ContactPoint& point = contacts_.points[k];
  if (const int master = law(design.places[k], k).master_row; master >= 0) {
    slope = along.empty() ? 0 : -along[at(master)];
    return -lambda[at(master)];
  }
  if (point.kind == ContactKind::rigid) {
    slope = along.empty() ? 0 : -along[at(gap_row(k))];
    return -lambda[at(gap_row(k))];
  }
  const DesignPlace& place = design.places[k];
  const std::size_t row = at(plan().element_row[at(point.joint)]);
  const double a = lambda[row], b = lambda[row + 1], da = along.empty() ? 0 : along[row],
               db = along.empty() ? 0 : along[row + 1];
  if (plan().row_is_angle[row + 1]) {
    const double share = place.has_length ? 1 / place.half_length.v : 0;
    slope = place.radius.v * ((a < 0 ? -da : da) + share * (b < 0 ? -db : db));
    return place.radius.v * (std::abs(a) + share * std::abs(b));
  }
  const double size = std::hypot(a, b);
  slope = size > 0 ? place.radius.v * (a * da + b * db) / size : 0;
  return place.radius.v * size;
}

// What a unit of each friction force makes of x and of the multipliers.
bool PhaseEquations::respond(std::span<const Coupled> coupled) {
  response_.resize(coupled.size());
  for (std::size_t l = 0; l < coupled.size(); ++l) {
    Response& response = response_[l];
    response.x.assign(f_.size(), 0.0);
    response.lambda.assign(b_.size(), 0.0);
    response.lambda[at(coupled[l].slide_row)] = 1;
    add_loads(response.lambda, response.x);
    response.lambda[at(coupled[l].slide_row)] = 0;
    response.lambda.assign(b_.size(), 0.0);
    if (!system_->solve(response.x, response.lambda)) return false;
  }
  return true;
}

void PhaseEquations::find_slope(const Design& design, std::span<const Coupled> coupled,
                                std::span<const double> lambda) {
  const std::size_t m = coupled.size();
  slope_.assign(m * m, 0.0);
  for (std::size_t l = 0; l < m; ++l) {
    for (std::size_t k = 0; k < m; ++k) {
      double slope = 0;
      normal_value(design, coupled[l].place, lambda, response_[k].lambda, slope);
      slope_[l * m + k] = (l == k ? 1 : 0) + coupled[l].factor.v * slope;
    }
  }
}

// x and multipliers in f_ and b_, where the friction forces have their sizes.
bool PhaseEquations::solve_values(const Design& design, std::span<const Coupled> coupled) {
  sizes_.assign(coupled.size(), 0.0);
  if (!system_->solve(f_, b_)) return false;
  if (coupled.empty()) return true;
  if (!respond(coupled)) return false;
  const auto m = static_cast<Eigen::Index>(coupled.size());
  const std::vector<double> alone(b_);
  Eigen::Map<Eigen::VectorXd> sizes(sizes_.data(), m);
  for (int iteration = 0;; ++iteration) {
    b_ = alone;
    for (std::size_t l = 0; l < coupled.size(); ++l) {
      for (std::size_t r = 0; r < b_.size(); ++r) b_[r] += response_[l].lambda[r] * sizes_[l];
    }
    Eigen::VectorXd residual(m);
    for (Eigen::Index l = 0; l < m; ++l) {
      double unused = 0;
      const Coupled& one = coupled[static_cast<std::size_t>(l)];
      residual(l) = sizes(l) + one.factor.v * normal_value(design, one.place, b_, {}, unused);
    }
    find_slope(design, coupled, b_);
    const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> slope(slope_.data(),
                                                                                                         m, m);
    const Eigen::PartialPivLU<Eigen::MatrixXd> factors(slope);
    if (!(factors.determinant() > 0)) return false;
    const Eigen::VectorXd step = factors.solve(residual);
    if (step.lpNorm<Eigen::Infinity>() <= settled_size * sizes.lpNorm<Eigen::Infinity>()) break;
    if (iteration == most_friction_iterations) return false;
    sizes -= step;
  }
  for (std::size_t l = 0; l < coupled.size(); ++l) {
    for (std::size_t c = 0; c < f_.size(); ++c) f_[c] += response_[l].x[c] * sizes_[l];
  }
  return true;
}

// x and lambda have the derivatives that friction forces without any leave: what their own add.
void PhaseEquations::add_slopes(const Design& design, std::span<const Coupled> coupled, std::span<DesignScalar> x,
                                std::span<DesignScalar> lambda) {
  if (coupled.empty()) return;
  const auto m = static_cast<Eigen::Index>(coupled.size());
  const Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>> slope(slope_.data(), m,
                                                                                                       m);
  const Eigen::PartialPivLU<Eigen::MatrixXd> factors(slope);
  std::vector<DesignScalar> residual;
  for (const Coupled& one : coupled) residual.push_back(one.factor * pressing(design, one.place, lambda));
  for (std::size_t p = 0; p < design.count; ++p) {
    Eigen::VectorXd side(m);
    for (Eigen::Index l = 0; l < m; ++l) side(l) = -residual[static_cast<std::size_t>(l)].d[p];
    const Eigen::VectorXd change = factors.solve(side);
    for (std::size_t l = 0; l < coupled.size(); ++l) {
      const double own = change(static_cast<Eigen::Index>(l));
      for (const int c : plan().coordinate) x[at(c)].d[p] += response_[l].x[at(c)] * own;
      for (std::size_t r = 0; r < lambda.size(); ++r) lambda[r].d[p] += response_[l].lambda[r] * own;
      lambda[at(coupled[l].slide_row)].d[p] = -own;
    }
  }
}

}  // namespace catena
