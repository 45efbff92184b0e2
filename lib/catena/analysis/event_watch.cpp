#include "catena/analysis/event_watch.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena {
namespace {

// Samples of a step.
constexpr int parts = 8;
// A distance from the value below this part of the column's size, or below this number, cannot be told from none.
constexpr double rounding = 1e-13;
constexpr double smallest = 1e-14;
constexpr int most_iterations = 80;

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
  }
  side_.assign(events_.size(), 0);
  largest_.assign(events_.size(), 0.0);
  g_.assign(parts + 1, std::vector<double>(events_.size()));
  times_.resize(parts + 1);
}

int EventWatch::side(std::size_t k, double g) const {
  const double tiny = std::max(smallest, rounding * std::max(largest_[k], std::abs(events_[k].value)));
  return g > tiny ? 1 : g < -tiny ? -1 : 0;
}

/// Whether a passage from the side last seen to the other one is in the direction that is watched.
bool EventWatch::counts(std::size_t k) const {
  return events_[k].direction == EventDirection::any || (events_[k].direction == EventDirection::up) == (side_[k] < 0);
}

bool EventWatch::sample(double t, const StateAt& state_at, std::span<double> g) {
  const std::optional<Snapshot> state = state_at(t);
  if (!state) return false;
  for (std::size_t k = 0; k < events_.size(); ++k) {
    double value = 0;
    columns_[k].evaluate(*state, {&value, 1});
    largest_[k] = std::max(largest_[k], std::abs(value));
    g[k] = value - events_[k].value;
  }
  return true;
}

double EventWatch::watched(std::size_t k, double t, const StateAt& state_at) {
  const std::optional<Snapshot> state = state_at(t);
  if (!state) return std::numeric_limits<double>::quiet_NaN();
  double value = 0;
  columns_[k].evaluate(*state, {&value, 1});
  return value - events_[k].value;
}

// The root between an instant on the old side and one on the new side: the secant through the ends, the older end's
// value halved when it stays (Illinois), bisection where that is slow.
double EventWatch::locate(std::size_t k, double before, double after, const StateAt& state_at) {
  double a = before, b = after, fa = watched(k, a, state_at), fb = watched(k, b, state_at);
  if (!(fa * side_[k] > 0)) return a;
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

// An instant up to sample number `sample` at which column k is beyond its value, or nothing.
std::optional<double> EventWatch::passage(std::size_t k, int sample, const StateAt& state_at) {
  const auto at = [&](int n) { return g_[static_cast<std::size_t>(n)][k]; };
  const double* t = &times_[static_cast<std::size_t>(sample)];
  if (side(k, at(sample)) == -side_[k]) return *t;
  if (sample < 2) return {};
  // A dip: the middle of three samples is nearest to the value, and the parabola reaches it, or nearly so.
  double ts[3] = {t[-2], t[-1], t[0]}, gs[3] = {at(sample - 2), at(sample - 1), at(sample)};
  if (!(std::abs(gs[1]) <= std::abs(gs[0]) && std::abs(gs[1]) <= std::abs(gs[2]))) return {};
  for (int n = 0; n < 8; ++n) {
    const Vertex low = vertex(ts, gs);
    if (!low.inside || low.value * side_[k] > 0.1 * std::abs(gs[1]) || low.t == ts[1]) return {};
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

std::optional<FoundEvent> EventWatch::find(double from, double to, const StateAt& state_at) {
  if (!(from < to)) return {};
  times_[0] = from;
  if (!sample(from, state_at, g_[0])) return {};
  for (std::size_t k = 0; k < events_.size(); ++k) {
    const int now = side(k, g_[0][k]);
    if (now != 0) side_[k] = now;
  }
  for (int n = 1; n <= parts; ++n) {
    const auto s = static_cast<std::size_t>(n);
    times_[s] = n == parts ? to : from + (to - from) * n / parts;
    if (!sample(times_[s], state_at, g_[s])) return {};
    std::optional<FoundEvent> first;
    for (std::size_t k = 0; k < events_.size(); ++k) {
      if (side_[k] == 0) {
        side_[k] = side(k, g_[s][k]);
        continue;
      }
      const std::optional<double> beyond = passage(k, n, state_at);
      if (!beyond) continue;
      double start = *beyond > times_[s - 1] ? times_[s - 1] : times_[s - 2], end = *beyond;
      if (!counts(k)) {
        // A passage that is not watched; out of a dip the way back is.
        side_[k] = -side_[k];
        if (*beyond == times_[s]) continue;
        start = *beyond;
        end = times_[s];
      }
      const double t = locate(k, start, end, state_at);
      if (!first || t < first->t) first = FoundEvent{static_cast<int>(k), t};
    }
    if (first) {
      int& last_seen = side_[static_cast<std::size_t>(first->event)];
      last_seen = -last_seen;
      return first;
    }
  }
  return {};
}

bool EventWatch::take(const FoundEvent& found) {
  const Event& event = events_[static_cast<std::size_t>(found.event)];
  records_.push_back({event.name, found.t, rows_given ? rows_given() - 1 : 0});
  return event.action != EventAction::record;
}

}  // namespace catena
