// Random chains of rigid rods over drums and on sloping floors, judged by statics of their own.
//
// Rods k = 0 ... n - 1 of length l and weight w, directions e_k, the first from A, the last to B; joints may not enter
// the drum, or the ground. With S_k the force on the start of rod k, N_j >= 0 the push on joint j along n_j, outwards:
//
//   S_{k+1} = S_k - (0, w) + N_k n_k          e_k x ((0, w/2) - S_k) = 0     for every rod
//
// n linear equations in S_0 and the N of those joints that touch, solved here by least squares from places alone: what
// they leave, and the sign of N, judge the equilibrium; the library's own forces are not asked. Whether it is a minimum
// says the Hessian in the rods' angles, t_k across e_k,
//
//   H_kk = l e_k . ((0, w/2) - S_k),   less  N_j l^2 t_i . (I - n n^T) t_k / d_j  for i, k <= j, d_j = distance to the
//   centre
//
// on the motions that keep B and the touching joints in place.
#pragma once

#include <fmt/format.h>

#include <Eigen/Core>
#include <numbers>
#include <string>

#include "oracles/slack_nets.hpp"
#include "references/dense.hpp"

namespace catena::testing {

struct SupportedChain {
  std::shared_ptr<Model> model = std::make_shared<Model>();
  int count = 4;
  double rod = 1, weight = 1;  ///< of a rod, m and N
  Vec2<double> first, last;    ///< A and B
  bool drum = true;
  Vec2<double> centre;   ///< of the drum, or a point of the floor
  double radius = 1;     ///< of the drum
  Vec2<double> upwards;  ///< normal of the floor

  /// How far a joint is outside, and the direction away.
  double gap(const Vec2<double>& joint) const {
    return drum ? norm(joint - centre) - radius : dot(joint - centre, upwards);
  }
  Vec2<double> outwards(const Vec2<double>& joint) const {
    return drum ? (1 / norm(joint - centre)) * (joint - centre) : upwards;
  }
};

/// Over a drum a chain of `slack` times the length of a path that goes round it; on a floor one longer than the way.
inline SupportedChain random_supported_chain(unsigned seed) {
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  SupportedChain chain;
  chain.drum = random() % 3 != 0;
  chain.count = 4 + static_cast<int>(random() % 57);
  const double size = std::pow(10.0, uniform(-2, 2)), mass = std::pow(10.0, uniform(-2, 2));
  chain.centre = size * Vec2<double>{uniform(-3, 3), uniform(-3, 3)};
  double way = 0, bump = 0;
  if (chain.drum) {
    chain.radius = size * uniform(0.3, 1);
    const double round = 1.02 * chain.radius, left = uniform(0.3, 1.4), right = uniform(0.3, 1.4);  // from the top
    const double down = size * uniform(0.2, 1.5), other = size * uniform(0.2, 1.5);
    way = round * (left + right) + down + other;
    const auto end = [&](double angle, double length) {
      const double c = std::cos(angle), s = std::sin(angle);
      return chain.centre + Vec2<double>{round * s + length * c, round * c - length * std::abs(s)};
    };
    chain.first = end(-left, down);
    chain.first.x = 2 * chain.centre.x - end(left, down).x;
    chain.last = end(right, other);
    bump = chain.centre.y + round * uniform(1, 1.6) - 0.5 * (chain.first.y + chain.last.y);
  } else {
    const double slope = uniform(-0.3, 0.3);
    chain.upwards = {-std::sin(slope), std::cos(slope)};
    const Vec2<double> along{std::cos(slope), std::sin(slope)};
    const double half = size * uniform(0.5, 1.5);
    chain.first = chain.centre - half * along + size * uniform(0.05, 1) * chain.upwards;
    chain.last = chain.centre + half * along + size * uniform(0.05, 1) * chain.upwards;
    way = norm(chain.last - chain.first);
    bump = size * uniform(-0.05, 0.6);
  }
  const double length = way * uniform(1.02, 1.3);
  chain.rod = length / chain.count;
  chain.weight = mass * gravity_of_earth;
  chain.model->gravity = {0, -gravity_of_earth};
  for (int k = 0; k < chain.count; ++k) {
    // A sketch: a parabola through both ends.
    const double t = (k + 0.5) / chain.count;
    BodyValues body{.mass = mass, .inertia = mass * chain.rod * chain.rod / 12};
    const Vec2<double> span = chain.last - chain.first;
    body.position = chain.first + t * span + Vec2<double>{0, bump * 4 * t * (1 - t)};
    body.angle = std::atan2(span.y + bump * 4 * (1 - 2 * t), span.x);
    chain.model->add_body("link" + std::to_string(k), body);
  }
  Contact<double> contact;
  contact.curve = chain.drum ? Curve<double>::circle(chain.centre, chain.radius)
                             : Curve<double>::line(chain.centre, {chain.upwards.y, -chain.upwards.x});
  contact.s_j = {chain.rod / 2, 0};
  for (int k = 0; k + 1 < chain.count; ++k) {
    chain.model->add("", Revolute<double>{{chain.rod / 2, 0}, {-chain.rod / 2, 0}}, k, k + 1);
    chain.model->add("", contact, ground, k);
  }
  chain.model->add("", Revolute<double>{chain.first, {-chain.rod / 2, 0}}, ground, 0);
  chain.model->add("", Revolute<double>{chain.last, {chain.rod / 2, 0}}, ground, chain.count - 1);
  return chain;
}

/// Statics of a chain whose rods have these angles.
class ChainStatics {
 public:
  ChainStatics(const SupportedChain& chain, const std::vector<double>& angle) : chain_(chain) {
    const int n = chain.count;
    Vec2<double> place = chain.first;
    for (int k = 0; k < n; ++k) {
      along_.push_back({std::cos(angle[static_cast<std::size_t>(k)]), std::sin(angle[static_cast<std::size_t>(k)])});
      place += chain.rod * along_.back();
      joint_.push_back(place);
      if (k + 1 < n && chain.gap(place) < closed * chain.rod) touching_.push_back(k);
    }
    solve_forces();
  }

