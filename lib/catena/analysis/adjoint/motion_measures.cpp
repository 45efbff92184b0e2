#include "catena/analysis/adjoint/motion_measures.hpp"

#include <fmt/format.h>

#include "catena/analysis/adjoint/column_slopes.hpp"

namespace catena {

void MotionMeasures::keep(const Snapshot& snapshot) {
  if (!why().empty()) return;
  const auto copy = [](std::span<const double> values) { return std::vector<double>(values.begin(), values.end()); };
  const auto [place, is_new] = states_.try_emplace(snapshot.t);
  if (is_new) place->second = {copy(snapshot.q), copy(snapshot.qd), copy(snapshot.qdd), copy(snapshot.lambda)};
}

std::optional<MotionAdjoint::Gradients> MotionMeasures::find_gradients(
    const ColumnSet& columns, const std::vector<std::vector<ColumnPulse>>& pulses) {
  if (columns.needs().work) fail("work and dissipated energy, which are summed up over time, have no derivative");
  if (!why().empty()) return {};
  std::vector<DesignMechanism*> mechanisms;
  for (Group& group : groups()) mechanisms.push_back(&group.mechanism);
  ColumnSlopes slopes(evaluator().model(), columns, mechanisms, parameters());
  struct Part {
    std::size_t measure, column;
    double weight;
  };
  std::map<double, std::vector<Part>> looks;
  for (std::size_t m = 0; m < pulses.size(); ++m) {
    for (const ColumnPulse& pulse : pulses[m]) looks[pulse.t].push_back({m, pulse.column, pulse.weight});
  }
  Gradients own(pulses.size(), std::vector<double>(static_cast<std::size_t>(parameters()), 0.0));
  std::vector<std::vector<MotionPulse>> motion(pulses.size());
  for (const auto& [t, parts] : looks) {
    const auto state = states_.find(t);
    if (state == states_.end()) {
      fail(fmt::format("the motion was not looked at at t = {:.9g} s, where a function of time has a breakpoint", t));
      return {};
    }
    const State& s = state->second;
    for (DesignMechanism* mechanism : mechanisms) mechanism->set_time(t);
    slopes.look({.evaluator = evaluator(), .t = t, .q = s.q, .qd = s.qd, .qdd = s.qdd, .lambda = s.lambda});
    std::map<std::size_t, StateSlopes> of_measure;
    for (const Part& part : parts)
      slopes.add(part.column, part.weight, of_measure.try_emplace(part.measure, slopes.empty()).first->second);
    for (auto& [m, sum] : of_measure) {
      for (std::size_t p = 0; p < own[m].size(); ++p) own[m][p] += sum.by_p[p];
      motion[m].push_back(
          {t, std::move(sum.by_q), std::move(sum.by_qd), std::move(sum.by_qdd), std::move(sum.by_lambda)});
    }
  }
  std::optional<Gradients> gradients = MotionAdjoint::gradients(motion);
  if (!gradients) return {};
  for (std::size_t m = 0; m < own.size(); ++m) {
    for (std::size_t p = 0; p < own[m].size(); ++p) (*gradients)[m][p] += own[m][p];
  }
  return gradients;
}

}  // namespace catena
