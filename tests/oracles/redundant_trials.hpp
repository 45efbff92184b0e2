// What becomes of random mechanisms (redundant_mechanisms.hpp, massless_mechanisms.hpp) when the library moves them,
// against their known motion.
//
//   ratio = max over rows and bodies of  |error| / (tolerance x amplification)
//
// Errors of places are in lengths of the mechanism, of angles in rad. Amplification is what becomes of a small change
// of the start, computed with the known motion: what double pendulums do to errors is not the library's fault. wrong:
// status ok, and the ratio above `most`, or a row missing. told: the same, with the warning that the motion went
// straight on where two branches pass each other nearer than steps can follow. refused: any other status.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <optional>

#include "catena/analysis/dynamics/dynamics.hpp"
#include "oracles/massless_mechanisms.hpp"

namespace catena::testing {

/// The motion at equally spaced instants, the last at `until`, and how much it amplifies changes of the start until
/// then.
struct KnownRows {
  static constexpr int count = 20;
  std::vector<double> times;
  std::vector<std::vector<JetPlace>> places;
  std::vector<Real> amplification;
};

/// Shortens the motion before it comes to a stop in a flat position, or near to one; false: nothing is left of it.
inline bool keep_clear_of_rest(KnownMotion& motion, double near, bool may_pass) {
  if (!motion.flat) return true;
  constexpr int samples = 400;
  KnownPath path(motion);
  Real clear = 0;
  for (int k = 0; k <= samples; ++k) {
    const Real t = motion.until * k / samples;
    path.go_to(t);
    const bool slow = std::abs(path.rate()[0]) < 0.2 * motion.pace || !may_pass;
    if (std::abs(motion.flat(path.z())) < near && slow) break;
    clear = t;
  }
  if (clear >= motion.until) return true;
  motion.until = 0.9 * static_cast<double>(clear);
  return motion.until * motion.pace > 0.3;
}

inline KnownRows known_rows(const KnownMotion& motion) {
  constexpr Real change = 1e-7L;
  KnownRows rows;
  std::vector<KnownPath> changed;
  for (int k = 0; k < motion.freedoms; ++k) {
    Coordinates z = motion.z, rate = motion.rate;
    z[static_cast<std::size_t>(k)] += change;
    changed.emplace_back(motion, z, motion.rate);
    rate[static_cast<std::size_t>(k)] += change * motion.pace;
    changed.emplace_back(motion, motion.z, rate);
  }
  KnownPath path(motion);
  Real most = 1;
  for (int k = 0; k <= KnownRows::count; ++k) {
    const double t = motion.until * k / KnownRows::count;
    path.go_to(t);
    rows.times.push_back(t);
    rows.places.push_back(motion.places_of(path.z(), path.rate()));
    for (KnownPath& other : changed) {
      other.go_to(t);
      const std::vector<JetPlace> places = motion.places_of(other.z(), other.rate());
      for (std::size_t b = 0; b < places.size(); ++b) {
        const JetPlace &p = places[b], &q = rows.places.back()[b];
        most = std::max({most, std::abs(p.phi.f - q.phi.f) / change,
                         std::hypot(p.r.x.f - q.r.x.f, p.r.y.f - q.r.y.f) / (motion.length * change)});
      }
    }
    rows.amplification.push_back(most);
  }
  return rows;
}

struct TrialOutcome {
  static constexpr double most = 30;
  bool ok = false, wrong = false, told = false;
  double ratio = 0;
  std::string message;
};

inline TrialOutcome run_trial_of(const KnownMotion& motion, const KnownRows& known, const DynamicsOptions& options) {
  TrialOutcome outcome;
  Dynamics dynamics(motion.model, {}, options);
  std::size_t row = 0;
  RowFunction compare([&](const Snapshot& s) {
    const std::vector<JetPlace>& places = known.places[row];
    const Real allowed = options.tolerance * known.amplification[row];
    for (std::size_t b = 0; b < places.size(); ++b) {
      const Frame<double> f = s.evaluator.ground_frame(s.evaluator.plan().plan_body[b]);
      const Real turned = std::abs(f.phi - places[b].phi.f) / allowed;
      const Real moved = std::hypot(f.x - places[b].r.x.f, f.y - places[b].r.y.f) / (motion.length * allowed);
      // A number that is none counts as any error.
      for (const Real part : {turned, moved}) {
        if (!(part <= outcome.ratio)) outcome.ratio = std::isfinite(part) ? static_cast<double>(part) : HUGE_VAL;
      }
    }
    ++row;
    return true;
  });
  const AnalysisReport report = dynamics.run(TimeGrid::list(known.times), {}, compare);
  outcome.ok = report.ok();
  const bool off = outcome.ok && (!(outcome.ratio <= TrialOutcome::most) || row != known.times.size());
  outcome.told = off && std::any_of(report.warnings.begin(), report.warnings.end(), [](const std::string& warning) {
                   return warning.find("went straight on where two branches pass") != std::string::npos;
                 });
  outcome.wrong = off && !outcome.told;
  outcome.message = std::string(to_string(report.status)) + ": " + report.message;
  return outcome;
}

struct TrialCount {
  int runs = 0, wrong = 0, told = 0, refused = 0;
  std::vector<double> ratios;
};

using TrialCounts = std::map<IntegrationMethod, TrialCount>;

/// Runs `cases` mechanisms with every method and tolerance. `draw(seed)` gives a motion, or nothing for a seed that is
/// no use; `report(seed, method, tolerance, outcome)` is called for every run that is wrong or refused.
template <class Draw, class Report>
void run_known_trials(Draw&& draw, unsigned seed, int cases, const std::vector<IntegrationMethod>& methods,
                      const std::vector<double>& tolerances, TrialCounts& counts, Report&& report) {
  for (int n = 0; n < cases; ++seed) {
    const std::optional<KnownMotion> motion = draw(seed);
    if (!motion) continue;
    ++n;
    const KnownRows known = known_rows(*motion);
    for (const IntegrationMethod method : methods) {
      for (const double tolerance : tolerances) {
        TrialCount& count = counts[method];
        const TrialOutcome outcome =
            run_trial_of(*motion, known, {.method = method, .tolerance = tolerance, .max_steps = 100'000});
        ++count.runs;
        count.wrong += outcome.wrong;
        count.told += outcome.told;
        count.refused += !outcome.ok;
        if (outcome.ok) count.ratios.push_back(outcome.ratio);
        if (outcome.wrong || outcome.told || !outcome.ok) report(seed, method, tolerance, outcome);
      }
    }
  }
}

/// A redundant mechanism of a kind, kept clear of a rest in a flat position.
inline std::optional<KnownMotion> draw_redundant(int kind, unsigned seed) {
  const bool lift = kind == number_of_kinds - 1;
  KnownMotion motion = redundant_motion(kind, seed);
  // A lift folded flat may go on in many ways.
  if (!keep_clear_of_rest(motion, lift ? 0.3 : 0.15, !lift)) return {};
  return motion;
}

/// A mechanism with massless bodies: first the kinds of massless_mechanisms.hpp, then those with redundant equations.
inline std::optional<KnownMotion> draw_massless(int kind, unsigned seed) {
  if (kind < number_of_massless_kinds) return massless_motion(kind, seed);
  std::optional<KnownMotion> motion = draw_redundant(massless_variants[kind - number_of_massless_kinds], seed);
  if (motion && !make_some_massless(*motion, seed)) return {};
  return motion;
}

}  // namespace catena::testing
