// EventWatch within a step: its samples, and which of them columns pass their values between.
#include <algorithm>
#include <cmath>

#include "catena/analysis/events/event_watch.hpp"

namespace catena {
namespace {

// A step is looked at in one stretch for every turn of a body by this angle, rad.
constexpr double turn_in_a_stretch = 0.25 * EventSamples::parts, most_stretches = 1e5;
// A stretch is halved so often at most: ten thousand radians of an oscillation within one are seen.
constexpr int most_halvings = 12;
}  // namespace

// Number of stretches of (from, to], since columns oscillate with turning bodies. Leaves the first sample.
int EventWatch::stretches(double from, double to, const StateAt& state_at) {
  double turn = 0;
  const auto look = [&](double t, bool last) {
    const std::optional<Snapshot> state = state_at(t);
    if (!state) return false;
    for (std::size_t b = 0; b < angles_.size(); ++b) {
      turn = std::max(turn, std::abs(state->qd[3 * b + 2]) * (to - from));
      if (last) turn = std::max(turn, std::abs(state->q[3 * b + 2] - angles_[b]));
      angles_[b] = state->q[3 * b + 2];
    }
    if (!last) sample(*state, g_[2]);
    return true;
  };
  if (!look(from, false) || !look(to, true)) return 0;
  return static_cast<int>(std::clamp(std::ceil(turn / turn_in_a_stretch), 1.0, most_stretches));
}

/// A search in one step.
struct EventWatch::Look {
  const StateAt& state_at;
  bool ended = false;  // the motion could not be looked at any further
};

// The first event in samples of (from, to], or of its halves where they do not show what columns do in it.
std::optional<FoundEvent> EventWatch::look_within(double from, double to, int halvings, Look& look) {
  std::copy(g_[2].begin(), g_[2].end(), taken_.at(0).begin());
  for (int n = 1; n <= EventSamples::parts; ++n) {
    const std::optional<Snapshot> state = look.state_at(EventSamples::instant(from, to, n));
    if (!state) {
      look.ended = true;
      return first_in_samples(from, to, n - 1, look.state_at);  // what comes before counts
    }
    sample(*state, taken_.at(n));
  }
  const double middle = from + (to - from) / 2;
  if (middle > from && middle < to && may_hide_a_passage(halvings)) {
    std::optional<FoundEvent> first = look_within(from, middle, halvings + 1, look);
    if (!first && !look.ended) first = look_within(middle, to, halvings + 1, look);
    return first;
  }
  return first_in_samples(from, to, EventSamples::parts, look.state_at);
}

// Columns become smooth in shorter stretches, but for those that have a kink there.
bool EventWatch::may_hide_a_passage(int halvings) {
  for (std::size_t k = 0; k < side_.size(); ++k) {
    if (!taken_.may_hide(k, tiny(k))) continue;
    if (halvings < most_halvings) return true;
    taken_.note_kink(k);
  }
  return false;
}

// The first event up to the last of so many samples.
std::optional<FoundEvent> EventWatch::first_in_samples(double from, double to, int count, const StateAt& state_at) {
  for (int n = 1; n <= count; ++n) {
    // The last three samples, the newest of them last.
    std::rotate(g_.begin(), g_.begin() + 1, g_.end());
    std::rotate(times_.begin(), times_.begin() + 1, times_.end());
    times_[2] = EventSamples::instant(from, to, n);
    std::copy(taken_.at(n).begin(), taken_.at(n).end(), g_[2].begin());
    side_before_ = side_;
    const bool dips = locate_passages(enclose_passages(n >= 2, state_at), state_at);
    if (found_.empty()) continue;
    std::sort(found_.begin(), found_.end(),
              [](const FoundEvent& a, const FoundEvent& b) { return a.t != b.t ? a.t > b.t : a.event > b.event; });
    const FoundEvent first = first_found(state_at);
    // A column that comes back before the next sample may pass its value again before the others.
    if (dips) found_.clear();
    return first;
  }
  return {};
}

std::optional<FoundEvent> EventWatch::find(double from, double to, const StateAt& state_at) {
  if (!simultaneous_.empty()) {
    const FoundEvent next = simultaneous_.back();
    simultaneous_.pop_back();
    return next;
  }
  if (!(from < to)) return {};
  // Found with the last one, in a motion that went on unchanged.
  if (!found_.empty() && found_.back().t == from && times_[2] <= to) {
    found_.pop_back();
    return first_found(state_at);
  }
  const int count = stretches(from, to, state_at);
  times_[2] = from;
  // A transition knows the side on which it begins, whatever rounding says at once.
  for (std::size_t k = 0; count > 0 && k < events_.size(); ++k) {
    const int now = side(k, g_[2][k]);
    if (now != 0) side_[k] = {now};
  }
  taken_.begin(side_.size());
  Look look{state_at};
  std::optional<FoundEvent> first;
  double start = from;
  for (int n = 1; n <= count && !first && !look.ended; ++n) {
    const double end = n == count ? to : from + (to - from) * n / count;
    first = look_within(start, end, 0, look);
    start = end;
  }
  return first;
}

}  // namespace catena
