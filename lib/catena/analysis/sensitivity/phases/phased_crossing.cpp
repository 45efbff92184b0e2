// PhasedDerivatives where one phase goes over into the next.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/analysis/sensitivity/phases/phased_derivatives.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
// Rates of two conditions of one instant that differ by less than this part are one: they are good to 1e-8.
constexpr double one_rate = 1e-6;
// Accelerations that differ by less than this part of their size are the same on both sides of an instant.
constexpr double no_jump_of_slopes = 1e-9;
// Of its size, or of 1: a column is at the value of an event that comes together with another one, both found to
// rounding.
constexpr double is_at_value = 1e-12;
// One that changes by less than this part in the stretch stays at its value, and has no event there.
constexpr double stays_at_value = 1e-9;
// Differences for rates begin with this part of a stretch, and are halved until they settle to the second part; those
// that have not settled to the third one tell nothing, as in a stretch that is no longer than rounding.
constexpr double first_part = 1.0 / 16, settled_rate = 1e-10, unsettled_rate = 1e-5;
constexpr int most_halved = 12;

bool is_one(double a, double b) { return std::abs(a - b) <= one_rate * std::max(std::abs(a), std::abs(b)); }

/// The rates of an instant that is given by two conditions; where they move apart it has none.
void join(std::vector<double>& rate, const std::vector<double>& other) {
  for (std::size_t p = 0; p < rate.size(); ++p) {
    if (!is_one(rate[p], other[p])) rate[p] = unknown;
  }
}

}  // namespace

// df/dt at the end of a stretch, from its inside: differences of order 4.
std::optional<double> PhasedDerivatives::rate_along(const MotionStretch& stretch,
                                                    const std::function<std::optional<double>(double)>& f) {
  constexpr double weights[] = {25, -48, 36, -16, 3};
  const std::optional<double> end = f(stretch.to);
  if (!end) return {};
  double best = unknown, last = unknown, change = std::numeric_limits<double>::infinity();
  for (int n = 0; n < most_halved; ++n) {
    const double d = std::ldexp(first_part * (stretch.to - stretch.from), -n);
    double sum = weights[0] * *end;
    for (int k = 1; k < 5; ++k) {
      const std::optional<double> value = f(stretch.to - k * d);
      if (!value) return {};
      sum += weights[k] * *value;
    }
    const double now = sum / (12 * d);
    if (!(std::abs(now - last) >= change)) {
      if (n > 0) change = std::abs(now - last);
      best = now;
    }
    last = now;
    if (change <= settled_rate * std::abs(best)) break;
  }
  if (!(change <= unsettled_rate * std::abs(best))) return {};
  return best;
}

// What is zero where a place's phase ends, at the group's state; see ContactPhases.
DesignScalar PhasedDerivatives::end_value(std::size_t k, const WatchedPlace& watched) {
  const PhaseEquations::Design of = design(k);
  const ContactPoint& point = contacts_.points[watched.place];
  const ContactState& state = equations_->states()[watched.place];
  const auto pressing = [&] { return equations_->normal(of, watched.place, groups()[k].lambda); };
  if (watched.ends == PhaseEnd::slide) {
    if (state.direction != 0) return of.mechanism.measure(point.slide).d;
    return of.places[watched.place].mu_static * pressing() -
           abs(groups()[k].lambda[at(equations_->slide_row(watched.place))]);
  }
  if (state.closed) return pressing();
  const DesignScalar gap = of.mechanism.measure(point.element).f;
  if (watched.ends == PhaseEnd::contact || point.c == 0) return gap;
  return -gap.v < pressing().v ? gap : pressing();
}

