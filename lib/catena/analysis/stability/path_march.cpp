#include "catena/analysis/stability/path_march.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Steps shorter than this part of the usual one are kept though a critical point in them could not be located.
constexpr double unlocated_step = 1e-4;
// Iterations up to which the next step may be longer.
constexpr int few_iterations = 4;
// Rad: what a path may turn to one side and back between two points without being looked at more closely.
constexpr double unseen_turn = 1e-3;
// How far the end may be from where the tangent meets it, in parts of the way.
constexpr double largest_miss = 0.3;
// A step that would leave less than this part of itself to the end goes to the end: a whole number of equal steps
// misses it by rounding, and no step is as short as what is left then.
constexpr double nearly_there = 1e-3;

}  // namespace

Report Path::March::run(PathReport& report) {
  report_ = &report;
  if (Report start = find_start(); !start.ok()) return start;
  while (report.steps < options_.max_steps) {
    const Progress progress = step();
    ++report.steps;
    if (progress == Progress::finished) return {};
    if (progress == Progress::cancelled) return stopped();
    if (!changing_.empty()) {
      if (Report changed = change_gaps(); !changed.ok()) return changed;
    }
    if (progress == Progress::stuck) {
      if (const std::optional<double> value = system_.refused_value()) {
        return {Status::refused,
                fmt::format("the scene does not allow the value {:.10g} of the parameter: the path ends at {:.10g}, "
                            "and \"to\" must lie within what the parameter may be",
                            *value, x_.p),
                {}};
      }
      if (unjudged_) return unjudged();
      return {Status::step_too_small,
              fmt::format("the path could not be followed beyond {:.10g}: no solution even {:.1g} further on; likely "
                          "cause: it ends there, at a position that cannot be passed",
                          x_.p, shortest_arc),
              {}};
    }
  }
  return {Status::not_converged,
          fmt::format("{} steps led to {:.10g} and not to {:.10g}; likely cause: the path turns back, or winds; give a "
                      "larger max_steps or arc, or another value of \"to\"",
                      report.steps, x_.p, options_.to),
          {}};
}

// Why no row is written any more: an element is not defined, or the user stopped.
Report Path::March::stopped() const {
  return left_curve_.ok() ? Report{Status::cancelled, "stopped along the path", {}} : left_curve_;
}

std::optional<PathStability> Path::March::stability_of(const PathPoint& x) {
  const std::optional<PathStability> found = system_.stability();
  if (!found) unjudged_ = x.p;
  return found;
}

bool Path::March::judge(const PathPoint& x) {
  const std::optional<PathStability> found = stability_of(x);
  if (found) modes_ = *found;
  return found.has_value();
}

Report Path::March::unjudged() const {
  return {Status::not_converged,
          fmt::format("at the value {:.10g} of the parameter the small motions of the mechanism could not be computed, "
                      "and whether it is stable there is not known: the path ends before it; likely cause: stiffnesses "
                      "or masses too different in size",
                      *unjudged_),
          {}};
}

bool Path::March::write(const PathPoint& x) {
  system_.move_to(x);
  left_curve_ = watched_.check_ends();
  if (left_curve_.ok()) left_curve_ = watched_.check_ropes();
  if (!left_curve_.ok()) {
    left_curve_.message = fmt::format("at the value {:.10g} of the parameter: {}", x.p, left_curve_.message);
    return false;
  }
  report_->negative_modes.push_back(modes_.negative);
  if (system_.is_circulatory() && system_.lack_of_masses().empty()) report_->flutter.push_back(modes_.pairs);
  const Snapshot snapshot{.evaluator = path_.evaluator_,
                          .t = path_.t_,
                          .q = system_.q(),
                          .lambda = x.lambda,
                          .residual = path_.system_.phi_norm() * path_.system_.length()};
  return observe_(x.p, snapshot);
}

