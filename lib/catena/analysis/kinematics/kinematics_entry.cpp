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

#include "catena/analysis/kinematics/course/step_rules.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/pose/departure.hpp"
#include "catena/analysis/pose/singular_start.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// The branch is entered over this much motion (rad, length scales); it must be found this near to its tangent, as part
// of its distance from the nearest other branch. Further nodes may be off by this part of the motion.
constexpr double entries[] = {0.02, 0.01, 0.005, 0.002, 0.001, 3e-4};
// How far along a branch (rad, length scales) rows are chosen where it starts.
constexpr double start_distance = 0.02;

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

// The mechanism is given where branches meet: nothing says on which of them it is.
Report Kinematics::start_singular(SingularPoint found, double direction) {
  SingularStart start = decide_start(evaluator_, std::move(found), options_.branch, direction);
  singular_points_.push_back(start.point);
  if (!start.report.ok()) return start.report;
  const SingularPoint& point = start.point;
  const int branch = start.branch;
  Report report;
  if (rows_.has_redundant_rows()) {
    // Rows are chosen a little way along the branch, where they can be told apart.
    const std::vector<double>& tangent = point.tangents[at(branch - 1)];
    const double h = direction * start_distance / solver_.rate_size(tangent);
    trial_ = now_.q;
    for (std::size_t k = 0; k < trial_.size(); ++k) trial_[k] += h * tangent[k];
    if (!rows_.choose(trial_)) {
      report.status = Status::singular;
      report.message =
          fmt::format("the constraints do not determine the motion near its start at t = {:.12g} s", now_.t);
      return report;
    }
  }
  report = take_branch(point, branch, direction);
  prepared_ = report.ok();
  return report;
}

// The branch that is entered, and what is known of it at the singular configuration.
struct Kinematics::Entry {
  const SingularPoint& point;
  const std::vector<double>& tangent;
  double direction;  // 1 or -1, of time
  double apart;      // rate at which it leaves the nearest other branch, at most the largest rate of any
  const Departure& departure;

  bool rests() const { return point.kind == SingularPoint::Kind::rest; }
};

// A node near the tangent: the deviation must be small enough to tell the branch from the others.
bool Kinematics::add_along_tangent(const Entry& entry, MotionBridge& bridge, double t) {
  // Tangents are velocities: backwards in time the motion leaves against them.
  const double s = entry.rests() ? entry.direction * entry.departure.at(t) : t - entry.point.t;
  for (std::size_t k = 0; k < trial_.size(); ++k) trial_[k] = entry.point.q[k] + s * entry.tangent[k];
  return add_node(bridge, t, step_rules::node_allowance * std::abs(s) * entry.apart);
}

// Nodes h (s) apart around the instant; or, where nothing moves before it or tables or the run begin with it, from
// there on: that the drivers rest tells the velocity and the acceleration at the instant itself; else the tangent tells
// the velocity. `reach`: how far the mechanism moves in h.
bool Kinematics::build_entry(const Entry& entry, bool around, double h, double reach, MotionBridge& bridge) {
  constexpr double places_around[] = {1, 2, -1, -2}, places_after[] = {1, 2, 3, 4};
  const auto& [point, tangent, direction, apart, departure] = entry;
  const bool rests = entry.rests();
  bridge.clear();
  if (rests && !around) {
    std::vector<double> accelerations(tangent);
    const double leading = direction * departure.acceleration(point.t + h);
    for (double& value : accelerations) value *= leading;
    bridge.add(point.t, point.q, std::vector<double>(tangent.size(), 0.0), accelerations);
  }
  for (std::size_t k = 0; bridge.size() < MotionBridge::capacity; ++k) {
    const double t = point.t + (around ? places_around : places_after)[k] * h;
    if (rests || bridge.empty()) {
      if (!functions_exist_at(evaluator_, t) || !add_along_tangent(entry, bridge, t)) return false;
    } else {
      bridge.evaluate(t, trial_, {}, {});
      if (!add_node(bridge, t, step_rules::node_allowance * reach)) return false;
    }
  }
  if (!rests && !around) {
    MotionBridge anchored = anchor(bridge, point, tangent);
    if (follows_constraints(anchored, point.t, point.t + h)) {
      bridge = std::move(anchored);
      return true;
    }
  }
  return follows_constraints(bridge, point.t, point.t + h);
}

// Leaves the branch that came for the one chosen, a little beyond the branch point, and bridges the way there.
Report Kinematics::take_branch(const SingularPoint& point, int branch, double direction) {
  Report report;
  stretch_.choice.reset();
  const std::vector<double>& tangent = point.tangents[at(branch - 1)];
  double rate = 0, apart = std::numeric_limits<double>::infinity();
  for (const auto& other : point.tangents) {
    rate = std::max(rate, solver_.rate_size(other));
    if (&other != &tangent) apart = std::min(apart, solver_.distance(other, tangent, nullptr));
  }
  const Departure departure(evaluator_, point.t, direction);
  const Entry entry{point, tangent, direction, std::min(apart, rate), departure};
  for (double reach : entries) {
    const double way = reach / rate;
    const double h = direction * (entry.rests() ? time_to_depart(evaluator_, point.t, direction, way) : way);
    if (!std::isfinite(h)) continue;
    MotionBridge bridge;
    if (!build_entry(entry, true, h, reach, bridge) && !build_entry(entry, false, h, reach, bridge)) continue;
    stretch_.bridge = std::move(bridge);
    stretch_.span(point.t, point.t + h);
    return report;
  }
  report.status = Status::bifurcation;
  report.message = fmt::format("at t = {:.12g} s branch {} could not be entered: {}", point.t, branch,
                               branch <= static_cast<int>(point.branches.size()) ? point.branches[at(branch - 1)] : "");
  return report;
}

}  // namespace catena
