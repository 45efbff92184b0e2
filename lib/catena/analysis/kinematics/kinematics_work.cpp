// Inverse dynamics: the motion is followed from point to point of the stretches over which work is summed up
// (work_sum.hpp). They end at breakpoints of functions of time, where powers may jump.
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <span>
#include <vector>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/run/breakpoints.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {

namespace {

bool has_breakpoint(const Model& model, double t) {
  const auto breaks = [t](const TimeFunction<double>& function) { return is_breakpoint(function, t); };
  return std::any_of(model.functions.begin(), model.functions.end(), breaks);
}

/// Which way joints with friction slip, at the evaluator's configuration; of smoothed friction also whether tanh is
/// nearly straight (below vs), bends (below 4 vs) or is 1 to 7e-4 and less.
std::vector<int> ways_of_slips(const Evaluator& evaluator, std::span<const double> qd) {
  std::vector<int> ways;
  const double none = no_speed * fastest(evaluator, qd);
  for (const ContactPoint& joint : joints_with_friction(evaluator.model())) {
    const double rate = evaluator.scalar_motion(joint.slide, qd).rate;
    const int way = direction_of(rate, rate_of_speed(joint, none, evaluator.length_scale()));
    const double part = joint.is_exact() ? 0 : std::abs(rate) / joint.smoothing;
    ways.push_back(way * (part < 1 ? 1 : part < 4 ? 2 : 3));
  }
  return ways;
}

}  // namespace

// Begins at the present instant, which is assembled.
Report Kinematics::start_work() {
  if (stretch_.covers(now_.t)) {
    place_on_bridge(now_.t);
  } else {
    evaluator_.set_time(now_.t);
    newton_ = solver_.solve_position(now_.q);
  }
  if (Report solved = find_rates({.velocity = true, .acceleration = true}); !solved.ok()) return solved;
  work_.begin(evaluator_);
  work_.take_initial_energy(snapshot());
  return {};
}

// The time in which no body moves further than a stretch of at most `limit` may.
double Kinematics::stretch_length(double limit) const {
  return work_.stretch_length(limit, solver_.rate_size(now_.qd), solver_.rate_size(now_.qdd));
}

// The powers at an end of a stretch as they are in it: functions of time, and with them velocities, may jump there.
void Kinematics::see_end_of_stretch(bool first, Side inside) {
  const bool jumps = has_breakpoint(*model_, now_.t);
  if (inside == Side::after || !jumps || now_.on_bridge) return work_.see_end(first, now_.qd);
  std::vector<double> qd(now_.qd);
  evaluator_.set_time(now_.t, inside);
  if (!solver_.solve_velocity(qd, true)) qd = now_.qd;
  work_.see_end(first, qd);
  evaluator_.set_time(now_.t);
}

// One stretch further, to t: the powers inside, then the rates there. `error`: estimate of that of the sums, J. Where
// friction reverses, or what presses comes through zero, what it takes bends, and what the driver gives with it, so
// that the gap of energies does not show it: such a stretch counts as wrong by the largest power that bends times its
// length.
Report Kinematics::sum_up_stretch(double t, double& error, std::vector<std::string>& warnings) {
  const double from = now_.t;
  const bool rubs = !reactions_.friction().empty();
  const std::vector<int> ways = rubs ? ways_of_slips(evaluator_, now_.qd) : std::vector<int>();
  double most_lost = 0;
  work_.begin_stretch(snapshot());
  see_end_of_stretch(true, t > from ? Side::after : Side::before);
  const auto visit = [&](double instant, const Needs& needs) -> Report {
    Report moved = follow_to(instant);
    std::move(moved.warnings.begin(), moved.warnings.end(), std::back_inserter(warnings));
    moved.warnings.clear();
    if (!moved.ok()) return moved;
    if (Report solved = find_rates(needs); !solved.ok()) return solved;
    predictor_.push(now_.t, now_.q, now_.qd, now_.qdd);
    return {};
  };
  for (std::size_t k = 0; k < WorkSum::places.size(); ++k) {
    Report moved =
        visit(from + (t - from) * WorkSum::places[k], {.velocity = true, .acceleration = true, .multipliers = true});
    if (!moved.ok()) return moved;
    work_.add_point(k, t - from, now_.qd, reactions_.multipliers(), reactions_.dissipation());
    if (rubs) reactions_.read_pressing(now_.qd, work_.pressing(1 + k));
    most_lost = std::max(most_lost, reactions_.dissipation());
  }
  if (Report moved = visit(t, {.velocity = true, .acceleration = true}); !moved.ok()) return moved;
  see_end_of_stretch(false, t > from ? Side::before : Side::after);
  error = work_.stretch_error(t - from, snapshot());
  if (!rubs) return {};
  const std::vector<int> ways_there = ways_of_slips(evaluator_, now_.qd);
  std::vector<Vec2<double>>& pressing = work_.pressing(WorkSum::places.size() + 1);
  pressing.clear();
  const bool rests = std::find(ways_there.begin(), ways_there.end(), 0) != ways_there.end();
  if (!rests && stretch_.empty() && !has_breakpoint(*model_, t)) {
    if (Report solved = find_rates({.velocity = true, .acceleration = true, .multipliers = true}); !solved.ok())
      return solved;
    reactions_.read_pressing(now_.qd, pressing);
  }
  const double bends = ways_there != ways ? most_lost : work_.turning_power();
  error = std::max(error, bends * std::abs(t - from));
  return {};
}

// To t, from an instant whose rates are known, with the work done on the way.
Report Kinematics::move_and_sum_up(double t) {
  Report total;
  const double start = now_.t;
  const std::vector<double> places = now_.q;
  std::vector<double> ends;
  for (const auto& function : model_->functions) {
    const std::vector<double> breaks = function.breakpoints(std::min(now_.t, t), std::max(now_.t, t));
    ends.insert(ends.end(), breaks.begin(), breaks.end());
  }
  std::sort(ends.begin(), ends.end());
  if (t < now_.t) std::reverse(ends.begin(), ends.end());
  ends.push_back(t);
  for (double end : ends) {
    while (now_.t != end) {
      // Equal stretches, none of them very short.
      const double from = now_.t, way = std::abs(end - from), count = std::ceil(way / stretch_length(way) * (1 - 1e-9));
      const double to = count > 1 ? from + (end - from) / count : end;
      if (to == from) break;
      double error = 0;
      if (Report summed = sum_up_stretch(to, error, total.warnings); !summed.ok()) {
        // Right before a dead point rates cannot be told from rounding: places alone lead on to it, from further away.
        if (summed.status != Status::singular) return summed;
        if (stretch_.empty()) {
          now_.t = start;
          now_.q = places;
          now_.has_velocity = now_.has_acceleration = false;
          predictor_.clear();
        }
        if (Report moved = follow_to(t); !moved.ok()) return moved;
        std::optional<SingularPoint> point = dead_point_here();
        return point ? lock_up(std::move(*point)) : summed;
      }
      const double allowed = work_.allowed_error(snapshot());
      // Repeated in shorter stretches; but not across a singular configuration, which is passed only once.
      const bool divisible =
          std::abs(to - from) > thresholds::carried_rounding * std::max(std::abs(from), std::abs(to));
      const bool poor = error > allowed || work_.skips_switches();
      if (poor && divisible && work_.can_be_shorter() && stretch_.empty()) {
        if (Report moved = follow_to(from); !moved.ok()) return moved;
        if (Report solved = find_rates({.velocity = true, .acceleration = true}); !solved.ok()) return solved;
        work_.take_back();
        continue;
      }
      work_.keep(error, allowed);
    }
  }
  return total;
}

}  // namespace catena
