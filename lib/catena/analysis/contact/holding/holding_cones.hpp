// What the contacts, ropes and joints of a place can do to hold a position, as columns of forces (holding.hpp).
//
//   contact   J_n +- u mu_static J_t        rope   T_0 J_gap + sum_k (T_k+1 - T_k) J_slide,k,   T_k+1 / T_k = e^(+-u
//   E_k) joint     held_joints.hpp
//
// Units: N; moments are divided by the length scale so that they compare.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/analysis/contact/contact_points.hpp"
#include "catena/analysis/contact/holding/held_joints.hpp"
#include "catena/assembly/evaluate.hpp"
#include "catena/base/at.hpp"
#include "catena/base/status.hpp"

namespace catena {

/// A contact: its forces form a cone with two edges.
struct Edge {
  ForceColumn normal, along;
  double friction;
};

/// A rope with friction on pulleys: one edge for each choice of the side of every pulley on which the tension is
/// larger.
struct RopeEdges {
  ForceColumn gap;
  std::vector<ForceColumn> along;
  std::vector<double> exponent;

  /// The force for a largest tension of 1.
  ForceColumn edge(double u, std::size_t signs) const {
    std::vector<double> tension{0};  // logarithms
    for (std::size_t k = 0; k < along.size(); ++k)
      tension.push_back(tension.back() + ((signs >> k) & 1 ? 1 : -1) * u * exponent[k]);
    const double largest = *std::max_element(tension.begin(), tension.end());
    for (double& t : tension) t = std::exp(t - largest);
    ForceColumn force = sum_of(tension[0], gap, 0, gap);
    for (std::size_t k = 0; k < along.size(); ++k) force = sum_of(1, force, tension[k + 1] - tension[k], along[k]);
    return force;
  }
};

/// Forces as columns of the plan, moments divided by the length scale so that they compare.
class ForceColumns {
 public:
  explicit ForceColumns(const Evaluator& evaluator)
      : evaluator_(evaluator), length_(evaluator.length_scale()), rest_(at(evaluator.plan().coordinates()), 0.0) {}

  ForceColumn of(std::span<const double> loads) const {
    const Plan& plan = evaluator_.plan();
    ForceColumn f(at(plan.columns));
    for (int c = 0; c < plan.columns; ++c) {
      const int coordinate = plan.coordinate[at(c)];
      f[at(c)] = loads[at(coordinate)] / (coordinate % 3 == 2 ? length_ : 1);
    }
    return f;
  }
  /// Of what is applied, at rest.
  ForceColumn applied() {
    std::vector<double> loads(rest_.size(), 0.0);
    evaluator_.applied_forces(rest_, loads);
    return of(loads);
  }
  Evaluator::ScalarMotion motion(int element) { return evaluator_.scalar_motion(element, rest_); }
  /// Of a force of one along the motion of an element's value.
  ForceColumn along(const Evaluator::ScalarMotion& motion) {
    std::vector<double> by(rest_.size(), 0.0);
    scatter_gradient(motion, 1, by);
    return of(by);
  }
  ForceColumn along(int element) { return along(motion(element)); }

  /// Of multipliers of one, a column for each row of the plan.
  std::vector<ForceColumn> of_constraints();

 private:
  const Evaluator& evaluator_;
  double length_;
  std::vector<double> rest_;
};

/// What the contacts, ropes and joints of a place can do.
struct ContactCones {
  std::vector<Edge> edges;
  std::vector<RopeEdges> ropes;
  std::vector<HeldJoint> joints;
  std::vector<ForceColumn> constraints;  ///< for each row of the plan; those of joints with friction are zero
};

/// At the evaluator's configuration. A report where a rope has too many pulleys with friction.
Report find_cones(const ContactModel& contacts, const Evaluator& evaluator, ForceColumns& columns, ContactCones& cones);

}  // namespace catena
