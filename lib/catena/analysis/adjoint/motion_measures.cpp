#include "catena/analysis/adjoint/motion_measures.hpp"

#include <fmt/format.h>

#include "catena/analysis/adjoint/column_slopes.hpp"
#include "catena/base/at.hpp"

namespace catena {

void MotionMeasures::cover(const MotionStretch& stretch) {
  MotionAdjoint::cover(stretch);
  ended_by_ = {};
  const bool acts = stretch.ends_phase && stretch.ended_by >= 0 && at(stretch.ended_by) < events_.size();
  if (!acts || !why().empty()) return;
  ended_by_.event = stretch.ended_by;
  ended_by_.by_time = rate_at_end(stretch, events_[at(stretch.ended_by)].column);
}

void MotionMeasures::begin(const MotionPhase& phase) {
  if (!why().empty()) return;
  const std::optional<double> reached = covered_to();
  const auto strikes = [](const VelocityJump& jump) { return jump.places.empty() && !jump.other_law && !jump.settles; };
  if (!reached && phase.jumps.empty() && phase.events.empty()) {
    released_ = phase.released;
    if (!phase.states.empty()) lose(phase.t, "contacts act");
  } else if (!reached || phase.t != *reached) {
    lose(phase.t, "an event acts where the motion begins");
  } else if (!phase.states.empty() || phase.released != released_ ||
             !std::all_of(phase.jumps.begin(), phase.jumps.end(), strikes)) {
    lose(phase.t, "constraints or contacts come or go");
  } else if (phase.functions_jump && phase.events.empty()) {
    go_on_otherwise({.jumps = true, .strikes = {}, .rate = instant_at(phase.t).rate});
  } else if (crosses_at(phase.t) || phase.events.size() != 1 || phase.jumps.size() > 1 ||
             phase.events.front() != ended_by_.event) {
    lose(phase.t, "several events act at once, or one where a function of time jumps");
  } else if (!ended_by_.by_time || *ended_by_.by_time == 0) {
    lose(phase.t, "an event acts whose column does not change at a rate that is known");
  } else {
    const DesignEvent& event = events_[at(ended_by_.event)];
    go_on_otherwise({.jumps = true,
                     .strikes = phase.jumps.empty() ? std::vector<DesignStrike>{} : event.strikes,
                     .rate = {},
                     .event = ended_by_.event,
                     .by_time = *ended_by_.by_time});
  }
}

MotionAdjoint::EventSlopes MotionMeasures::slopes_of_event(int number, const Snapshot& before) {
  const DesignEvent& event = events_[at(number)];
  for (DesignMechanism* mechanism : mechanisms()) mechanism->set_time(before.t, Side::before);
  ColumnSlopes slopes(evaluator().model(), event.column, mechanisms(), parameters());
  slopes.look(before);
  StateSlopes sum = slopes.empty();
  slopes.add(0, 1, sum);
  for (std::size_t p = 0; p < sum.by_p.size(); ++p) sum.by_p[p] -= event.value_rate[p];
  return {{before.t, std::move(sum.by_q), std::move(sum.by_qd), std::move(sum.by_qdd), std::move(sum.by_lambda)},
          std::move(sum.by_p)};
}

void MotionMeasures::keep(const Snapshot& snapshot) {
  if (!why().empty()) return;
  const auto copy = [](std::span<const double> values) { return std::vector<double>(values.begin(), values.end()); };
  const auto [place, is_new] = states_.try_emplace(snapshot.t);
  // Where the motion goes on in another way measures look at the state after that.
  if (is_new || crosses_at(snapshot.t))
    place->second = {copy(snapshot.q), copy(snapshot.qd), copy(snapshot.qdd), copy(snapshot.lambda)};
}

std::optional<MotionAdjoint::Gradients> MotionMeasures::find_gradients(
    const ColumnSet& columns, const std::vector<std::vector<ColumnPulse>>& pulses) {
  if (columns.needs().work) fail("work and dissipated energy, which are summed up over time, have no derivative");
  if (!why().empty()) return {};
  const std::vector<DesignMechanism*> designs = mechanisms();
  ColumnSlopes slopes(evaluator().model(), columns, designs, parameters());
  struct Part {
    std::size_t measure, column;
    double weight;
  };
  std::map<double, std::vector<Part>> looks;
  Gradients own(pulses.size(), std::vector<double>(static_cast<std::size_t>(parameters()), 0.0));
  std::vector<std::vector<MotionPulse>> motion(pulses.size());
  for (std::size_t m = 0; m < pulses.size(); ++m) {
    for (const ColumnPulse& pulse : pulses[m]) {
      if (pulse.column != ColumnPulse::by_instant) {
        looks[pulse.t].push_back({m, pulse.column, pulse.weight});
      } else if (crosses_at(pulse.t)) {
        motion[m].push_back({pulse.t, {}, {}, {}, {}, pulse.weight});
      }
    }
  }
  for (const auto& [t, parts] : looks) {
    const auto state = states_.find(t);
    if (state == states_.end()) {
      fail(fmt::format(
          "the motion was not looked at at t = {:.9g} s, where a function of time has a breakpoint or an event acts",
          t));
      return {};
    }
    const State& s = state->second;
    for (DesignMechanism* mechanism : designs) mechanism->set_time(t);
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
