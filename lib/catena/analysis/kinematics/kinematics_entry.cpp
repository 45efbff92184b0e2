// Entering a branch from the singular configuration where several meet.
//
// Along a branch q = q* + s z + O(s^2), z its tangent; s is the time since then, or, where the drivers rest (so that z
// is made for a driver of speed 1), how far the fastest driver has come. A little way along it the equations
// distinguish the branch from the others. The branch itself is as smooth there as elsewhere, also back through the
// singular configuration, so that a bridge (kinematics_bridge.hpp) of instants on both sides interpolates the stretch
// in between.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/pose/departure.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// The branch is entered over this much motion (rad, length scales); it must be found this near to its tangent, as part
// of its distance from the nearest other branch. Further nodes may be off by this part of the motion.
constexpr double entries[] = {0.02, 0.01, 0.005, 0.002, 0.001, 3e-4};
constexpr double entry_allowance = 0.2;

/// The bridge with the singular configuration itself in place of its last instant. With the velocity v there,
/// q = q* + s v + s^2 r(s),  and r(0) is half the acceleration; r is extrapolated from the others, in which an error of
/// the acceleration matters little, since place and velocity are known.
MotionBridge anchor(const MotionBridge& bridge, const SingularPoint& point, std::span<const double> v) {
  MotionBridge rest, anchored;
  const std::size_t n = point.q.size();
  std::vector<double> r(n), rd(n), rdd(n);
  for (int k = 0; k + 1 < bridge.size(); ++k) {
    const auto& node = bridge.nodes()[static_cast<std::size_t>(k)];
    const double s = node.t - point.t;
    for (std::size_t i = 0; i < n; ++i) {
      r[i] = (node.q[i] - point.q[i] - s * v[i]) / (s * s);
      rd[i] = (node.qd[i] - v[i]) / (s * s) - 2 * r[i] / s;
      rdd[i] = node.qdd[i] / (s * s) - 4 * rd[i] / s - 2 * r[i] / (s * s);
    }
    rest.add(node.t, r, rd, rdd);
  }
  rest.evaluate(point.t, r, {}, {});
  for (double& value : r) value *= 2;
  anchored.add(point.t, point.q, v, r);
  for (int k = 0; k + 1 < bridge.size(); ++k) {
    const auto& node = bridge.nodes()[static_cast<std::size_t>(k)];
    anchored.add(node.t, node.q, node.qd, node.qdd);
  }
  return anchored;
}

}  // namespace

// Leaves the branch that came for the one chosen, a little beyond the branch point, and bridges the way there.
Report Kinematics::take_branch(const SingularPoint& point, int branch, double direction) {
  Report report;
  choice_.reset();
  const bool rests = point.kind == SingularPoint::Kind::rest;
  const std::vector<double>& tangent = point.tangents[at(branch - 1)];
  double rate = 0, apart = std::numeric_limits<double>::infinity();
  for (const auto& other : point.tangents) {
    rate = std::max(rate, solver_.distance(other, nothing_, nullptr));
    if (&other != &tangent) apart = std::min(apart, solver_.distance(other, tangent, nullptr));
  }
  std::vector<double> accelerations(q_.size());
  const Departure departure(evaluator_, point.t, direction);
  for (double entry : entries) {
    const double h = direction * (rests ? time_to_depart(evaluator_, point.t, direction, entry / rate) : entry / rate);
    if (!std::isfinite(h)) continue;
    // Near the tangent: the deviation must be small enough to tell the branch from the others.
    const auto add_along_tangent = [&](MotionBridge& bridge, double t) {
      // Tangents are velocities: backwards in time the motion leaves against them.
      const double s = rests ? direction * departure.at(t) : t - point.t;
      for (std::size_t k = 0; k < trial_.size(); ++k) trial_[k] = point.q[k] + s * tangent[k];
      return add_node(bridge, t, entry_allowance * std::abs(s) * std::min(apart, rate));
    };
    // Around the instant; or, where nothing moves before it or tables or the run begin with it, from there on: that the
    // drivers rest tells the velocity and the acceleration at the instant itself; else the tangent tells the velocity.
    constexpr double around[] = {1, 2, -1, -2}, after[] = {1, 2, 3, 4};
    MotionBridge bridge;
    bool built = false;
    for (const double* places : {around, after}) {
      bridge.clear();
      if (rests && places == after) {
        for (std::size_t k = 0; k < tangent.size(); ++k) {
          accelerations[k] = direction * departure.acceleration(point.t + h) * tangent[k];
        }
        bridge.add(point.t, point.q, nothing_, accelerations);
      }
      built = true;
      for (std::size_t k = 0; built && bridge.size() < MotionBridge::capacity; ++k) {
        const double t = point.t + places[k] * h;
        if (rests || bridge.empty()) {
          built = functions_go_on(t) && add_along_tangent(bridge, t);
        } else {
          bridge.evaluate(t, trial_, {}, {});
          built = add_node(bridge, t, entry_allowance * entry);
        }
      }
      if (built && !rests && places == after) {
        MotionBridge anchored = anchor(bridge, point, tangent);
        if (follows_constraints(anchored, point.t, point.t + h)) {
          bridge = std::move(anchored);
          break;
        }
      }
      built = built && follows_constraints(bridge, point.t, point.t + h);
      if (built) break;
    }
    if (!built) continue;
    bridge_ = std::move(bridge);
    bridge_from_ = std::min(point.t, point.t + h);
    bridge_to_ = std::max(point.t, point.t + h);
    return report;
  }
  report.status = Status::bifurcation;
  report.message = fmt::format("at t = {:.12g} s branch {} could not be entered: {}", point.t, branch,
                               branch <= static_cast<int>(point.branches.size()) ? point.branches[at(branch - 1)] : "");
  return report;
}

}  // namespace catena
