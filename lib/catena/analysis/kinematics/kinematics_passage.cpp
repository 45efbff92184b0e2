// Passing singular configurations: the branches that meet there, and the one on which the motion goes on.
//
// The branch is extrapolated from two instants before the suspected one to two behind it and solved for there, where
// the equations determine it again. Hermite's polynomial through the four (kinematics_bridge.hpp) must then meet the
// constraints along the whole bridge: with links that only nearly align it does not, since the true branch turns away.
// Along it the singular instants are found (bridge_search.hpp), and there the null spaces and the branches are
// taken.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "catena/analysis/kinematics/bridge_search.hpp"
#include "catena/analysis/kinematics/course/step_rules.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/pose/departure.hpp"
#include "catena/analysis/pose/singular_start.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// Residual of the polynomial, in length scales or rad, above rounding.
constexpr double bridge_tolerance = 2e-12;
constexpr double rounded_place = 16 * std::numeric_limits<double>::epsilon();
// Part of a bridge after which drivers that rest at the singular instant are evaluated again: they have begun to move,
// while the mechanism has not moved visibly.
constexpr double moment = 2e-3;

}  // namespace

// A bridge over a stretch that may be singular. h: step between its nodes, s, negative backwards in time.
struct Kinematics::Crossing {
  MotionBridge bridge;
  double from = 0, to = 0, h = 0;
};

// Solves at t from the prediction in trial_.
bool Kinematics::add_node(MotionBridge& bridge, double t, double allowed) {
  if (!functions_exist_at(evaluator_, t)) return false;
  evaluator_.set_time(t);
  fixed_.restore(now_.q, trial_, {}, {});
  newton_ = solver_.solve_position(trial_);
  if (!newton_.converged || newton_.first_correction > allowed) return false;
  // A second solve, since the bridge magnifies rounding in a node.
  if (!solver_.solve_position(trial_).converged) return false;
  std::vector<double> rates(now_.q.size(), 0.0), accelerations(now_.q.size(), 0.0);
  if (!solver_.solve_velocity(rates, false) || !solver_.solve_acceleration(rates, accelerations, false)) return false;
  bridge.add(t, trial_, rates, accelerations);
  return true;
}

// Nodes at centre + {-2, -1, 1, 2} h (h is negative when time runs backwards). The nodes behind the centre are
// predicted from four before it, accurately enough to stay on the branch even where others lie near. Where the run, and
// with it a driver, ends too early for them, the four nodes before the centre form the bridge.
bool Kinematics::build_bridge(MotionBridge& bridge, double centre, double h, double reach) {
  MotionBridge before;
  for (int k = 1; k <= MotionBridge::capacity; ++k) {
    const double t = centre - k * h;
    if (!functions_exist_at(evaluator_, t)) break;
    if (before.empty()) {
      trial_ = now_.q;
      predict(t, trial_, {}, {});
    } else {
      before.evaluate(t, trial_, {}, {});
    }
    if (!add_node(before, t, step_rules::node_allowance * reach)) break;
  }
  if (before.size() < 2) return false;
  bridge = before;
  if (!functions_exist_at(evaluator_, centre + 2 * h)) return true;
  bridge.keep_first(2);
  for (int k = 1; k <= 2; ++k) {
    (k == 1 ? before : bridge).evaluate(centre + k * h, trial_, {}, {});
    if (!add_node(bridge, centre + k * h, step_rules::node_allowance * reach)) return false;
  }
  return true;
}

bool Kinematics::follows_constraints(const MotionBridge& bridge, double from, double to) {
  std::vector<double> q(now_.q.size());
  double extent = 0, place = 0;
  for (std::size_t k = 0; k < now_.q.size(); ++k)
    extent = std::max(extent, std::abs(now_.q[k]) / evaluator_.length_scale());
  for (int p = 0; p < plan().bodies; ++p) {
    const Vec2<double> origin = evaluator_.origin(p);
    place = std::max({place, std::abs(origin.x), std::abs(origin.y)});
  }
  // Lengths of a mechanism described far from the origin carry the rounding of its places: redundant links agree no
  // better than that.
  const double tolerance = bridge_tolerance + 1e-14 * extent + rounded_place * place / evaluator_.length_scale();
  for (int k = 0; k < BridgeSearch::samples; ++k) {
    const double t = from + (to - from) * k / (BridgeSearch::samples - 1);
    evaluator_.set_time(t);
    bridge.evaluate(t, q, {}, {});
    if (!(solver_.residual_at(q) <= tolerance)) return false;
  }
  return true;
}

