#include "catena/analysis/stability/path.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catena/analysis/balance/static_holding.hpp"
#include "catena/analysis/run/process_time.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/time_coverage.hpp"
#include "catena/analysis/run/watched_elements.hpp"
#include "catena/analysis/spectrum/certificate.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/spectrum/static_balance.hpp"
#include "catena/analysis/statics/static_search.hpp"

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

constexpr double shortest_step = 1e-9;
// Steps shorter than this part of the usual one are kept though a critical point in them could not be located.
constexpr double unlocated_step = 1e-4;
// Iterations after which the next step is shorter, and up to which it may be longer.
constexpr int many_iterations = 7, few_iterations = 4;
// The cosine between the directions at both ends of a step, at least.
constexpr double largest_bend = 0.9;
// Angle, rad, by which a path may turn to one side and back between two points without closer inspection.
constexpr double unseen_turn = 1e-3;
constexpr int most_end_trials = 60;
// Distance of the end from its prediction along the tangent, relative to the step.
constexpr double largest_miss = 0.3;

}  // namespace

// One run along the path.
class Path::March {
 public:
  March(Path& path, const std::function<bool(double, const Snapshot&)>& observe)
      : path_(path),
        system_(path.path_),
        options_(path.options_),
        observe_(observe),
        to_(path.options_.to),
        watched_(path.evaluator_) {}

  Report run(PathReport& report) {
    report_ = &report;
    if (Report start = find_start(); !start.ok()) return start;
    while (report.steps < options_.max_steps) {
      const Progress progress = step();
      ++report.steps;
      if (progress == Progress::finished) return {};
      if (progress == Progress::cancelled) return stopped();
      if (progress == Progress::stuck) {
        return {Status::step_too_small,
                fmt::format("the path could not be followed beyond {:.10g}: no solution even {:.1g} further on; likely "
                            "cause: it ends there, at a position that cannot be passed or a limit of the scene",
                            x_.p, shortest_step),
                {}};
      }
    }
    report.warnings.push_back(
        fmt::format("{} steps ended at {:.10g} and did not reach {:.10g}", report.steps, x_.p, options_.to));
    return {};
  }

  const PathPoint& point() const { return x_; }

 private:
  enum class Progress { going, finished, stuck, cancelled };

  // The equilibrium at the present value: the configuration itself if it is one, else the nearest stable one.
  Report find_start() {
    StaticSystem& statics = path_.system_;
    if (Report assembly = assemble_for_statics(statics, path_.q_); !assembly.ok()) return assembly;
    if (std::optional<Report> loose = find_loose_bodies(statics, path_.evaluator_)) return *loose;
    x_.lambda.assign(at(path_.plan_->rows), 0.0);
    const Imbalance left = balance_loads(statics, x_.lambda);
    StaticSearch search(statics, {.stationary = left.negligible(), .warm = left.negligible()});
    StaticResult result = search.find(path_.q_, x_.lambda);
    if (!result.report.ok()) return result.report;
    if (result.certificate.neutral) {
      return {Status::singular,
              fmt::format("the path cannot start where the equilibrium is neutral: nothing resists {}; hold them, or "
                          "start at another value of the parameter",
                          describe_free_motions(result.certificate.neutral_modes, result.certificate.free_bodies)),
              {}};
    }
    x_.q = path_.q_;
    x_.p = options_.from;
    direction_ = system_.along_parameter(options_.to - options_.from);
    if (!system_.factorize(x_)) {
      return {Status::singular, "the path starts at a critical point; start at another value of the parameter", {}};
    }
    modes_ = system_.negative_modes();
    direction_ = system_.tangent(x_, direction_);
    length_ = options_.arc;
    return write(x_) ? Report{} : stopped();
  }

  // Why no row is written any more: an element has left its curve, or the user stopped.
  Report stopped() const {
    return left_curve_.ok() ? Report{Status::cancelled, "stopped along the path", {}} : left_curve_;
  }

  bool write(const PathPoint& x) {
    system_.move_to(x);
    if (left_curve_ = watched_.check_ends(); !left_curve_.ok()) {
      left_curve_.message = fmt::format("at the value {:.10g} of the parameter: {}", x.p, left_curve_.message);
      return false;
    }
    report_->negative_modes.push_back(modes_);
    const Snapshot snapshot{.evaluator = path_.evaluator_,
                            .t = path_.t_,
                            .q = system_.q(),
                            .lambda = x.lambda,
                            .residual = path_.system_.phi_norm() * path_.evaluator_.length_scale()};
    return observe_(x.p, snapshot);
  }

  bool passes_end(double before, double after) const { return (before - to_) * (after - to_) <= 0 && before != to_; }

