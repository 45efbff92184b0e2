// Chains of pendulums under gravity, torsion springs, forces that turn with a link and torques that read other links,
// in minimal coordinates: the absolute angles of the links. Dense algebra in 80 bits that shares nothing with the
// library.
//
//   r = sum_j a_j e(theta_j)      a_j: length of link j before the point's own, the distance along it on that one
//   M_ij = sum_k m_k a_ki a_kj n_i . n_j + delta_ij J_i,    Q_i = sum F . a_i n_i,    e = (cos, sin), n = (-sin, cos)
//
// Springs are set so that the given angles are in balance.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <complex>
#include <string>
#include <vector>

#include "oracles/scene_text.hpp"
#include "references/dense.hpp"

namespace catena::testing {

using Wide = long double;
using WideMatrix = Eigen::Matrix<Wide, Eigen::Dynamic, Eigen::Dynamic>;
using WideValue = std::complex<Wide>;

struct ChainLink {
  double length = 1, centre = 0.5;  // m from the link's root
  double mass = 1, inertia = 0.1, spring = 1, angle = 0;
};
/// A force in the axes of its link, N, at a distance from its root, m.
struct ChainForce {
  int link = 0;
  double at = 0, x = 0, y = 0;
};

class UnsymmetricChain {
 public:
  std::vector<ChainLink> links;
  std::vector<ChainForce> forces;
  double gx = 0, gy = 0;
  /// torque on link i: sum_j law(i, j) (theta_j - given theta_j); empty: none.
  WideMatrix law;
  std::vector<double> torques;  ///< of laws on the links where they are not at the given angles; empty: zero

  int size() const { return static_cast<int>(links.size()); }

  WideMatrix masses() const {
    WideMatrix m = WideMatrix::Zero(size(), size());
    for (int k = 0; k < size(); ++k) {
      for (int i = 0; i <= k; ++i) {
        for (int j = 0; j <= k; ++j)
          m(i, j) += Wide(links[k].mass) * arm(k, links[k].centre, i) * arm(k, links[k].centre, j) *
                     std::cos(angle(i) - angle(j));
      }
      m(k, k) += Wide(links[k].inertia);
    }
    return m;
  }

  /// Generalized forces of all but the springs.
  Eigen::Matrix<Wide, Eigen::Dynamic, 1> loads() const {
    Eigen::Matrix<Wide, Eigen::Dynamic, 1> q = Eigen::Matrix<Wide, Eigen::Dynamic, 1>::Zero(size());
    each_force([&](int k, double at, Wide fx, Wide fy, bool) {
      for (int i = 0; i <= k; ++i) q[i] += arm(k, at, i) * (-std::sin(angle(i)) * fx + std::cos(angle(i)) * fy);
    });
    return q;
  }

  WideMatrix stiffness() const {
    WideMatrix s = WideMatrix::Zero(size(), size());
    each_force([&](int k, double at, Wide fx, Wide fy, bool follows) {
      for (int i = 0; i <= k; ++i) {
        s(i, i) += arm(k, at, i) * (std::cos(angle(i)) * fx + std::sin(angle(i)) * fy);
        if (follows) s(i, k) -= arm(k, at, i) * (-std::sin(angle(i)) * -fy + std::cos(angle(i)) * fx);
      }
    });
    for (int k = 0; k < size(); ++k) {
      s(k, k) += Wide(links[k].spring);
      if (k == 0) continue;
      s(k - 1, k - 1) += Wide(links[k].spring);
      s(k, k - 1) -= Wide(links[k].spring);
      s(k - 1, k) -= Wide(links[k].spring);
    }
    if (law.size() > 0) s -= law;
    return s;
  }

  /// All omega2, ascending in the real part.
  std::vector<WideValue> omega2() const {
    const WideMatrix a = ReferenceFactors<Wide>(masses()).solve_all(stiffness());
    std::vector<WideValue> values = eigenvalues<Wide>(a);
    std::sort(values.begin(), values.end(), [](const WideValue& x, const WideValue& y) {
      return x.real() != y.real() ? x.real() < y.real() : x.imag() < y.imag();
    });
    return values;
  }

  /// The angles, relative to the link before, at which springs are without torque: the given angles are in balance.
  std::vector<double> rest() const {
    const auto q = loads();
    std::vector<double> result(links.size());
    double torque = 0;
    for (int k = size() - 1; k >= 0; --k) {
      torque += static_cast<double>(q[k]);
      result[k] = links[k].angle - (k > 0 ? links[k - 1].angle : 0.0) - torque / links[k].spring;
    }
    return result;
  }

