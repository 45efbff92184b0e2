#include "catena/analysis/spectrum/circulatory_modes.hpp"

#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <Eigen/QR>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/mass_basis.hpp"
#include "catena/analysis/spectrum/modes_operator.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

using Dense = Eigen::MatrixXd;

}  // namespace

double CirculatoryMode::frequency() const { return std::sqrt(std::complex<double>(omega2, imaginary)).real(); }
double CirculatoryMode::growth() const { return std::sqrt(std::complex<double>(omega2, imaginary)).imag(); }

CirculatoryMotions::CirculatoryMotions(StaticSystem& system, StaticTangent& tangent, std::span<const double> mass)
    : system_(system), tangent_(tangent), groups_(system, false) {
  if (!are_small() || groups_.groups().empty()) return;
  MotionGroup& group = groups_.groups().front();
  if (mass.empty()) {
    groups_.orthonormalise(length_weights(system));
    return;
  }
  groups_.orthonormalise(basis_weights(system, groups_, mass));
  if (group.freedoms() > 0) massless_ = use_masses(system, group, mass);
}

// From the dense eigenvectors to values that are accurate, block by block.
class CirculatoryMotions::Refinement {
 public:
  Refinement(CirculatoryMotions& motions, const StiffnessFloor& floor)
      : tangent_(motions.tangent_),
        plan_(motions.system_.plan()),
        floor_(floor),
        z_(motions.groups_.groups().front().basis.data(), plan_.columns, motions.groups_.groups().front().freedoms()) {}

  Dense reduced() const {
    Dense product(z_.rows(), z_.cols());
    for (Eigen::Index k = 0; k < z_.cols(); ++k) product.col(k) = times(z_.col(k));
    return z_.transpose() * product;
  }

  /// A real value, or the pair of columns x, with the left vectors y (columns).
  void add(const Dense& right, const Dense& left, std::complex<double> value, CirculatoryModes& out) const {
    const Dense x = orthonormal(right), y = orthonormal(left);
    const Dense overlap = y.transpose() * x;
    const double angle = x.cols() == 1 ? std::abs(overlap(0, 0)) : overlap.jacobiSvd().singularValues()[1];
    const Dense zx = z_ * x, zy = z_ * y;
    Dense b(x.cols(), x.cols());
    double rounding = 0;
    for (Eigen::Index k = 0; k < x.cols(); ++k) {
      b.col(k) = zy.transpose() * times(zx.col(k));
      for (Eigen::Index j = 0; j < x.cols(); ++j)
        rounding = std::max(rounding, floor_.between(span(zy, j), span(zx, k)));
    }
    // Left and right subspaces that are perpendicular but for rounding tell nothing about the value: it stays as it is.
    const bool known = angle > thresholds::solved;
    if (known) {
      b = (overlap.inverse() * b).eval();
      rounding /= angle;
    } else if (x.cols() == 1) {
      b(0, 0) = value.real();
    } else {
      b = x.transpose() * (x * value.real());  // no pair that could be told from rounding
    }
    if (x.cols() == 1)
      add_real(b(0, 0), rounding, zx.col(0), out);
    else
      add_block(b, rounding, zx, out);
  }

 private:
  Eigen::VectorXd times(const Eigen::VectorXd& v) const {
    Eigen::VectorXd result(v.size());
    tangent_.multiply_stiffness({v.data(), at(static_cast<int>(v.size()))},
                                {result.data(), at(static_cast<int>(v.size()))});
    return result;
  }
  static std::span<const double> span(const Dense& m, Eigen::Index column) {
    return {m.col(column).data(), static_cast<std::size_t>(m.rows())};
  }
  static Dense orthonormal(const Dense& x) {
    if (x.cols() == 1) return x.normalized();
    // The shorter one may be known to its direction only.
    Dense scaled = x;
    for (Eigen::Index k = 0; k < x.cols(); ++k) scaled.col(k).normalize();
    const Eigen::HouseholderQR<Dense> factors(scaled);
    return factors.householderQ() * Dense::Identity(x.rows(), x.cols());
  }

  void add_real(double omega2, double rounding, const Eigen::VectorXd& v, CirculatoryModes& out) const {
    if (std::abs(omega2) <= rounding) omega2 = 0;
    out.negative += omega2 < 0;
    out.neutral += omega2 == 0;
    CirculatoryMode mode{omega2, 0, {v.data(), v.data() + v.size()}, {}};
    const double sense = std::copysign(1.0, decisive_component(plan_, mode.shape));
    for (double& component : mode.shape) component *= sense;
    out.modes.push_back(std::move(mode));
  }

  void add_block(const Dense& b, double rounding, const Dense& x, CirculatoryModes& out) const {
    const double middle = 0.5 * b.trace(), half = 0.5 * (b(0, 0) - b(1, 1));
    const double discriminant = half * half + b(0, 1) * b(1, 0);
    const double doubt = rounding * (2 * std::abs(half) + std::abs(b(0, 1)) + std::abs(b(1, 0)) + rounding);
    if (discriminant < -doubt) {
      add_pair(b, middle, std::sqrt(-discriminant), x, out);
      return;
    }
    const double apart = std::sqrt(std::max(discriminant, 0.0));
    for (const int side : {-1, 1}) {
      const double value = middle + side * apart;
      // The null vector of B - value: across its larger row; where there is none, either column.
      const Eigen::Matrix2d rest = b - value * Eigen::Matrix2d::Identity();
      const Eigen::Index row = rest.row(0).norm() >= rest.row(1).norm() ? 0 : 1;
      Eigen::Vector2d z(-rest(row, 1), rest(row, 0));
      if (z.norm() <= rounding) z = side < 0 ? Eigen::Vector2d(1, 0) : Eigen::Vector2d(0, 1);
      add_real(value, rounding, x * z.normalized(), out);
    }
  }

