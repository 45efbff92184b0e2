#include "catena/analysis/events/event_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena {
namespace {

// Samples of a step: at least so many, and one for each turn of a body by this angle, rad.
constexpr double fewest_samples = 8, most_samples = 1e6;
constexpr double turn_between_samples = 0.25;
// A distance from the value below this part of the column's size, or below this number, counts as zero.
constexpr double rounding = 1e-13;
constexpr double smallest = 1e-14;
constexpr int most_iterations = 80;
// Of the time between two samples: columns that reach their values within rounding at one instant do so this near to
// it.
constexpr double one_instant = 1e-3;

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

EventWatch::EventWatch(std::vector<Event> events, const Model& model, const Plan& plan, const ColumnSources& sources)
    : events_(std::move(events)) {
  ColumnSources untimed = sources;
  untimed.timed = false;
  for (const Event& event : events_) {
    const std::string name[] = {event.column};
    columns_.push_back(ColumnSet::resolve(model, plan, name, untimed));
    const ColumnSet& set = columns_.back();
    if (!set.notes().empty()) throw std::invalid_argument("event \"" + event.name + "\": " + set.notes().front());
    if (set.size() != 1)
      throw std::invalid_argument("event \"" + event.name + "\" watches \"" + event.column +
                                  "\", which is more than one column");
    needs_ |= set.needs();
    if (!std::isfinite(event.value))
      throw std::invalid_argument("event \"" + event.name + "\": its value is not finite");
    if (event.action == EventAction::release || event.action == EventAction::engage)
      static_cast<void>(model.element_type(event.element));  // throws for what is none
  }
  side_.assign(events_.size(), 0);
  largest_.assign(events_.size(), 0.0);
  found_at_.assign(events_.size(), -std::numeric_limits<double>::infinity());
  for (std::vector<double>& g : g_) g.resize(events_.size());
  angles_.resize(static_cast<std::size_t>(plan.moving));
}

int EventWatch::side(std::size_t k, double g) const {
  const double tiny = std::max(smallest, rounding * std::max(largest_[k], std::abs(target(k))));
  return g > tiny ? 1 : g < -tiny ? -1 : 0;
}

/// Whether a passage from the side last seen to the other one is in the direction that is watched.
bool EventWatch::counts(std::size_t k) const {
  if (k >= events_.size()) return side_[k] == transitions_[k - events_.size()].side;
  return events_[k].direction == EventDirection::any || (events_[k].direction == EventDirection::up) == (side_[k] < 0);
}

void EventWatch::sample(const Snapshot& state, std::span<double> g) {
  for (std::size_t k = 0; k < side_.size(); ++k) {
    const double value = value_of(k, state);
    largest_[k] = std::max(largest_[k], std::abs(value));
    g[k] = value - target(k);
  }
}

double EventWatch::value_of(std::size_t k, const Snapshot& state) const {
  if (k >= events_.size()) return transitions_[k - events_.size()].value(state);
  double value = 0;
  columns_[k].evaluate(state, {&value, 1});
  return value;
}

void EventWatch::watch(std::vector<Transition> transitions, const Needs& needs) {
  transitions_ = std::move(transitions);
  found_.clear();
  transition_needs_ = needs;
  const std::size_t size = events_.size() + transitions_.size();
  side_.resize(events_.size());
  for (const Transition& transition : transitions_) side_.push_back(transition.side);
  largest_.resize(events_.size());
  for (const Transition& transition : transitions_) largest_.push_back(transition.scale);
  found_at_.resize(events_.size());
  found_at_.resize(size, -std::numeric_limits<double>::infinity());
  for (std::vector<double>& g : g_) g.resize(size);
}

double EventWatch::watched(std::size_t k, double t, const StateAt& state_at) {
  const std::optional<Snapshot> state = state_at(t);
  if (!state) return std::numeric_limits<double>::quiet_NaN();
  return value_of(k, *state) - target(k);
}

// The root between an instant on the old side and one on the new side: the secant through the ends, the older end's
// value halved when it stays (Illinois), bisection where that is slow.
double EventWatch::locate(std::size_t k, double before, double after, const StateAt& state_at) {
  double a = before, b = after, fa = watched(k, a, state_at), fb = watched(k, b, state_at);
  // After an event at the start itself the column may have gone beyond and be on its way back.
  for (double part = 0.5; !(fa * side_[k] > 0); part /= 2) {
    if (part < rounding) return before;
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

// Number of samples needed in (from, to], since columns oscillate with turning bodies. Leaves the first sample.
int EventWatch::samples(double from, double to, const StateAt& state_at) {
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
  return static_cast<int>(std::clamp(std::ceil(turn / turn_between_samples), fewest_samples, most_samples));
}

// Of those found between two samples, the earliest last, the first one, which takes those of the list with it that
// happen then too; of these the first in the list. The others stay for the next calls of find().
FoundEvent EventWatch::first_found(const StateAt& state_at) {
  FoundEvent first = found_.back();
  found_.pop_back();
  const auto is_listed = [&](const FoundEvent& found) { return found.event < static_cast<int>(events_.size()); };
  const double near = first.t + one_instant * (times_[2] - times_[1]);
  std::vector<FoundEvent> later;
  const bool alone = found_.empty() || found_.back().t > near;
  const std::optional<Snapshot> state = alone ? std::nullopt : state_at(first.t);
  for (; !found_.empty() && found_.back().t <= near; found_.pop_back()) {
    const FoundEvent found = found_.back();
    const auto k = static_cast<std::size_t>(found.event);
    const bool reached =
        found.t == first.t || (state && is_listed(found) && side(k, value_of(k, *state) - target(k)) == 0);
    if (is_listed(found) && reached) {
      simultaneous_.push_back({found.event, first.t});
    } else {
      later.push_back(found);
    }
  }
  found_.insert(found_.end(), later.rbegin(), later.rend());
  // What the mechanism does by itself comes after them, and is found again.
  if (is_listed(first)) {
    simultaneous_.push_back(first);
  } else {
    found_.clear();
  }
  std::sort(simultaneous_.begin(), simultaneous_.end(),
            [](const FoundEvent& a, const FoundEvent& b) { return a.event > b.event; });
  if (!simultaneous_.empty()) {
    first = simultaneous_.back();
    simultaneous_.pop_back();
  }
  const auto take_note = [&](const FoundEvent& found) {
    int& last_seen = side_[static_cast<std::size_t>(found.event)];
    last_seen = -last_seen;
    found_at_[static_cast<std::size_t>(found.event)] = found.t;
  };
  take_note(first);
  std::for_each(simultaneous_.begin(), simultaneous_.end(), take_note);
  // The last one tells up to where they were given.
  if (!found_.empty()) found_.push_back(first);
  return first;
}

namespace {

FoundEvent take_last(std::vector<FoundEvent>& events) {
  const FoundEvent last = events.back();
  events.pop_back();
  return last;
}

bool is_later(const FoundEvent& a, const FoundEvent& b) { return a.t != b.t ? a.t > b.t : a.event > b.event; }

}  // namespace

std::optional<FoundEvent> EventWatch::find(double from, double to, const StateAt& state_at) {
  if (!simultaneous_.empty()) return take_last(simultaneous_);
  if (!(from < to)) return {};
  // Found with the last one, in a motion that went on unchanged.
  if (!found_.empty() && found_.back().t == from && times_[2] <= to) {
    found_.pop_back();
    return first_found(state_at);
  }
  const int parts = samples(from, to, state_at);
  times_[2] = from;
  // A transition knows the side on which it begins, whatever rounding says at once.
  for (std::size_t k = 0; parts > 0 && k < events_.size(); ++k) {
    const int now = side(k, g_[2][k]);
    if (now != 0) side_[k] = now;
  }
  for (int n = 1; n <= parts; ++n) {
    // The last three samples, the newest of them last.
    std::rotate(g_.begin(), g_.begin() + 1, g_.end());
    std::rotate(times_.begin(), times_.begin() + 1, times_.end());
    times_[2] = n == parts ? to : from + (to - from) * n / parts;
    const std::optional<Snapshot> state = state_at(times_[2]);
    if (!state) return {};
    sample(*state, g_[2]);
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
    std::sort(found_.begin(), found_.end(), is_later);
    const FoundEvent first = first_found(state_at);
    // A column that comes back before the next sample may pass its value again before the others.
    if (dips) found_.clear();
    return first;
  }
  return {};
}

bool EventWatch::take(const FoundEvent& found) {
  const Event& event = events_[static_cast<std::size_t>(found.event)];
  records_.push_back({event.name, found.event, found.t, rows_given ? rows_given() - 1 : 0});
  if (event.action == EventAction::record) return false;
  found_.clear();
  return true;
}

}  // namespace catena