// t*_p of a place that changes at the end of the step.
std::optional<std::vector<double>> PhasedDerivatives::rate_of_place(const MotionStretch* stretch,
                                                                    const WatchedPlace& watched) {
  const ContactPoint& point = contacts_.points[watched.place];
  const ContactState state = equations_->states()[watched.place];
  std::vector<double> by_parameter;
  if (watched.ends == PhaseEnd::shares) {
    lost_ = fmt::format("at t = {:.9g} s places that hold each other, \"{}\" among them, give way: when has no derivative",
                        to_, name(watched.place));
    for (const Group& group : groups()) by_parameter.insert(by_parameter.end(), at(group.count), unknown);
    return by_parameter;
  }
  std::optional<double> by_time;
  if (!factorize(to_, Side::before, tracks_.front().end)) return {};
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    if (!slope(k, to_, Side::before, tracks_[k].end, stage_)) return {};
    const DesignScalar value = end_value(k, watched);
    for (std::size_t p = 0; p < at(groups()[k].count); ++p) by_parameter.push_back(value.d[p]);
    if (k > 0) continue;
    const Taylor<DesignScalar> gap = groups()[0].mechanism.measure(point.element);
    if (watched.ends == PhaseEnd::slide && state.direction != 0) {
      by_time = groups()[0].mechanism.measure(point.slide).dd.v;
    } else if (watched.ends != PhaseEnd::slide && !state.closed && value.v == gap.f.v) {
      by_time = gap.d.v;
      const double part = point.turns ? 1 / evaluator().length_scale() : 1;
      std::vector<double> qd(n_);
      for (std::size_t c = 0; c < n_; ++c) qd[c] = tracks_[0].end[n_ + c].v;
      if (std::abs(*by_time) <= no_speed * part * fastest(evaluator(), qd)) {
        lost_ = fmt::format(
            "at t = {:.9g} s \"{}\" touches with a speed of {:.3g} that cannot be told from rounding: a little more or "
            "less is another motion",
            to_, name(watched.place), *by_time);
        by_time.reset();
      }
    }
  }
  const bool touches = !by_time && !lost_.empty();
  if (!by_time && !touches && stretch) {
    by_time = rate_along(*stretch, [&](double t) -> std::optional<double> {
      const std::optional<Snapshot> there = stretch->at(t);
      if (!there) return {};
      for (std::size_t c = 0; c < n_; ++c) {
        y_[c] = DesignScalar(there->q[c]);
        y_[n_ + c] = DesignScalar(there->qd[c]);
      }
      if (!factorize(t, Side::before, y_) || !slope(0, t, Side::before, y_, stage_)) return {};
      return end_value(0, watched).v;
    });
  }
  for (double& rate : by_parameter) rate = rate == 0 ? 0 : by_time && *by_time != 0 ? -rate / *by_time : unknown;
  return by_parameter;
}

// t*_p of an event whose column is at its value at the end of the step.
std::optional<std::vector<double>> PhasedDerivatives::rate_of_event(const MotionStretch& stretch,
                                                                    const DesignEvent& event, bool is_first) {
  std::vector<double> rate(at(parameters()), unknown);
  const std::optional<Snapshot> end = stretch.at(to_);
  if (!end) return {};
  double value = 0;
  event.column.evaluate(*end, {&value, 1});
  if (!is_first && !(std::abs(value - event.value) <= is_at_value * std::max(std::abs(event.value), 1.0))) return {};
  const auto column_at = [&](double t) -> std::optional<double> {
    const std::optional<Snapshot> there = stretch.at(t);
    if (!there) return {};
    double column = 0;
    event.column.evaluate(*there, {&column, 1});
    return column;
  };
  const std::optional<double> by_time = rate_along(stretch, column_at);
  if (!by_time) return {};
  const double change = std::abs(*by_time) * (to_ - from_);
  if (!is_first && change <= stays_at_value * std::max(std::abs(event.value), 1.0)) return {};
  const std::optional<Snapshot> again = stretch.at(to_);
  if (!again || !find(*again)) return {};
  differentiate(event.column, *again, rate);
  for (std::size_t p = 0; p < rate.size(); ++p) {
    const double rest = rate[p] - event.value_rate[p];
    rate[p] = rest == 0 ? 0 : -rest / *by_time;
    if (!std::isfinite(rate[p])) rate[p] = unknown;
  }
  return rate;
}