  /// What is wrong with the chain as an equilibrium; empty: nothing.
  std::string fault() const {
    const double weight = chain_.weight * chain_.count, length = chain_.rod * chain_.count;
    if (!(norm(joint_.back() - chain_.last) <= 1e-9 * length)) return "the chain does not reach its end";
    for (std::size_t k = 0; k + 1 < joint_.size(); ++k) {
      if (chain_.gap(joint_[k]) < -1e-9 * length)
        return fmt::format("joint {} is inside by {:.3g} m", k, -chain_.gap(joint_[k]));
    }
    if (!(left_ <= 1e-8 * largest_)) return fmt::format("rods are off balance by {:.3g} of {:.3g} N", left_, largest_);
    for (std::size_t t = 0; t < touching_.size(); ++t) {
      if (push_[t] < -1e-8 * std::max(weight, largest_))
        return fmt::format("the push on joint {} is {:.3g} N", touching_[t], push_[t]);
    }
    return {};
  }

  /// Lowest stiffness against motions that keep what touches and carries, in parts of the largest entry of H.
  double lowest_stiffness() const {
    const int n = chain_.count;
    const double l = chain_.rod;
    Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(n, n);
    for (int k = 0; k < n; ++k) {
      hessian(k, k) = l * dot(along(k), Vec2<double>{0, chain_.weight / 2} - start_[static_cast<std::size_t>(k)]);
    }
    std::vector<Eigen::RowVectorXd> rows{Eigen::RowVectorXd::Zero(n), Eigen::RowVectorXd::Zero(n)};
    for (int k = 0; k < n; ++k) {
      rows[0](k) = -l * along(k).y;
      rows[1](k) = l * along(k).x;
    }
    for (std::size_t t = 0; t < touching_.size(); ++t) {
      const Vec2<double> joint = joint_[static_cast<std::size_t>(touching_[t])], normal = chain_.outwards(joint);
      if (push_[t] < 1e-6 * chain_.weight) continue;
      Eigen::RowVectorXd row = Eigen::RowVectorXd::Zero(n), across = row;
      for (int k = 0; k <= touching_[t]; ++k) {
        row(k) = l * (normal.y * along(k).x - normal.x * along(k).y);
        across(k) = l * dot(normal, along(k));  // (-n_y, n_x) . t_k
      }
      rows.push_back(row);
      if (chain_.drum) hessian -= push_[t] / norm(joint - chain_.centre) * across.transpose() * across;
    }
    Eigen::MatrixXd constraints(static_cast<Eigen::Index>(rows.size()), n);
    for (std::size_t r = 0; r < rows.size(); ++r) constraints.row(static_cast<Eigen::Index>(r)) = rows[r] / l;
    const double rounding =
        std::numeric_limits<double>::epsilon() * static_cast<double>(std::min<Eigen::Index>(constraints.rows(), n));
    const Eigen::MatrixXd basis = DenseRows<double>(constraints, rounding).null_space();
    if (basis.cols() == 0) return 1;
    return symmetric_eigenvalues<double>(basis.transpose() * hessian * basis)[0] / hessian.cwiseAbs().maxCoeff();
  }

