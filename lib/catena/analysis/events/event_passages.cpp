// EventWatch between two samples: which columns pass their values there, and where these passages are.
#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/events/event_watch.hpp"
#include "catena/analysis/motion/step_growth.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

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

// As watched(), which is known at the last samples.
double EventWatch::value_at(std::size_t k, double t, const StateAt& state_at) {
  for (std::size_t n = times_.size(); n-- > 0;) {
    if (times_[n] == t) return g_[n][k];
  }
  return watched(k, t, state_at);
}

// The root between an instant on the old side and one on the new side, to rounding in t; given is the end on the new
// side. Inverse quadratic interpolation through the last three points where Chandrupatla's test says that it converges
// (Adv. Eng. Softw. 28 (1997)), bisection otherwise. Nothing where no instant on the old side is found.
std::optional<double> EventWatch::locate(std::size_t k, double before, double after, const StateAt& state_at) {
  double a = before, b = after, fa = value_at(k, a, state_at), fb = value_at(k, b, state_at);
  const int old = side_[k].at;
  // After an event at the start itself the column may have gone beyond and be on its way back. Where it stays at its
  // value rounding decides on the sign.
  const auto is_there = [&](double f) { return side_[k].is_expected ? side(k, f) == old : f * old > 0; };
  for (double part = 0.5; !is_there(fa); part /= 2) {
    // Nearer to the first sample nothing is looked for.
    if (part < shortest_step) return {};
    a = before + (after - before) * part;
    fa = watched(k, a, state_at);
  }
  if (!(fb * old < 0)) return b;
  double part = fb / (fb - fa);  // of the way from the newest point to the one on the other side: the secant at first
  bool newest_is_after = true;
  for (int n = 0; n < thresholds::most_bisections; ++n) {
    const double least = 2 * std::numeric_limits<double>::epsilon() * std::max(std::abs(a), std::abs(b));
    const double width = b - a;
    if (width <= 2 * least) break;
    if (!std::isfinite(part)) part = 0.5;  // a value has a pole there
    part = std::clamp(part, std::min(0.5, least / width), std::max(0.5, 1 - least / width));
    const double t = newest_is_after ? b - part * width : a + part * width;
    const double f = watched(k, t, state_at);
    if (f == 0) return t;
    // The point that gives way to the newest one, where they are on one side; else the newest before.
    const bool is_after = f * old < 0;
    const double third = is_after ? b : a, f_third = is_after ? fb : fa;
    double& replaced = is_after ? b : a;
    double& f_replaced = is_after ? fb : fa;
    replaced = t;
    f_replaced = f;
    newest_is_after = is_after;
    const double x1 = t, f1 = f, x2 = is_after ? a : b, f2 = is_after ? fa : fb;
    const double xi = (x1 - x2) / (third - x2), eta = (f1 - f2) / (f_third - f2);
    part = 0.5;
    if (eta * eta < xi && (1 - eta) * (1 - eta) < 1 - xi)
      part = f1 / (f2 - f1) * f_third / (f2 - f_third) +
             (third - x1) / (x2 - x1) * f1 / (f_third - f1) * f2 / (f_third - f2);
  }
  return b;
}

// An instant up to the last sample at which column k is beyond its value, or nothing. `three`: there are three samples.
std::optional<double> EventWatch::passage(std::size_t k, bool three, const StateAt& state_at) {
  const int old = side_[k].at;
  if (side(k, g_[2][k]) == -old) return times_[2];
  if (!three) return {};
  // A dip: the parabola through three samples has its vertex among them and reaches the value there, or nearly so. The
  // vertex may lie in the first or the last part of a step, beyond the nearest sample.
  double ts[3] = {times_[0], times_[1], times_[2]}, gs[3] = {g_[0][k], g_[1][k], g_[2][k]};
  for (int n = 0; n < 8; ++n) {
    const Vertex low = vertex(ts, gs);
    const double nearest = std::min({std::abs(gs[0]), std::abs(gs[1]), std::abs(gs[2])});
    if (!low.inside || low.value * old > 0.1 * nearest || low.t == ts[1]) return {};
    const double g = watched(k, low.t, state_at);
    if (side(k, g) == -old) return low.t;
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

// Columns that pass their values in a watched direction up to the last sample, those first that straight lines through
// the samples let pass first. `three`: there are three samples.
std::vector<EventWatch::Enclosed> EventWatch::enclose_passages(bool three, const StateAt& state_at) {
  std::vector<Enclosed> enclosed;
  for (std::size_t k = 0; k < side_.size(); ++k) {
    const int now = side(k, g_[2][k]);
    if (side_[k].at == 0 || now == side_[k].at) side_[k] = {now};
    if (side_[k].at == 0) continue;
    const std::optional<double> beyond = passage(k, three, state_at);
    if (!beyond) continue;
    Enclosed passage{k, *beyond > times_[1] ? times_[1] : times_[0], *beyond, *beyond != times_[2]};
    if (!counts(k)) {
      // A passage in a direction that is not watched; the return from a dip is watched.
      side_[k] = {-side_[k].at};
      if (!passage.dips) continue;
      passage.before = passage.after;
      passage.after = times_[2];
    }
    const double fall = (g_[2][k] - g_[1][k]) / (times_[2] - times_[1]);
    passage.about = passage.dips ? passage.before : times_[1] - g_[1][k] / fall;
    enclosed.push_back(passage);
  }
  std::stable_sort(enclosed.begin(), enclosed.end(),
                   [](const Enclosed& a, const Enclosed& b) { return a.about < b.about; });
  return enclosed;
}

// Where they pass, into found_. Of transitions the first one counts alone, as the motion that is watched ends there:
// those that are on their side still at the first one so far come later, and are not located. Whether any dips.
bool EventWatch::locate_passages(const std::vector<Enclosed>& enclosed, const StateAt& state_at) {
  found_.clear();
  bool dips = false;
  double first = std::numeric_limits<double>::infinity();  // of transitions
  bool sampled = false;                                    // then_ is that of `first`
  for (const Enclosed& passage : enclosed) {
    const std::size_t k = passage.k;
    double after = passage.after;
    if (k >= events_.size() && after > first) {
      if (passage.before >= first) continue;
      if (!sampled) {
        then_.assign(side_.size(), std::numeric_limits<double>::quiet_NaN());
        if (const std::optional<Snapshot> state = state_at(first)) sample(*state, then_);
        sampled = true;
      }
      // At its value then it passes at the same instant, to rounding: one of them is as good as the other.
      const int then = side(k, then_[k]);
      if (then != -side_[k].at && !std::isnan(then_[k])) continue;
      if (then == -side_[k].at) after = first;
    }
    const std::optional<double> located = locate(k, passage.before, after, state_at);
    const double t = located.value_or(passage.before);
    // The event that was found there already, seen again within rounding; or the column left its value to where it came
    // from.
    if (t <= found_at_[k] || (!located && side_[k].is_expected)) {
      side_[k] = {-side_[k].at};
      continue;
    }
    found_.push_back({static_cast<int>(k), t});
    dips = dips || passage.dips;
    if (k < events_.size() || !(t < first)) continue;
    first = t;
    sampled = false;
  }
  return dips;
}

}  // namespace catena
