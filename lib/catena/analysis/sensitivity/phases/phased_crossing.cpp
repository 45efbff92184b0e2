// PhasedDerivatives where one phase goes over into the next.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/sensitivity/phases/phased_derivatives.hpp"
#include "catena/base/at.hpp"

namespace catena {
std::vector<int> PhasedDerivatives::released_in(const VelocityJump& jump) const {
  std::vector<int> released = jump.released;
  for (const ContactPoint& point : contacts_.points) {
    released.push_back(point.element);
    if (point.has_friction()) released.push_back(point.slide);
  }
  return released;
}

// Places that close at one instant must do so whatever the parameters are.
void PhasedDerivatives::check_hits(const VelocityJump& jump, std::size_t k, const DesignVector& there) {
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
bool PhasedDerivatives::jump_on(const VelocityJump& jump, const std::vector<double>& rate,
                                std::vector<DesignVector>& there, Target&& target) {
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
bool PhasedDerivatives::jump(const VelocityJump& jump, const std::vector<double>& rate,
                             std::vector<DesignVector>& there) {
  std::vector<int> released = released_in(jump);
  if (jump.meets_constraints) {
    VelocityJump first = jump;
    first.places.clear();
    equations_->hold(released, {});
    if (!jump_on(first, rate, there, [&](std::size_t) { return DesignVector(at(plan().rows)); })) return false;
  }
  if (jump.places.empty()) return true;
  if (jump.other_law || jump.settles) {
    lost_ =
        fmt::format("at t = {:.9g} s {}: derivatives are not carried through that", to_,
                    jump.settles ? "a motion that rocks ever faster comes to rest"
                                 : "another law of impacts takes the place of Newton's, by which energy would grow");
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
    DesignVector target(at(plan().rows));
    for (const ImpactPlace& place : impact.places) {
      if (!place.rebounds) continue;
      const std::size_t row = at(equations_->gap_row(place.place));
      target[row] = -(places_[k][place.place].restitution * group.rows[row].d);
    }
    return target;
  });
}

// Where an instant is not known it is left aside; see end_crossing().
void PhasedDerivatives::move_along(DesignVector& y, const DesignVector& slope, std::span<const double> rate,
                                   double sign) {
  for (std::size_t i = 0; i < y.size(); ++i) {
    for (std::size_t p = 0; p < rate.size(); ++p) {
      if (!std::isnan(rate[p])) y[i].d[p] += sign * slope[i].v * rate[p];
    }
  }
}

// An instant that is not known matters only where the motion jumps, or bends: accelerations do, whose size that of
// velocities says nothing of.
void PhasedDerivatives::end_crossing(std::size_t k, const std::vector<double>& rate, const DesignVector& slope_before,
                                     bool jumps) {
  double change = 0, size = 0;
  for (std::size_t i = n_; i < stage_.size(); ++i) {
    change = std::max(change, std::abs(stage_[i].v - slope_before[i].v));
    size = std::max({size, std::abs(stage_[i].v), std::abs(slope_before[i].v)});
  }
  const std::span<const double> own = rates_of_group(rate, k);
  for (std::size_t p = 0; p < own.size(); ++p) {
    const bool unseen = std::isnan(own[p]) && (jumps || change > thresholds::no_jump * size);
    if (unseen && lost_.empty())
      lost_ =
          fmt::format("the instant t = {:.9g} s, at which the motion goes on in another way, has no derivative", to_);
    if (unseen || lose_[k][p]) lose(k, p, tracks_[k]);
  }
}

bool PhasedDerivatives::lacks() const {
  return std::any_of(tracks_.begin(), tracks_.end(), [](const Track& track) {
    const DesignScalar& y = track.end.front();
    return std::any_of(y.d.begin(), y.d.end(), [](double d) { return std::isnan(d); });
  });
}

bool PhasedDerivatives::cross(const MotionPhase& phase, const std::vector<double>& rate) {
  lose_.assign(tracks_.size(), {});
  std::vector<DesignVector> there, slope_before;
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
  const auto nothing = [&](std::size_t) { return DesignVector(at(plan().rows)); };
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
  // An instant that is not known may not matter.
  if (!lacks()) lost_.clear();
  if (!lost_.empty()) lack_derivatives(lost_);
  return true;
}

// Functions of time jump at the step's end.
bool PhasedDerivatives::cross_functions() {
  MotionPhase same = phase_;
  same.jumps.clear();
  same.functions_jump = true;
  same.t = crossed_.t.emplace(to_);
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
  if (!has_.start) {
    if (has_.phase && phase.t != to_) not_shown(phase.t);
    has_.phase = true;
    to_ = phase.t;
    phase_ = phase;
    equations_->hold(phase.released, phase.states);
    return;
  }
  if (!parts_.empty()) go_to_part(phase.t);
  parts_.clear();
  if (phase.t != to_) {
    not_shown(phase.t);
    return;
  }
  // Seen as a jump of functions alone before contacts had their say.
  if (crossed_.t == to_) {
    for (Track& track : tracks_) track.end = track.before;
    crossed_.t.reset();
  }
  const std::vector<double> rate = rates_of(phase);
  crossed_.rate = rate;
  note_landings(phase, rate);
  if (!cross(phase, rate)) return;
  from_ = to_;
  has_.step = false;
  found_.clear();
}

}  // namespace catena