  /// Largest torque that is left on a link, with springs of these rest angles.
  double imbalance(const std::vector<double>& rest_angles) const {
    auto left = loads();
    for (std::size_t k = 0; k < torques.size(); ++k) left[static_cast<Eigen::Index>(k)] += torques[k];
    for (int k = 0; k < size(); ++k) {
      const Wide before = k > 0 ? angle(k - 1) : Wide(0);
      const Wide torque = Wide(links[k].spring) * (angle(k) - before - Wide(rest_angles[k]));
      left[k] -= torque;
      if (k > 0) left[k - 1] += torque;
    }
    return static_cast<double>(left.cwiseAbs().maxCoeff());
  }

  /// The bodies, joints, springs and forces as lists of a scene; `scale`: an expression that forces are multiplied by.
  std::string scene(const std::string& scale = "1") const {
    std::string bodies, constraints, elements;
    const auto comma = [](std::string& list) { list += list.empty() ? "" : ",\n"; };
    double x = 0, y = 0;
    const std::vector<double> rest_angles = rest();
    for (int k = 0; k < size(); ++k) {
      const ChainLink& l = links[k];
      const double c = std::cos(l.angle), s = std::sin(l.angle);
      for (std::string* list : {&bodies, &constraints, &elements}) comma(*list);
      bodies +=
          "\"l" + std::to_string(k) + "\": {\"mass\": " + text_of(l.mass) + ", \"inertia\": " + text_of(l.inertia) +
          ", \"position\": " + pair_of(x + l.centre * c, y + l.centre * s) + ", \"angle\": " + text_of(l.angle) + "}";
      const std::string before = k == 0 ? "\"ground\""
                                        : "[\"l" + std::to_string(k - 1) + "\", " +
                                              pair_of(links[k - 1].length - links[k - 1].centre, 0) + "]";
      constraints += "{\"type\": \"revolute\", \"i\": " + before + ", \"j\": [\"l" + std::to_string(k) + "\", " +
                     pair_of(-l.centre, 0) + "]}";
      elements += "{\"type\": \"torsion_spring\", \"i\": \"" + (k == 0 ? "ground" : "l" + std::to_string(k - 1)) +
                  "\", \"j\": \"l" + std::to_string(k) + "\", \"k\": " + text_of(l.spring) +
                  ", \"angle\": " + text_of(rest_angles[k]) + "}";
      x += l.length * c;
      y += l.length * s;
    }
    for (const ChainForce& f : forces) {
      comma(elements);
      elements += "{\"type\": \"point_force\", \"i\": [\"l" + std::to_string(f.link) + "\", " +
                  pair_of(f.at - links[f.link].centre, 0) + "], \"frame\": \"body\", \"force\": [\"=" + scale + "*" +
                  text_of(f.x) + "\", \"=" + scale + "*" + text_of(f.y) + "\"]}";
    }
    for (int i = 0; i < static_cast<int>(law.rows()); ++i) {
      std::string terms;
      for (int j = 0; j < size(); ++j) {
        if (law(i, j) == 0) continue;
        terms += " + (" + text_of(static_cast<double>(law(i, j))) + ")*(l" + std::to_string(j) + ".angle - (" +
                 text_of(links[j].angle) + "))";
      }
      if (terms.empty()) continue;
      comma(elements);
      elements += "{\"type\": \"torque\", \"i\": \"l" + std::to_string(i) + "\", \"torque\": \"=0" + terms + "\"}";
    }
    return "\"gravity\": " + pair_of(gx, gy) + ", \"bodies\": {" + bodies + "}, \"constraints\": [" + constraints +
           "], \"forces\": [" + elements + "]";
  }

 private:
  Wide angle(int k) const { return Wide(links[k].angle); }
  /// a_i of the point at a distance along link k.
  Wide arm(int k, double at, int i) const { return i < k ? Wide(links[i].length) : Wide(at); }
  template <class F>
  void each_force(F&& f) const {
    for (int k = 0; k < size(); ++k)
      f(k, links[k].centre, Wide(links[k].mass) * Wide(gx), Wide(links[k].mass) * Wide(gy), false);
    for (const ChainForce& force : forces) {
      const Wide c = std::cos(angle(force.link)), s = std::sin(angle(force.link));
      f(force.link, force.at, c * Wide(force.x) - s * Wide(force.y), s * Wide(force.x) + c * Wide(force.y), true);
    }
  }
};

}  // namespace catena::testing