 private:
  static constexpr double closed = 1e-7;  // of a rod: contacts close to 1e-10 of the chain

  Vec2<double> along(int k) const { return along_[static_cast<std::size_t>(k)]; }

  void solve_forces() {
    const int n = chain_.count, unknowns = 2 + static_cast<int>(touching_.size());
    const auto cross_e = [&](int k, const Vec2<double>& f) { return along(k).x * f.y - along(k).y * f.x; };
    Eigen::MatrixXd a = Eigen::MatrixXd::Zero(n, unknowns);
    Eigen::VectorXd b(n);
    for (int k = 0; k < n; ++k) {
      a(k, 0) = cross_e(k, {1, 0});
      a(k, 1) = cross_e(k, {0, 1});
      for (std::size_t t = 0; t < touching_.size() && touching_[t] < k; ++t) {
        a(k, 2 + static_cast<int>(t)) = cross_e(k, chain_.outwards(joint_[static_cast<std::size_t>(touching_[t])]));
      }
      b[k] = cross_e(k, {0, chain_.weight * (k + 0.5)});
    }
    const Eigen::VectorXd x = LeastSquares<double>(a).solve(b);
    left_ = (a * x - b).cwiseAbs().maxCoeff();
    push_.assign(x.data() + 2, x.data() + unknowns);
    Vec2<double> force{x[0], x[1]};
    largest_ = chain_.weight * n;
    std::size_t t = 0;
    for (int k = 0; k < n; ++k) {
      start_.push_back(force);
      largest_ = std::max(largest_, norm(force));
      force += Vec2<double>{0, -chain_.weight};
      if (t < touching_.size() && touching_[t] == k) {
        force += push_[t] * chain_.outwards(joint_[static_cast<std::size_t>(k)]);
        ++t;
      }
    }
  }

  const SupportedChain& chain_;
  std::vector<Vec2<double>> along_, joint_, start_;
  std::vector<int> touching_;
  std::vector<double> push_;
  double left_ = 0, largest_ = 0;
};

inline OneSidedVerdict judge_supported_chain(const SupportedChain& chain) {
  Equilibrium analysis(chain.model);
  const EquilibriumReport report = analysis.solve();
  OneSidedVerdict verdict{report.ok(), {}, std::string(to_string(report.status)) + ": " + report.message};
  if (!verdict.ok) return verdict;
  const SystemState state = analysis.state();
  std::vector<double> angle;
  for (int k = 0; k < chain.count; ++k) {
    angle.push_back(state.q[3 * static_cast<std::size_t>(k) + 2]);
  }
  const ChainStatics statics(chain, angle);
  verdict.fault = statics.fault();
  if (!verdict.fault.empty() || !report.stable) return verdict;
  const double lowest = statics.lowest_stiffness();
  if (lowest < -1e-7) verdict.fault = fmt::format("called stable with a stiffness of {:.3g} of the largest", lowest);
  return verdict;
}

}  // namespace catena::testing