// The singular configuration at an instant that was located on the bridge.
SingularPoint Kinematics::look_at(const Crossing& crossing, double t) {
  const auto& [bridge, from, to, h] = crossing;
  const bool rests = BridgeSearch(evaluator_, solver_, bridge, from, to).find_rest(t);
  std::vector<double> q(now_.q.size()), qd(now_.q.size());
  bridge.evaluate(t, q, qd, {});
  evaluator_.set_time(t);
  SingularPoint point = find_branches(evaluator_, q, qd, dependence::follows_at_start);
  if (!rests || point.nullity == 0) return point;
  // Where the drivers rest the velocity is zero; it is evaluated a moment later.
  const double later = t + std::copysign(moment * (to - from), t - now_.t);
  bridge.evaluate(later, {}, qd, {});
  evaluator_.set_time(later);
  point = find_branches(evaluator_, q, {}, dependence::follows_at_start, Drivers::about_to_move);
  point.kind = SingularPoint::Kind::rest;
  point.t = t;
  evaluator_.set_time(t);
  if (point.driver >= 0) point.driver_value = evaluator_.element_value(point.driver).f;
  // The branch that goes on as before comes first.
  const double rate = solver_.rate_size(qd);
  std::size_t before = 0;
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < point.tangents.size(); ++k) {
    const double size = rate / solver_.rate_size(point.tangents[k]);
    for (std::size_t c = 0; c < trial_.size(); ++c) trial_[c] = size * point.tangents[k][c];
    if (const double off = solver_.distance(trial_, qd, nullptr); off < nearest) nearest = off, before = k;
  }
  if (before > 0) point.put_first(before);
  return point;
}

void Kinematics::announce(const SingularPoint& point, Report& report) {
  std::string text;
  switch (point.kind) {
    case SingularPoint::Kind::branch_point:
      text = fmt::format("at t = {:.12g} s branches meet: {}; {} ", point.t, point.describe_branches(),
                         options_.branch <= 1 ? "the motion goes on as before, along" : "the motion takes");
      text += fmt::format("branch {}", std::max(1, options_.branch));
      break;
    case SingularPoint::Kind::rest:
      text = fmt::format("at t = {:.12g} s the drivers rest in a singular configuration; ", point.t);
      if (point.tangents.size() > 1 && options_.branch > 1) {
        text += fmt::format("the motion takes branch {}: {}", options_.branch, point.describe_ways());
      } else {
        text += "the motion continues smoothly";
        if (point.tangents.size() > 1) text += ", along branch 1: " + point.describe_ways();
      }
      break;
    default:
      text = fmt::format("at t = {:.12g} s the mechanism passes a singular configuration; the motion goes on as before",
                         point.t);
  }
  if (point.nullity > 1) {
    text += fmt::format(" ({} motions are undetermined at that instant)", point.nullity);
  }
  report.warnings.push_back(std::move(text));
}

// The time in which the mechanism moves by `reach`, at the greatest speed that the drivers have within twice that time:
// where they come to rest the present speed gives no estimate. 0: it does not move.
double Kinematics::bridge_length(double centre, double reach) {
  const double rate = solver_.rate_size(now_.qd);
  std::vector<double> nu(at(plan().rows));
  const auto speed = [&](double t) {
    if (!functions_exist_at(evaluator_, t)) return 0.0;
    evaluator_.set_time(t);
    evaluator_.nu(nu);
    return std::sqrt(std::inner_product(nu.begin(), nu.end(), nu.begin(), 0.0));
  };
  const double present = speed(now_.t);
  double h = reach / rate;
  if (!(present > 0) || !std::isfinite(h)) return 0;
  for (int k = 0; k < 60; ++k) {
    double most = present;
    for (int s = -2; s <= 2; ++s) most = std::max(most, speed(centre + s * h));
    if (h * rate * most <= 1.5 * reach * present) return h;
    h *= 0.7;
  }
  return 0;
}

// A bridge over the suspected stretch from the present instant to `next`. A node that falls on the singular instant
// makes the first bridge useless, not the second.
bool Kinematics::build_crossing(Crossing& crossing, double next, double target, double reach) {
  const double middle = now_.t + (next - now_.t) / 2, length = bridge_length(middle, reach);
  if (!(length > 0)) return false;
  const double h = crossing.h = target > now_.t ? length : -length;
  for (double shift : {0.0, 0.5}) {
    const double centre = middle + shift * h;
    crossing.from = centre - length;
    crossing.to = centre + length;
    if (!functions_exist_at(evaluator_, centre + 2 * h)) (h > 0 ? crossing.to : crossing.from) = target;
    if (build_bridge(crossing.bridge, centre, h, reach) &&
        follows_constraints(crossing.bridge, crossing.from, crossing.to)) {
      return true;
    }
    crossing.bridge.clear();
  }
  return false;
}

// Nodes placed about the singular instant itself have the least rounding: they replace the others where they can.
void Kinematics::centre_crossing(Crossing& crossing, double instant, double target, double reach) {
  const double h = crossing.h, length = std::abs(h);
  if (!functions_exist_at(evaluator_, instant - 2 * h) || !functions_exist_at(evaluator_, instant + 2 * h)) return;
  MotionBridge centred;
  for (int k : {-1, -2, 1, 2}) {
    crossing.bridge.evaluate(instant + k * h, trial_, {}, {});
    if (!add_node(centred, instant + k * h, step_rules::node_allowance * reach)) return;
  }
  if (!((target - (instant - h)) * h >= 0)) return;
  if (!follows_constraints(centred, instant - length, instant + length)) return;
  crossing = {std::move(centred), instant - length, instant + length, h};
}