  // Whether one smooth path leads from the present point to the next one: its relative deviation from the tangent is no
  // larger than the turn of its direction. A path that ends and another that begins beside it do not satisfy this.
  bool is_smooth(const PathPoint& next, const PathPoint& direction) const {
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
  bool step_to_end(PathPoint& next, double& s) {
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

  // The point with the wanted value of the parameter between the start of the step and `s`; then s is its place.
  bool find_end(PathPoint& next, double& s) {
    double low = 0, high = s, low_gap = x_.p - to_, high_gap = next.p - to_;
    for (int k = 0; k < most_end_trials && high - low > 1e-13; ++k) {
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

  // From the present point to the next one.
  Progress step() {
    while (length_ > shortest_step) {
      PathPoint next = system_.advanced(x_, direction_, length_);
      double s = length_;
      bool last = passes_end(x_.p, next.p) && step_to_end(next, s);
      int iterations = 0;
      if (!last) {
        iterations = system_.correct(next, x_, direction_, length_);
        if (iterations < 0) {
          length_ *= 0.5;
          continue;
        }
        last = passes_end(x_.p, next.p);
        if (last && !find_end(next, s)) {
          length_ *= 0.5;
          continue;
        }
      }
      if (!system_.factorize(next)) {
        length_ *= 0.9;
        continue;
      }
      const int modes = system_.negative_modes();
      PathPoint direction = system_.tangent(next, direction_);
      if (system_.product(direction, direction_) < largest_bend || !is_smooth(next, direction)) {
        length_ *= 0.5;
        continue;
      }
      bool left = false;
      if (modes != modes_) {
        bool complete = false;
        const std::vector<CriticalPoint> critical =
            find_critical_points(system_, {x_, direction_, s, modes_, modes}, complete);
        if (!complete && length_ > unlocated_step * options_.arc) {
          // Modes that change without a critical point in between: the step has jumped to another path.
          length_ *= 0.5;
          continue;
        }
        if (!complete) {
          report_->warnings.push_back(fmt::format("a critical point near {:.10g} could not be located", x_.p));
        }
        if (!pass(critical, left)) return Progress::cancelled;
      }
      if (left) return Progress::going;
      x_ = std::move(next);
      direction_ = std::move(direction);
      modes_ = modes;
      if (!write(x_)) return Progress::cancelled;
      if (last) return Progress::finished;
      if (iterations <= few_iterations) length_ = std::min(1.5 * length_, options_.arc);
      if (iterations >= many_iterations) length_ *= 0.6;
      return Progress::going;
    }
    return Progress::stuck;
  }

  // Rows and records of the critical points in a step; `left`: the path went over to another branch. False: cancelled.
  bool pass(const std::vector<CriticalPoint>& points, bool& left) {
    for (const CriticalPoint& critical : points) {
      if (!write(critical.point)) return false;
      report_->critical.push_back({.branch = critical.branch,
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

  // Onto the branch that crosses at the critical point, to the requested side.
  bool leave(const CriticalPoint& critical) {
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
      if (system_.correct(next, critical.point, side, s) < 0 || !system_.factorize(next)) continue;
      modes_ = system_.negative_modes();
      direction_ = system_.tangent(next, side);
      x_ = std::move(next);
      length_ = s;
      return true;
    }
    return false;
  }

  Path& path_;
  PathSystem& system_;
  const PathOptions& options_;
  const std::function<bool(double, const Snapshot&)>& observe_;
  PathReport* report_ = nullptr;
  PathPoint x_, direction_;
  double to_, length_ = 0;
  WatchedElements watched_;
  Report left_curve_;
  int modes_ = 0;
  bool switched_ = false;
};

Path::Path(std::shared_ptr<const Model> model, ModelAt model_at, const PathOptions& options,
           const PlanOptions& plan_options)
    : model_(std::move(model)),
      plan_(Plan::make(required(model_), plan_options)),
      model_at_(std::move(model_at)),
      options_(options),
      evaluator_(plan_, *model_),
      system_(evaluator_),
      path_(system_, model_at_, options.from, std::max(std::abs(options.to - options.from), 1e-300)),
      q_(evaluator_.given_configuration()) {
  if (!model_at_)
    throw std::invalid_argument("path: there is nothing that makes models at other values of the parameter");
  if (!std::isfinite(options.from) || !std::isfinite(options.to))
    throw std::invalid_argument("path: the values from and to of the parameter must be finite");
  if (!(options.arc > 0) || !std::isfinite(options.arc))
    throw std::invalid_argument("path: arc, the length of a step, must be above zero");
}

void Path::start_from(const SystemState& state) {
  t_ = state.t;
  q_ = configuration_of(evaluator_, state);
}

SystemState Path::state() const { return state_of(evaluator_, t_, q_); }

Report Path::follow(PathReport& report, const std::function<bool(double, const Snapshot&)>& observe) {
  evaluator_.set_time(t_);
  path_.set_time(t_);
  if (!evaluator_.conservative()) {
    return {Status::refused,
            "follower forces have no energy, and paths of forces without one are not built; give the forces in ground "
            "axes",
            {}};
  }
  if (options_.to == options_.from) {
    return {Status::refused, "the path ends where it begins: \"to\" is the present value of the parameter", {}};
  }
  March march(*this, observe);
  Report outcome = march.run(report);
  if (!march.point().q.empty()) {
    path_.move_to(march.point());
    q_.assign(path_.q().begin(), path_.q().end());
  }
  return outcome;
}

PathReport Path::run(const std::function<bool(double, const Snapshot&)>& observe) {
  const ProcessTimer timer;
  PathReport report;
  report.bodies = static_cast<int>(model_->bodies.size());
  report.rows = plan_->rows;
  report.islands = plan_->islands;
  Report outcome = check_time_functions(*model_, {t_, t_});
  if (outcome.ok()) outcome = follow(report, observe);
  report.status = outcome.status;
  report.message = std::move(outcome.message);
  report.warnings.insert(report.warnings.end(), outcome.warnings.begin(), outcome.warnings.end());
  report.counters = evaluator_.counters;
  report.seconds = timer.seconds();
  return report;
}

}  // namespace catena