void PhasedDerivatives::find_rates(const MotionStretch& stretch) {
  const auto take = [&](int number, std::optional<std::vector<double>> rate) {
    if (!rate) return;
    note_instant(*instants_, to_, *rate);
    if (stretch.ends_phase) note_instant(phase_instants_, to_, *rate);
    found_[number] = std::move(*rate);
  };
  const int listed = static_cast<int>(events_.size());
  if (stretch.ended_by < listed) {
    for (int e = 0; e < listed; ++e) take(e, rate_of_event(stretch, events_[at(e)], e == stretch.ended_by));
    return;
  }
  const std::size_t transition = at(stretch.ended_by - listed);
  if (transition < phase_.watched.size()) take(stretch.ended_by, rate_of_place(&stretch, phase_.watched[transition]));
}

void PhasedDerivatives::note_instant(InstantRates& instants, double t, const std::vector<double>& rate) {
  const auto [known, is_new] = instants.emplace(t, rate);
  if (!is_new) join(known->second, rate);
}

// How the instant moves at which this phase begins.
std::vector<double> PhasedDerivatives::rates_of(const MotionPhase& phase) {
  std::vector<double> none(at(parameters()), 0.0), rate = none;
  if (phase.functions_jump) rate = instant_at(phase.t).rate;
  if (phase.ended_by >= 0 && at(phase.ended_by) < phase_.watched.size()) {
    const int number = static_cast<int>(events_.size()) + phase.ended_by;
    if (const auto found = found_.find(number); found != found_.end()) return found->second;
    const auto own = rate_of_place(nullptr, phase_.watched[at(phase.ended_by)]);
    rate = own ? *own : std::vector<double>(none.size(), unknown);
    note_instant(*instants_, phase.t, rate);
    note_instant(phase_instants_, phase.t, rate);
  }
  for (std::size_t k = 0; k < phase.events.size(); ++k) {
    const auto found = found_.find(phase.events[k]);
    const std::vector<double> own = found != found_.end() ? found->second : std::vector<double>(none.size(), unknown);
    if (k == 0)
      rate = own;
    else
      join(rate, own);
  }
  return rate;
}

std::vector<int> PhasedDerivatives::released_in(const VelocityJump& jump) const {
  std::vector<int> released = jump.released;
  for (const ContactPoint& point : contacts_.points) {
    released.push_back(point.element);
    if (point.has_friction()) released.push_back(point.slide);
  }
  return released;
}

// Places that close at one instant must do so whatever the parameters are.
void PhasedDerivatives::check_hits(const VelocityJump& jump, std::size_t k, const Vector& there) {
  Group& group = groups()[k];
  const auto hits = std::count_if(jump.places.begin(), jump.places.end(), [](const auto& p) { return p.was_hit; });
  if (hits < 2) return;
  group.mechanism.set_state(std::span(there).first(n_), std::span(there).subspan(n_));
  for (const ImpactPlace& place : jump.places) {
    if (!place.was_hit) continue;
    const DesignScalar gap = group.mechanism.measure(contacts_.points[place.place].element).f;
    for (std::size_t p = 0; p < at(group.count); ++p) {
      double moves = 0;
      for (std::size_t c = 0; c < n_; ++c) moves = std::max(moves, std::abs(there[c].d[p]));
      if (std::abs(gap.d[p]) <= same_place * moves + rounding(k, p)) continue;
      lost_ = fmt::format(
          "at t = {:.9g} s several contacts close at once, \"{}\" among them, at instants that move apart with the "
          "parameters: which comes first decides about the impact",
          to_, name(place.place));
      lose_[k][p] = true;
    }
  }
}

std::span<const double> PhasedDerivatives::rates_of_group(const std::vector<double>& rate, std::size_t k) {
  return std::span(rate).subspan(k * at(parameters_at_once), at(groups()[k].count));
}

