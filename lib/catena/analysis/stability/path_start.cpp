#include "catena/analysis/stability/path_start.hpp"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "catena/analysis/balance/static_holding.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/spectrum/static_balance.hpp"
#include "catena/analysis/stability/path_march.hpp"
#include "catena/analysis/statics/active_set_at.hpp"
#include "catena/analysis/statics/static_search.hpp"

namespace catena {
namespace {

// Parts of the parameter's range; see the header.
constexpr double beside = 1e-3;

/// The step along the path that begins beside x, before it (side -1) or behind it (1) in the sense of `direction`, and
/// leads across x as far again.
std::optional<CriticalStart> step_across(PathSystem& system, const PathPoint& x, const PathPoint& direction,
                                         double side) {
  PathPoint from = system.advanced(x, direction, side * beside);
  // With the multipliers of x its stiffness would still be that at x: none.
  if (!system.move_to(from)) return {};
  balance_loads(system.statics(), from.lambda);
  if (system.correct(from, x, direction, side * beside) < 0 || !system.factorize(from)) return {};
  const std::optional<PathStability> modes_there = system.stability();
  if (!modes_there) return {};
  const PathPoint outwards = system.tangent(from, system.along_parameter(side * direction.p));
  const PathPoint tangent = system.tangent(from, system.along_parameter(-side * direction.p));
  PathPoint way{tangent.q, {}, x.p - from.p};
  for (std::size_t c = 0; c < way.q.size(); ++c) {
    const auto k = static_cast<std::size_t>(system.statics().plan().coordinate[c]);
    way.q[c] = x.q[k] - from.q[k];
  }
  PathStep step{.start = from, .tangent = tangent, .s = 2 * system.product(way, tangent), .modes_before = *modes_there};
  PathPoint to = system.advanced(from, step.tangent, step.s);
  if (system.correct(to, from, step.tangent, step.s) < 0 || !system.factorize(to)) return {};
  const std::optional<PathStability> modes_after = system.stability();
  if (!modes_after) return {};
  step.modes_after = *modes_after;
  CriticalStart start;
  start.direction = side < 0 ? system.tangent(to, step.tangent) : outwards;
  start.modes_before = side < 0 ? step.modes_before : step.modes_after;
  start.modes_after = side < 0 ? step.modes_after : step.modes_before;
  bool complete = false;
  std::vector<CriticalPoint> found = find_critical_points(system, step, complete);
  if (!complete || found.size() != 1) return {};
  start.critical = std::move(found.front());
  return start;
}

}  // namespace

std::optional<CriticalStart> look_around(PathSystem& system, const PathPoint& x, const PathPoint& direction) {
  std::optional<CriticalStart> start = step_across(system, x, direction, -1);
  if (!start) start = step_across(system, x, direction, 1);
  system.move_to(x);
  return start;
}

// The equilibrium at the present value: the configuration itself if it is one, else the nearest stable one.
Report Path::March::take_place(Imbalance& left) {
  StaticSystem& statics = path_.system_;
  x_.lambda.assign(static_cast<std::size_t>(path_.plan_->rows), 0.0);
  if (!statics.has_gaps()) {
    if (Report assembly = assemble_for_statics(statics, path_.q_); !assembly.ok()) return assembly;
    left = balance_loads(statics, x_.lambda);
    return {};
  }
  const std::vector<double> given = path_.q_;
  if (!close_gaps_at(statics, path_.q_, x_.lambda, gaps_, left).ok()) {
    // A search for the place of rest begins from anywhere.
    path_.q_ = given;
    left.relative = left.force = std::numeric_limits<double>::infinity();
    statics.use_gaps();
    statics.move_to(path_.q_);
  }
  return {};
}

Report Path::March::find_start() {
  StaticSystem& statics = path_.system_;
  Imbalance left;
  if (Report placed = take_place(left); !placed.ok()) return placed;
  if (std::optional<Report> loose = find_loose_bodies(statics, path_.evaluator_)) return *loose;
  StaticSearch search(statics, {.stationary = left.negligible(), .warm = left.negligible()});
  StaticResult result = search.find(path_.q_, x_.lambda);
  if (!result.report.ok()) return result.report;
  if (statics.has_gaps()) {
    gaps_ = result.gaps;
    for (std::string& remark : remarks_on(path_.evaluator_, gaps_)) report_->warnings.push_back(std::move(remark));
    for (std::size_t k = 0; k < gaps_.closed.size(); ++k) gaps_.closed[k] = gaps_.closed[k] && !gaps_.weak[k];
    report_->active = names_of_closed(path_.evaluator_, gaps_);
    statics.close_gaps(gaps_.closed);
    for (std::size_t k = 0; k < gaps_.closed.size(); ++k) {
      if (!gaps_.closed[k]) x_.lambda[static_cast<std::size_t>(path_.plan_->gap_rows[k])] = 0;
    }
  }
  x_.q = path_.q_;
  x_.p = options_.from;
  length_ = options_.arc;
  direction_ = system_.along_parameter(options_.to - options_.from);
  if (result.stability) {
    result.certificate.neutral_modes = result.stability->motions.neutral;
    result.certificate.neutral = result.certificate.neutral_modes > 0;
    result.certificate.free_bodies = result.free_bodies;
  }
  if (result.certificate.neutral || !system_.factorize(x_)) return start_at_critical_point(result.certificate);
  if (!judge(x_)) return unjudged();
  direction_ = system_.tangent(x_, direction_);
  return write(x_) ? Report{} : stopped();
}

// A start without stiffness against some motion: where paths cross, one of them must have been chosen.
Report Path::March::start_at_critical_point(const Certificate& certificate) {
  const std::optional<CriticalStart> start = look_around(system_, x_, direction_);
  if (!start) {
    return {Status::singular,
            fmt::format("the path cannot start where the equilibrium is neutral: nothing resists {}; hold them, or "
                        "start at another value of the parameter",
                        describe_free_motions(certificate.neutral_modes, certificate.free_bodies)),
            {}};
  }
  const std::string mode = describe_mode(path_.evaluator_, start->critical.mode, path_.system_.radius());
  if (!start->critical.branch) {
    return {Status::singular,
            fmt::format("the path starts at a limit point, where the parameter turns back and stiffness against {} "
                        "is lost, at the value {:.10g}; start at another value of the parameter",
                        mode, x_.p),
            {}};
  }
  if (options_.branch == 0) {
    return {Status::bifurcation,
            fmt::format("the path starts at the value {:.10g} of the parameter, where another path crosses that "
                        "leaves by {}; choose with \"branch\": 1 goes straight on, 2 and 3 leave to either side; or "
                        "start at another value",
                        x_.p, mode),
            {}};
  }
  modes_ = start->modes_before;
  direction_ = start->direction;
  CriticalPoint critical = start->critical;
  critical.point = x_;
  bool left = false;
  if (!pass({critical}, left)) return stopped();
  if (!left) modes_ = start->modes_after;
  return {};
}

}  // namespace catena