bool Path::March::is_smooth(const PathPoint& next, const PathPoint& direction) const {
  PathPoint travel{std::vector<double>(at(path_.plan_->columns)), {}, next.p - x_.p};
  for (int c = 0; c < path_.plan_->columns; ++c) {
    const std::size_t k = at(path_.plan_->coordinate[at(c)]);
    travel.q[at(c)] = next.q[k] - x_.q[k];
  }
  const double way = system_.product(travel, direction_);
  for (std::size_t c = 0; c < travel.q.size(); ++c) travel.q[c] -= way * direction_.q[c];
  travel.p -= way * direction_.p;
  const double turn = std::acos(std::min(system_.product(direction, direction_), 1.0));
  return std::sqrt(system_.product(travel, travel)) <= way * (turn + unseen_turn);
}

// The end itself where the prediction reaches it; false if it is not near the prediction: the path bends before it.
bool Path::March::step_to_end(PathPoint& next, double& s) {
  const double reach = (to_ - x_.p) / direction_.p;
  PathPoint point = system_.advanced(x_, direction_, reach);
  point.p = to_;
  const PathPoint predicted = point;
  if (system_.correct(point, predicted, system_.along_parameter(1), 0) < 0) return false;
  PathPoint travel{std::vector<double>(at(path_.plan_->columns)), {}, to_ - x_.p}, miss = travel;
  miss.p = 0;
  for (int c = 0; c < path_.plan_->columns; ++c) {
    const std::size_t k = at(path_.plan_->coordinate[at(c)]);
    travel.q[at(c)] = point.q[k] - x_.q[k];
    miss.q[at(c)] = point.q[k] - predicted.q[k];
  }
  if (std::sqrt(system_.product(miss, miss)) > largest_miss * reach) return false;
  next = std::move(point);
  next.p = to_;
  s = system_.product(travel, direction_);
  return true;
}

bool Path::March::find_end(PathPoint& next, double& s) {
  double low = 0, high = s, low_gap = x_.p - to_, high_gap = next.p - to_;
  for (int k = 0; k < thresholds::most_bisections && high - low > 1e-13; ++k) {
    double trial = low + (high - low) * low_gap / (low_gap - high_gap);
    if (k % 3 == 2) trial = 0.5 * (low + high);
    PathPoint point = system_.advanced(x_, direction_, trial);
    if (system_.correct(point, x_, direction_, trial) < 0) return false;
    const double gap = point.p - to_;
    next = point;
    s = trial;
    if (std::abs(gap) <= 1e-12 * std::abs(options_.to - options_.from)) break;
    (gap * low_gap > 0 ? low : high) = trial;
    (gap * low_gap > 0 ? low_gap : high_gap) = gap;
  }
  // The rest along the parameter, exactly.
  const PathPoint along = system_.along_parameter(1);
  PathPoint point = next;
  point.p = to_;
  PathPoint origin = point;
  if (system_.correct(point, origin, along, 0) < 0) return false;
  next = point;
  next.p = to_;
  return true;
}

bool Path::March::find_next(Trial& trial) {
  trial = {system_.advanced(x_, direction_, length_), length_, false, 0};
  trial.last =
      passes_end(x_.p, x_.p + (1 + nearly_there) * (trial.point.p - x_.p)) && step_to_end(trial.point, trial.s);
  if (!trial.last) {
    trial.iterations = system_.correct(trial.point, x_, direction_, length_);
    if (trial.iterations < 0) return false;
    trial.last = passes_end(x_.p, trial.point.p);
    if (trial.last && !find_end(trial.point, trial.s)) return false;
  }
  bool located = true;
  if (path_.system_.has_gaps() && change_within(trial.point, trial.s, located)) trial.last = false;
  return located;
}