// Looks for singular configurations about the suspected stretch from the present instant to `next`. Passed: the bridge
// is in place.
Kinematics::Passage Kinematics::pass_singular(double next, double target, double reach, Report& report) {
  Crossing crossing;
  if (!build_crossing(crossing, next, target, reach)) return Passage::none;
  const double h = crossing.h, length = std::abs(h);
  std::vector<double> instants =
      BridgeSearch(evaluator_, solver_, crossing.bridge, crossing.from, crossing.to).singular_instants();
  // Instants before the present one were handled already.
  std::erase_if(instants, [&](double instant) { return (instant - now_.t) * h <= 0; });
  if (instants.empty()) {
    return follow_bridge(crossing.bridge, h > 0 ? std::min(crossing.to, target) : std::max(crossing.from, target));
  }
  const double first = h > 0 ? instants.front() : instants.back();
  centre_crossing(crossing, first, target, reach);
  for (double instant : instants) {
    if (instant > run_.latest + thresholds::same_instant * length ||
        instant < run_.earliest - thresholds::same_instant * length)
      continue;
    // Instants closer than their accuracy count as one.
    if (!singular_points_.empty() && instant != first &&
        std::abs(instant - singular_points_.back().t) < thresholds::same_instant * (crossing.to - crossing.from)) {
      continue;
    }
    SingularPoint point = look_at(crossing, instant);
    // Only the equations in use depend on each other; others replace them.
    if (point.nullity == 0) continue;
    if (!take_point(std::move(point), report)) return Passage::failed;
    if (stretch_.choice) break;
  }
  stretch_.bridge = std::move(crossing.bridge);
  stretch_.from = crossing.from;
  stretch_.to = crossing.to;
  if (stretch_.choice) (h > 0 ? stretch_.to : stretch_.from) = stretch_.choice->t;
  return Passage::passed;
}

// Records a singular configuration on the way, and whether another branch is taken there. False: there is no such
// branch.
bool Kinematics::take_point(SingularPoint point, Report& report) {
  const bool rests = point.kind == SingularPoint::Kind::rest;
  const bool branches = point.kind == SingularPoint::Kind::branch_point || (rests && point.tangents.size() > 1);
  if (options_.branch > 1 && branches) {
    if (options_.branch > static_cast<int>(point.tangents.size())) {
      report.status = Status::bifurcation;
      report.message =
          fmt::format("at t = {:.12g} s branch {} was asked for, but {} meet: {}", point.t, options_.branch,
                      point.tangents.size(), rests ? point.describe_ways() : point.describe_branches());
      singular_points_.push_back(std::move(point));
      return false;
    }
    stretch_.choice = point;
  }
  announce(point, report);
  singular_points_.push_back(std::move(point));
  return true;
}

// The stretch is not singular after all: the bridge crosses it.
Kinematics::Passage Kinematics::follow_bridge(const MotionBridge& bridge, double t) {
  evaluator_.set_time(t);
  bridge.evaluate(t, trial_, {}, {});
  fixed_.restore(now_.q, trial_, {}, {});
  newton_ = solver_.solve_position(trial_);
  if (!newton_.converged || newton_.first_correction > 1e3 * bridge_tolerance) return Passage::none;
  now_.q.swap(trial_);
  now_.t = t;
  now_.has_velocity = now_.has_acceleration = false;
  ++evaluator_.counters.steps;
  solver_.factor_at(now_.q);
  remember_margins();
  if (solver_.solve_velocity(now_.qd, false)) {
    now_.has_velocity = true;
    predictor_.push(now_.t, now_.q, now_.qd, {});
  }
  return Passage::regular;
}

void Kinematics::place_on_bridge(double t) {
  stretch_.bridge.evaluate(t, trial_, now_.qd, now_.qdd);
  fixed_.restore(now_.q, trial_, now_.qd, now_.qdd);
  now_.q.swap(trial_);
  now_.t = t;
  now_.has_velocity = now_.has_acceleration = now_.on_bridge = true;
  evaluator_.set_time(t);
  newton_ = {};
  newton_.converged = true;
  newton_.residual = solver_.residual_at(now_.q);
}

void Kinematics::leave_bridge(double end) {
  place_on_bridge(end);
  predictor_.clear();
  predictor_.push(now_.t, now_.q, now_.qd, now_.qdd);
  stretch_.bridge.clear();
  now_.on_bridge = false;
  solver_.factor_at(now_.q);
  curves_.found = evaluator_.curve_places();
  margins_.clear();
  remember_margins();
  choose_better_rows();
}

}  // namespace catena