// One step of a jump, of all groups, with the equations that are held.
template <class Target>
bool PhasedDerivatives::jump_on(const VelocityJump& jump, const std::vector<double>& rate, std::vector<Vector>& there,
                                Target&& target) {
  if (!factorize(to_, Side::after, there.front())) return false;
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    groups()[k].mechanism.set_time(to_, Side::after);
    const DesignStrike* strike = jump.strike ? &events_[at(jump.event)].strikes[k] : nullptr;
    if (!equations_->jump(design(k), jump, strike, target(k), rates_of_group(rate, k), q(there[k]), qd(there[k])))
      return false;
  }
  return true;
}

// A jump of velocities along the instant: what is there first, then the impact that follows.
bool PhasedDerivatives::jump(const VelocityJump& jump, const std::vector<double>& rate, std::vector<Vector>& there) {
  std::vector<int> released = released_in(jump);
  if (jump.meets_constraints) {
    VelocityJump first = jump;
    first.places.clear();
    equations_->hold(released, {});
    if (!jump_on(first, rate, there, [&](std::size_t) { return Vector(at(plan().rows)); })) return false;
  }
  if (jump.places.empty()) return true;
  if (jump.settles) {
    lost_ = fmt::format("at t = {:.9g} s a motion that rocks ever faster comes to rest: that has no derivative", to_);
    for (std::size_t k = 0; k < tracks_.size(); ++k) std::fill(lose_[k].begin(), lose_[k].end(), true);
  }
  for (std::size_t k = 0; k < tracks_.size(); ++k) check_hits(jump, k, there[k]);
  VelocityJump impact = jump;
  impact.strike.reset();
  std::erase_if(impact.places, [](const ImpactPlace& place) { return !place.presses; });
  for (const ImpactPlace& place : impact.places) {
    std::erase(released, contacts_.points[place.place].element);
    if (place.sticks) std::erase(released, contacts_.points[place.place].slide);
  }
  equations_->hold(released, {});
  return jump_on(impact, rate, there, [&](std::size_t k) {
    Group& group = groups()[k];
    group.mechanism.set_state(q(there[k]), qd(there[k]));
    group.mechanism.rows(group.rows);
    Vector target(at(plan().rows));
    for (const ImpactPlace& place : impact.places) {
      if (!place.rebounds) continue;
      const std::size_t row = at(equations_->gap_row(place.place));
      target[row] = -(places_[k][place.place].restitution * DesignScalar(impact.restitution_part) * group.rows[row].d);
    }
    return target;
  });
}

// Where an instant is not known it is left aside; see end_crossing().
void PhasedDerivatives::move_along(Vector& y, const Vector& slope, std::span<const double> rate, double sign) {
  for (std::size_t i = 0; i < y.size(); ++i) {
    for (std::size_t p = 0; p < rate.size(); ++p) {
      if (!std::isnan(rate[p])) y[i].d[p] += sign * slope[i].v * rate[p];
    }
  }
}

// An instant that is not known matters only where the motion jumps or bends.
void PhasedDerivatives::end_crossing(std::size_t k, const std::vector<double>& rate, const Vector& slope_before,
                                     bool jumps) {
  double change = 0, size = 0;
  for (std::size_t i = 0; i < stage_.size(); ++i) {
    change = std::max(change, std::abs(stage_[i].v - slope_before[i].v));
    size = std::max({size, std::abs(stage_[i].v), std::abs(slope_before[i].v)});
  }
  const std::span<const double> own = rates_of_group(rate, k);
  for (std::size_t p = 0; p < own.size(); ++p) {
    const bool unseen = std::isnan(own[p]) && (jumps || change > no_jump_of_slopes * size);
    if (unseen && lost_.empty())
      lost_ =
          fmt::format("the instant t = {:.9g} s, at which the motion goes on in another way, has no derivative", to_);
    if (unseen || lose_[k][p]) lose(k, p, tracks_[k]);
  }
}

