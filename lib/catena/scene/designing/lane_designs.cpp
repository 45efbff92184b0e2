#include "catena/scene/designing/lane_designs.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "catena/scene/designing/lane_motion_designs.hpp"
#include "catena/scene/designing/lane_rest_designs.hpp"

namespace catena {
namespace {

/// Empty, or why no analysis of such a sweep can be computed in lanes.
std::string obstacle_of(const AnalysisContext& context) {
  if (context.task.of.size() != 1) return "it repeats more than one analysis";
  if (context.poses) return "its designs are drawn";
  if (!context.state.q.empty() || context.state.t != 0) return "it goes on from where an analysis before it ended";
  for (const PlacedMeasure& measure : context.task.of.front().measures) {
    const auto& columns = measure.request.columns;
    // What rounding leaves of the equations is another number in every order of operations.
    if (std::find(columns.begin(), columns.end(), "residual") != columns.end())
      return fmt::format("measure \"{}\" is of rounding", measure.request.name);
  }
  return {};
}

}  // namespace

std::unique_ptr<LaneDesigns> LaneDesigns::make(const AnalysisContext& context, std::string& why_not) {
  why_not = obstacle_of(context);
  if (!why_not.empty()) return nullptr;
  const std::string_view type = context.task.of.front().type();
  if (type == "equilibrium") return LaneRestDesigns::make(context, why_not);
  if (type == "kinematics" || type == "inverse_dynamics") return LaneMotionDesigns::make(context, why_not);
  why_not = fmt::format("{} is not computed in lanes, only kinematics, inverse_dynamics and equilibrium are", type);
  return nullptr;
}

}  // namespace catena