  void add_pair(const Dense& b, double middle, double imaginary, const Dense& x, CirculatoryModes& out) const {
    const std::complex<double> value(middle, -imaginary);
    const Eigen::Matrix2cd rest = b.cast<std::complex<double>>() - value * Eigen::Matrix2cd::Identity();
    const Eigen::Index row = rest.row(0).norm() >= rest.row(1).norm() ? 0 : 1;
    const Eigen::Vector2cd z = Eigen::Vector2cd(-rest(row, 1), rest(row, 0)).normalized();
    Eigen::VectorXcd v = x.cast<std::complex<double>>() * z;
    // The phase in which the component that moves most, turning before travelling, is real.
    std::vector<double> size(at(static_cast<int>(v.size())));
    for (Eigen::Index c = 0; c < v.size(); ++c) size[static_cast<std::size_t>(c)] = std::abs(v[c]);
    const double most = decisive_component(plan_, size);
    const auto place = std::find(size.begin(), size.end(), most) - size.begin();
    v *= std::conj(v[place]) / most;
    CirculatoryMode mode{middle, imaginary, {}, {}};
    for (const std::complex<double>& component : v) {
      mode.shape.push_back(component.real());
      mode.quadrature.push_back(component.imag());
    }
    mode.quadrature[static_cast<std::size_t>(place)] = 0;
    ++out.pairs;
    out.modes.push_back(std::move(mode));
  }

  const StaticTangent& tangent_;
  const Plan& plan_;
  const StiffnessFloor& floor_;
  Eigen::Map<const Dense> z_;
};

bool CirculatoryMotions::find(std::span<const double> lambda, double residual, CirculatoryModes& modes) {
  modes = {};
  modes.symmetric = freedoms() == 0;
  if (modes.symmetric) return true;
  tangent_.fill(lambda, 0);
  const StiffnessFloor floor(system_, lambda, residual, &groups_);
  const Refinement refinement(*this, floor);
  Dense reduced = refinement.reduced();
  if (!reduced.allFinite()) return false;
  const double size = reduced.cwiseAbs().maxCoeff();
  // Rounding of the products that make a reduced stiffness, in parts of its largest entry.
  modes.symmetric = (reduced - reduced.transpose()).cwiseAbs().maxCoeff() <= thresholds::carried_rounding * size;
  Eigen::EigenSolver<Dense> solver(reduced);
  Dense right = solver.pseudoEigenvectors(), left = right.inverse();
  if (solver.info() == Eigen::Success && !left.allFinite()) {
    for (Eigen::Index c = 0; c < reduced.cols(); ++c) {
      for (Eigen::Index r = 0; r < reduced.rows(); ++r)
        reduced(r, c) += std::numeric_limits<double>::epsilon() * size * std::sin(1.0 + 1.7 * (r + 2.3 * c));
    }
    solver.compute(reduced);
    right = solver.pseudoEigenvectors();
    left = right.inverse();
  }
  if (solver.info() != Eigen::Success || !left.allFinite()) return false;
  left.transposeInPlace();
  for (Eigen::Index k = 0; k < right.cols();) {
    const std::complex<double> value = solver.eigenvalues()[k];
    const Eigen::Index width = value.imag() == 0 ? 1 : 2;
    refinement.add(right.middleCols(k, width), left.middleCols(k, width), value, modes);
    k += width;
  }
  std::stable_sort(modes.modes.begin(), modes.modes.end(),
                   [](const CirculatoryMode& a, const CirculatoryMode& b) { return a.omega2 < b.omega2; });
  return true;
}

std::unique_ptr<CirculatoryMotions> motions_in_masses(StaticSystem& system, StaticTangent& tangent, std::string& lack) {
  const Plan& plan = system.plan();
  const Model& model = system.evaluator().model();
  lack.clear();
  std::vector<double> mass;
  for (int c = 0; c < plan.columns && lack.empty(); ++c) {
    const int number = plan.model_body[at(plan.coordinate[at(c)] / 3)];
    const auto& body = model.bodies[at(number)];
    const bool turns = plan.coordinate[at(c)] % 3 == 2;
    mass.push_back(turns ? body.inertia : body.mass);
    if (!(turns ? body.has_inertia : body.has_mass))
      lack = fmt::format("no {} of body \"{}\" is given", turns ? "inertia" : "mass", model.body_name(number));
  }
  if (lack.empty()) {
    auto motions = std::make_unique<CirculatoryMotions>(system, tangent, mass);
    if (!motions->massless_column()) return motions;
    const int number = plan.model_body[at(plan.coordinate[at(*motions->massless_column())] / 3)];
    lack = fmt::format("a motion of body \"{}\" moves no mass", model.body_name(number));
  }
  return std::make_unique<CirculatoryMotions>(system, tangent, std::span<const double>{});
}

}  // namespace catena