bool PhasedDerivatives::cross(const MotionPhase& phase, const std::vector<double>& rate) {
  lose_.assign(tracks_.size(), {});
  std::vector<Vector> there, slope_before;
  if (!factorize(to_, Side::before, tracks_.front().end)) return singular(to_);
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    if (!slope(k, to_, Side::before, tracks_[k].end, stage_)) return singular(to_);
    slope_before.push_back(stage_);
    there.push_back(tracks_[k].end);
    move_along(there[k], stage_, rates_of_group(rate, k), 1);
  }
  for (const VelocityJump& one : phase.jumps) {
    if (!jump(one, rate, there)) return singular(to_);
  }
  phase_ = phase;
  equations_->hold(phase_.released, phase_.states);
  // Functions of time that jump while the same equations hold.
  const bool meets = phase_.functions_jump && phase_.jumps.empty();
  const auto nothing = [&](std::size_t) { return Vector(at(plan().rows)); };
  if (meets && !jump_on({.meets_constraints = true}, rate, there, nothing)) return singular(to_);
  if (!factorize(to_, Side::after, there.front())) return singular(to_);
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    Track& track = tracks_[k];
    if (!slope(k, to_, Side::after, there[k], stage_)) return singular(to_);
    track.before = track.end;
    track.end = there[k];
    move_along(track.end, stage_, rates_of_group(rate, k), -1);
    end_crossing(k, rate, slope_before[k], meets || !phase_.jumps.empty());
    find_anchors(k);
    check_rows(k, to_, false);
  }
  if (!lost_.empty()) lack_derivatives(lost_);
  return true;
}

// Functions of time jump at the step's end.
bool PhasedDerivatives::cross_functions() {
  MotionPhase same = phase_;
  same.jumps.clear();
  same.functions_jump = true;
  same.t = crossed_.emplace(to_);
  return cross(same, instant_at(to_).rate);
}

// Where bounces end for which there was no time: t + T e / (1 - e), T the time since the last bounce
// (contact_switch.hpp).
void PhasedDerivatives::note_landings(const MotionPhase& phase, const std::vector<double>& rate) {
  for (const VelocityJump& jump : phase.jumps) {
    for (const ImpactPlace& hit : jump.places) {
      if (!hit.was_hit) continue;
      Bounce& last = bounces_[hit.place];
      const double e = contacts_.points[hit.place].restitution;
      if (!hit.rebounds && e > 0 && e < 1 && !last.rate.empty()) {
        const double fall = std::max(phase.t - last.t, 0.0);
        std::vector<double> landing(rate);
        for (std::size_t p = 0; p < rate.size(); ++p) {
          const double e_p = places_[p / at(parameters_at_once)][hit.place].restitution.d[p % at(parameters_at_once)];
          landing[p] += (rate[p] - last.rate[p]) * e / (1 - e) + fall * e_p / ((1 - e) * (1 - e));
        }
        note_instant(*instants_, phase.t + fall * e / (1 - e), landing);
      }
      last = {phase.t, rate};
    }
  }
}

void PhasedDerivatives::begin(const MotionPhase& phase) {
  if (!why().empty()) return;
  if (!started_) {
    if (has_phase_ && phase.t != to_) not_shown(phase.t);
    has_phase_ = true;
    to_ = phase.t;
    phase_ = phase;
    equations_->hold(phase.released, phase.states);
    return;
  }
  if (phase.t != to_) {
    not_shown(phase.t);
    return;
  }
  // Seen as a jump of functions alone before contacts had their say.
  if (crossed_ == to_) {
    for (Track& track : tracks_) track.end = track.before;
    crossed_.reset();
  }
  const std::vector<double> rate = rates_of(phase);
  note_landings(phase, rate);
  if (!cross(phase, rate)) return;
  from_ = to_;
  has_step_ = false;
  found_.clear();
}

}  // namespace catena
