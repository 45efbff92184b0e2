#include "catena/analysis/pose/singular_start.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "catena/analysis/pose/dead_point.hpp"
#include "catena/analysis/pose/departure.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// After so much time (s) drivers that rest at the start are looked at again.
constexpr double moments[] = {1e-6, 1e-4, 1e-2, 1, 100};

/// Where the drivers rest: the branches along which the mechanism can go once they move, soon after, if they do.
void find_ways(Evaluator& evaluator, SingularPoint& point, double direction) {
  const double t = point.t;
  std::vector<double> nu(static_cast<std::size_t>(evaluator.plan().rows));
  for (double later : moments) {
    if (!functions_exist_at(evaluator, t + direction * later)) break;
    evaluator.set_time(t + direction * later);
    evaluator.nu(nu);
    if (std::all_of(nu.begin(), nu.end(), [](double rate) { return rate == 0; })) continue;
    const std::vector<double> q = point.q;
    point = find_branches(evaluator, q, {}, dependence::follows_at_start, Drivers::about_to_move);
    point.t = t;
    point.kind = SingularPoint::Kind::rest;
    break;
  }
  evaluator.set_time(t);
  if (point.driver >= 0) point.driver_value = evaluator.element_value(point.driver).f;
}

}  // namespace

SingularStart decide_start(Evaluator& evaluator, SingularPoint point, int branch, double direction,
                           std::string_view choose) {
  SingularStart start;
  const Model& model = evaluator.model();
  const bool rests = point.kind == SingularPoint::Kind::rest;
  if (point.kind == SingularPoint::Kind::lock_up) {
    start.report = point.report_lock_up(model);
    const Plan& plan = evaluator.plan();
    const bool tellable = point.nullity <= most_nullity && plan.rows - plan.columns + point.nullity <= most_dependences;
    if (tellable && !find_dead_point(evaluator, point.q, dependence::follows_at_start)) {
      start.report.status = Status::inconsistent;
      start.report.message = fmt::format(
          "no velocities meet all constraints and drivers at t = {:.12g} s, here or elsewhere; most concerned: driver "
          "\"{}\"; likely cause: drivers that contradict each other",
          point.t, point.driver >= 0 ? model.element_name(point.driver) : std::string());
    }
    start.point = std::move(point);
    return start;
  }
  if (rests) find_ways(evaluator, point, direction);
  const int count = static_cast<int>(point.tangents.size());
  // Drivers that never move ask for no direction.
  if (rests && (count == 0 || rate_of(evaluator, point.tangents.front()) == 0)) {
    start.report.status = Status::singular;
    start.report.message = fmt::format(
        "the motion starts at t = {:.12g} s in a singular configuration in which the drivers rest; start a little "
        "before or after it",
        point.t);
  } else if (count == 0 && point.nullity > most_nullity) {
    start.report.status = Status::singular;
    start.report.message = fmt::format(
        "the motion starts at t = {:.12g} s in a configuration that is singular in {} ways, more than branches are "
        "looked for ({}); start a little before or after it",
        point.t, point.nullity, most_nullity);
  } else if (count == 0) {
    start.report = point.report_lock_up(model);
  } else {
    start.branch = count == 1 ? 1 : branch;
    if (start.branch == 0 || start.branch > count) {
      start.report.status = Status::bifurcation;
      start.report.message = fmt::format("the motion starts at t = {:.12g} s where {}: {}; {}", point.t,
                                         rests ? "the drivers rest in a singular configuration" : "branches meet",
                                         rests ? point.describe_ways() : point.describe_branches(),
                                         branch == 0 ? fmt::format("{}, or start a little away", choose)
                                                     : fmt::format("\"branch\" asks for number {}", branch));
    }
  }
  start.point = std::move(point);
  return start;
}

double rate_of(const Evaluator& evaluator, std::span<const double> tangent) {
  double rate = 0;
  for (std::size_t k = 0; k < 3 * static_cast<std::size_t>(evaluator.plan().moving); ++k) {
    rate = std::max(rate, std::abs(tangent[k]) / (k % 3 == 2 ? 1 : evaluator.length_scale()));
  }
  return rate;
}

}  // namespace catena
