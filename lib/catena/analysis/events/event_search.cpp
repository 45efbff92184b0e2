// EventWatch within a step: its samples, passages between them, and where these are.
#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/events/event_watch.hpp"

namespace catena {
namespace {

// A step is looked at in one stretch for every turn of a body by this angle, rad.
constexpr double turn_in_a_stretch = 0.25 * EventSamples::parts, most_stretches = 1e5;
// A stretch is halved so often at most: ten thousand radians of an oscillation within one are seen.
constexpr int most_halvings = 12;
constexpr int most_iterations = 80;
// Of the time between two samples: nearer to the first one nothing is looked for.
constexpr double smallest_part = 1e-13;

/// Where the parabola through three points has its vertex, and its value there, if that lies between them.
struct Vertex {
  double t = 0, value = 0;
  bool inside = false;
};
Vertex vertex(const double* t, const double* g) {
  const double d1 = (g[1] - g[0]) / (t[1] - t[0]), d2 = (g[2] - g[1]) / (t[2] - t[1]);
  const double bend = (d2 - d1) / (t[2] - t[0]);
  if (bend == 0) return {};
  const double slope = d1 - bend * (t[1] - t[0]);  // at t[0]
  const double at = -slope / (2 * bend);
  return {t[0] + at, g[0] + at * (slope + bend * at), at > 0 && t[0] + at < t[2]};
}

}  // namespace

// The root between an instant on the old side and one on the new side: the secant through the ends, the older end's
// value halved when it stays (Illinois), bisection where that is slow.
double EventWatch::locate(std::size_t k, double before, double after, const StateAt& state_at) {
  double a = before, b = after, fa = watched(k, a, state_at), fb = watched(k, b, state_at);
  // After an event at the start itself the column may have gone beyond and be on its way back.
  for (double part = 0.5; !(fa * side_[k] > 0); part /= 2) {
    if (part < smallest_part) return before;
    a = before + (after - before) * part;
    fa = watched(k, a, state_at);
  }
  if (!(fb * side_[k] < 0)) return b;
  double width = b - a;
  for (int n = 0; n < most_iterations; ++n) {
    if (b - a <= 4 * std::numeric_limits<double>::epsilon() * std::max(std::abs(a), std::abs(b))) break;
    double t = b - fb * (b - a) / (fb - fa);
    if (!(t > a && t < b) || (n % 3 == 2 && b - a > width / 4)) t = a + (b - a) / 2;
    if (n % 3 == 2) width = b - a;
    const double f = watched(k, t, state_at);
    if (f == 0) return t;
    if (f * side_[k] > 0) {
      a = t;
      fa = f;
      fb /= 2;
    } else {
      b = t;
      fb = f;
      fa /= 2;
    }
  }
  return b;
}

// An instant up to the last sample at which column k is beyond its value, or nothing. `three`: there are three samples.
std::optional<double> EventWatch::passage(std::size_t k, bool three, const StateAt& state_at) {
  if (side(k, g_[2][k]) == -side_[k]) return times_[2];
  if (!three) return {};
  // A dip: the parabola through three samples has its vertex among them and reaches the value there, or nearly so. The
  // vertex may lie in the first or the last part of a step, beyond the nearest sample.
  double ts[3] = {times_[0], times_[1], times_[2]}, gs[3] = {g_[0][k], g_[1][k], g_[2][k]};
  for (int n = 0; n < 8; ++n) {
    const Vertex low = vertex(ts, gs);
    const double nearest = std::min({std::abs(gs[0]), std::abs(gs[1]), std::abs(gs[2])});
    if (!low.inside || low.value * side_[k] > 0.1 * nearest || low.t == ts[1]) return {};
    const double g = watched(k, low.t, state_at);
    if (side(k, g) == -side_[k]) return low.t;
    const bool first = low.t < ts[1], nearer = std::abs(g) < std::abs(gs[1]);
    // The three points nearest to the lowest one.
    if (nearer) {
      ts[first ? 2 : 0] = ts[1];
      gs[first ? 2 : 0] = gs[1];
      ts[1] = low.t;
      gs[1] = g;
    } else {
      ts[first ? 0 : 2] = low.t;
      gs[first ? 0 : 2] = g;
    }
  }
  return {};
}

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
    found_.clear();
    bool dips = false;
    for (std::size_t k = 0; k < side_.size(); ++k) {
      if (side_[k] == 0) {
        side_[k] = side(k, g_[2][k]);
        continue;
      }
      const std::optional<double> beyond = passage(k, n >= 2, state_at);
      if (!beyond) continue;
      double start = *beyond > times_[1] ? times_[1] : times_[0], end = *beyond;
      if (!counts(k)) {
        // A passage in a direction that is not watched; the return from a dip is watched.
        side_[k] = -side_[k];
        if (*beyond == times_[2]) continue;
        start = *beyond;
        end = times_[2];
      }
      const double t = locate(k, start, end, state_at);
      if (t <= found_at_[k]) {
        // The event that was found there already, seen again within rounding.
        side_[k] = -side_[k];
        continue;
      }
      found_.push_back({static_cast<int>(k), t});
      dips = dips || *beyond != times_[2];
    }
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
    if (now != 0) side_[k] = now;
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
