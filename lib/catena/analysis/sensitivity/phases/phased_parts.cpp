// PhasedDerivatives: steps in parts.
#include <fmt/format.h>

#include <algorithm>

#include "catena/analysis/sensitivity/phases/phased_derivatives.hpp"

namespace catena {

// The next part of the step, behind those that have been covered.
bool PhasedDerivatives::step_on(double to) {
  keep_part();
  for (Track& track : tracks_) track.begin = track.end;
  from_ = to_;
  to_ = to;
  has_.step = true;
  has_.interpolant = false;
  return make_step(to_ - from_);
}

bool PhasedDerivatives::cover_part(const MotionStretch& stretch, double to) {
  return step_on(to) && take_values(stretch, to_, &Track::end) && project(to_, Side::before, &Track::end);
}

// As if that part had not been covered; `is_first` of the step.
bool PhasedDerivatives::undo_part(const MotionStretch& stretch, bool is_first) {
  const double end = from_;
  if (is_first) {
    for (Track& track : tracks_) track.end = track.begin;
    to_ = end;
    has_.step = false;
  } else {
    Part& before = parts_.back();
    from_ = before.from;
    to_ = before.to;
    has_.interpolant = before.has_interpolant;
    tracks_ = std::move(before.tracks);
    parts_.pop_back();
  }
  return take_values(stretch, end, &Track::end);
}

double PhasedDerivatives::excess() const {
  double error = 0;
  for (std::size_t k = 0; aim_.divides() && k < tracks_.size(); ++k) {
    const Track& track = tracks_[k];
    error = std::max(error, error_of_derivatives(to_ - from_, track.begin, track.end, track.stage, aim_, k));
  }
  return error / aim_.allowed();
}

bool PhasedDerivatives::cover_in_parts(const MotionStretch& stretch, double to) {
  const bool is_first = !has_.step;
  if (!cover_part(stretch, to)) return false;
  const double missed = excess();
  if (!(missed > 1)) return true;
  const int count = parts_for(missed);
  if (!is_long_enough((to_ - from_) / count, from_)) {
    return fail(fmt::format(
        "at t = {:.9g} s derivatives change too fast, beside a motion that does not, for steps of any length", from_));
  }
  if (!undo_part(stretch, is_first)) return false;
  const double from = to_;
  for (int k = 1; k <= count; ++k) {
    if (!cover_in_parts(stretch, k == count ? to : from + (to - from) * k / count)) return false;
  }
  return true;
}

void PhasedDerivatives::keep_part() {
  if (has_.step) parts_.push_back({from_, to_, has_.interpolant, tracks_});
}

// Makes the part in which t lies the present one, or that beside it where a law switches; false where there is none.
bool PhasedDerivatives::go_to_part(double t) {
  const auto distance = [t](double from, double to) { return std::max({from - t, t - to, 0.0}); };
  if (distance(from_, to_) == 0) return true;
  if (std::none_of(parts_.begin(), parts_.end(), [&](const Part& p) { return (p.from <= t) != (from_ <= t); })) {
    // All parts are on one side.
    if (std::none_of(parts_.begin(), parts_.end(), [&](const Part& p) { return distance(p.from, p.to) == 0; }))
      return false;
  }
  const auto found = std::min_element(parts_.begin(), parts_.end(), [&](const Part& a, const Part& b) {
    return distance(a.from, a.to) < distance(b.from, b.to);
  });
  if (distance(from_, to_) <= distance(found->from, found->to)) return true;
  std::swap(from_, found->from);
  std::swap(to_, found->to);
  std::swap(has_.interpolant, found->has_interpolant);
  std::swap(has_.step, found->has_step);
  std::swap(tracks_, found->tracks);
  return true;
}

}  // namespace catena