// From the present point to the next one.
Path::March::Progress Path::March::step() {
  system_.forget_refused_value();
  unjudged_.reset();
  while (length_ > shortest_arc) {
    Trial trial;
    if (!find_next(trial)) {
      length_ *= 0.5;
      continue;
    }
    PathPoint& next = trial.point;
    if (trial.s == 0) return Progress::going;  // one-sided elements change where the path is
    if (!system_.factorize(next)) {
      length_ *= 0.9;
      continue;
    }
    const std::optional<PathStability> found = stability_of(next);
    if (!found) {
      length_ *= 0.9;
      continue;
    }
    const PathStability modes = *found;
    PathPoint direction = system_.tangent(next, direction_);
    if (system_.product(direction, direction_) < largest_bend || !is_smooth(next, direction)) {
      Side behind;
      bool written = false;
      if (find_corner(trial.s, behind) && go_round(std::move(behind), written))
        return written ? Progress::going : Progress::cancelled;
      length_ *= 0.5;
      continue;
    }
    bool left = false;
    if (modes != modes_) {
      bool complete = false;
      const std::vector<CriticalPoint> critical =
          find_critical_points(system_, {x_, direction_, trial.s, modes_, modes}, complete);
      if (!complete && length_ > unlocated_step * options_.arc) {
        // Modes that change without a critical point in between: the step went astray, onto another path.
        length_ *= 0.5;
        continue;
      }
      if (!complete) {
        report_->warnings.push_back(fmt::format("a critical point near {:.10g} could not be located", x_.p));
      }
      if (!pass(critical, left)) return Progress::cancelled;
    }
    if (left) {
      changing_.clear();
      return Progress::going;
    }
    x_ = std::move(next);
    direction_ = std::move(direction);
    modes_ = modes;
    changed_here_ = 0;
    if (!write(x_)) return Progress::cancelled;
    if (trial.last) return Progress::finished;
    if (trial.iterations <= few_iterations) length_ = std::min(1.5 * length_, options_.arc);
    return Progress::going;
  }
  return turn_back();
}

// Nothing ahead: the path ends, or turns back where a stiffness jumps.
Path::March::Progress Path::March::turn_back() {
  if (system_.refused_value() || unjudged_) return Progress::stuck;
  Side behind;
  bool written = false;
  if (find_turn(behind) && go_round(std::move(behind), written)) {
    length_ = 1e-3 * options_.arc;
    return written ? Progress::going : Progress::cancelled;
  }
  system_.forget_refused_value();
  unjudged_.reset();
  return Progress::stuck;
}

// Rows and records of the critical points in a step; `left`: the path went over to another branch. False: cancelled.
bool Path::March::pass(const std::vector<CriticalPoint>& points, bool& left) {
  for (const CriticalPoint& critical : points) {
    if (!write(critical.point)) return false;
    report_->critical.push_back({.branch = critical.branch,
                                 .flutter = critical.flutter,
                                 .omega = critical.omega,
                                 .value = critical.point.p,
                                 .row = static_cast<int>(report_->negative_modes.size()) - 1,
                                 .mode = describe_mode(path_.evaluator_, critical.mode, path_.system_.radius()),
                                 .modes = critical.modes});
    if (!critical.branch || options_.branch < 2 || switched_) continue;
    switched_ = true;
    left = leave(critical);
    if (left) return write(x_);
    report_->warnings.push_back(fmt::format(
        "the branch that leaves at {:.10g} could not be reached; the path goes straight on", critical.point.p));
  }
  return true;
}

// Onto the branch that crosses at the critical point, to the side asked for.
bool Path::March::leave(const CriticalPoint& critical) {
  const int columns = path_.plan_->columns;
  PathPoint side{critical.mode, std::vector<double>(at(path_.plan_->rows), 0.0), 0};
  const double along = system_.product(side, direction_);
  for (int c = 0; c < columns; ++c) side.q[at(c)] -= along * direction_.q[at(c)];
  side.p = -along * direction_.p;
  const double length = std::sqrt(system_.product(side, side)) * (options_.branch == 2 ? 1 : -1);
  for (double& v : side.q) v /= length;
  side.p /= length;
  for (double s = options_.arc; s > 1e-4 * options_.arc; s *= 0.5) {
    PathPoint next = system_.advanced(critical.point, side, s);
    if (system_.correct(next, critical.point, side, s) < 0 || !system_.factorize(next) || !judge(next)) continue;
    direction_ = system_.tangent(next, side);
    x_ = std::move(next);
    length_ = s;
    return true;
  }
  return false;
}

}  // namespace catena
