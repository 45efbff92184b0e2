// Buckling under forces without a potential: divergence and flutter of the equilibrium, kept in place.
//
//   M x'' + K(p) x = 0 on the null space of Phi_q, K unsymmetric         det Z^T K(p) Z = 0, or two omega2 that meet
//
// The spectrum is sampled outwards from the present value on both sides, in steps that grow from where it begins to
// change; between samples of different kinds the loads are located (spectrum_crossings.hpp), and where a value dips
// between three samples the dip is looked at. The search ends where the nearest loads are known, or at 10^4 first
// steps: loads a hundred times those that change omega2 by itself.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/run/energyless_forces.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/circulatory_words.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/spectrum/modes_operator.hpp"
#include "catena/analysis/spectrum/spectrum_crossings.hpp"
#include "catena/analysis/stability/buckling.hpp"
#include "catena/analysis/stability/load_search.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// How far loads are looked for, in first steps.
constexpr double farthest_search = 1e4;

/// Largest relative change of the values, sorted, that is more than rounding under the load.
double shift_of(const CirculatoryModes& from, const CirculatoryModes& to, const StiffnessFloor& rounding) {
  if (from.modes.size() != to.modes.size()) return 1;
  double most = 0;
  for (std::size_t k = 0; k < from.modes.size(); ++k) {
    const double size = std::max(std::abs(from.modes[k].omega2), std::numeric_limits<double>::min());
    const double change = std::hypot(to.modes[k].omega2 - from.modes[k].omega2, to.modes[k].imaginary);
    if (change > rounding(to.modes[k].shape)) most = std::max(most, change / size);
  }
  return most;
}

/// Whether the load is so large that rounding of what bears it hides every one of the values.
bool is_hidden(const CirculatoryModes& from, const CirculatoryModes& to, const StiffnessFloor& rounding) {
  double largest = 0;
  for (const CirculatoryMode& mode : from.modes) largest = std::max(largest, std::abs(mode.omega2));
  return std::all_of(to.modes.begin(), to.modes.end(), [&](const CirculatoryMode& mode) {
    return rounding(mode.shape) >= FirstLoadStep::least_change * largest;
  });
}

}  // namespace

class Buckling::CirculatorySearch {
 public:
  CirculatorySearch(Buckling& buckling, const std::function<bool()>& go_on)
      : buckling_(buckling), go_on_(go_on), tangent_(buckling.system_), wanted_(at(buckling.options_.count)) {}

  Report run(std::vector<CriticalLoad>& loads, BucklingReport& report) {
    if (Report start = take_masses(report); !start.ok()) return start;
    if (Report start = check_present(); !start.ok()) return start;
    if (!find_first_step()) return {};
    for (Front& front : fronts_) front.samples = {{0, present_}};
    Report outcome;
    for_each_distance(step_, farthest_search, [&](double reach) {
      for (Front& front : fronts_) {
        outcome = go_on_ && !go_on_() ? Report{Status::cancelled, "stopped while loads were looked for", {}}
                                      : take_sample(front, reach);
        if (!outcome.ok()) return false;
      }
      farthest_ = reach;
      return loads_.size() < wanted_ && (fronts_[0].open || fronts_[1].open);
    });
    if (!outcome.ok()) return outcome;
    std::sort(loads_.begin(), loads_.end(), comes_first<CriticalLoad>);
    loads_.resize(std::min(loads_.size(), wanted_));
    loads = std::move(loads_);
    return {};
  }
  /// How far from the present value loads were looked for.
  double farthest() const { return farthest_; }
  bool sees_flutter() const { return sees_flutter_; }

 private:
  struct Front {
    double sign;
    bool open = true;
    std::vector<SpectrumSample> samples{};  // the last two
  };

  Report take_masses(BucklingReport& report) {
    std::string lack;
    motions_ = motions_in_masses(buckling_.system_, tangent_, lack);
    if (!motions_->are_small())
      return too_large_without_energy(*buckling_.model_, motions_->freedoms(), CirculatoryMotions::most_freedoms);
    sees_flutter_ = lack.empty();
    if (!sees_flutter_) report.warnings.push_back("flutter depends on masses, and was not looked for: " + lack);
    return {};
  }

  Report check_present() {
    Report outcome = spectrum(0, present_);
    if (!outcome.ok()) return outcome;
    if (present_.negative > 0 || (sees_flutter_ && present_.pairs > 0)) return buckling_.not_stable();
    if (present_.neutral > 0)
      return Buckling::neutral(present_.neutral, free_bodies_of(buckling_.system_, buckling_.point_.lambda, present_));
    return {};
  }

  /// The spectrum at a distance from the present value.
  Report spectrum(double x, CirculatoryModes& found) {
    if (Report placed = buckling_.place_load(buckling_.options_.present + x); !placed.ok()) return placed;
    if (motions_->find(buckling_.loaded_, 0, found)) return {};
    return {
        Status::not_converged,
        fmt::format("the stiffness at the value {:.6g} of the parameter is not finite", buckling_.options_.present + x),
        {}};
  }
  bool has_spectrum(double x, CirculatoryModes& found) { return spectrum(x, found).ok(); }

  /// Where the spectrum has changed by a few percent of itself, to a side that the scene allows. False: it does not.
  bool find_first_step() {
    FirstLoadStep first(buckling_.options_.present);
    double change = 0;
    for (int k = 0; k < thresholds::most_bisections; ++k) {
      step_ = first.step();
      if (!std::isfinite(step_)) break;
      CirculatoryModes there;
      if (has_spectrum(step_, there) || has_spectrum(-step_, there)) {
        const StiffnessFloor rounding = buckling_.floor_under_load();
        change = shift_of(present_, there, rounding);
        if (change == 0 && is_hidden(present_, there, rounding)) return false;
        if (first.take(change)) return true;
      } else {
        change = 1;
        first.refuse();
      }
      if (!first.move(change)) return true;
    }
    return change > FirstLoadStep::no_change;
  }

  Report take_sample(Front& front, double reach) {
    if (!front.open) return {};
    SpectrumSample next{reach, {}};
    Report outcome = spectrum(front.sign * reach, next.found);
    if (!outcome.ok() && !buckling_.outside_) return outcome;
    front.open = outcome.ok();
    if (!front.open) {
      // Up to the end of what the scene allows.
      double inside = front.samples.back().s, beyond = reach;
      for (int k = 0; k < thresholds::most_bisections; ++k) {
        const double middle = 0.5 * (inside + beyond);
        if (middle == inside || middle == beyond) break;
        CirculatoryModes there;
        (has_spectrum(front.sign * middle, there) ? inside : beyond) = middle;
      }
      next.s = inside;
      if (!(inside > front.samples.back().s) || !has_spectrum(front.sign * inside, next.found)) return {};
    }
    const SpectrumAt at_distance = [&](double s, CirculatoryModes& found) {
      return has_spectrum(front.sign * s, found);
    };
    SpectrumSample hidden;
    const SpectrumSample last = front.samples.back();
    if (front.samples.size() == 2 && find_hidden_change(at_distance, front.samples[0], last, next, hidden)) {
      const bool before = hidden.s < last.s;
      look_between(at_distance, front, before ? front.samples[0] : last, hidden);
      look_between(at_distance, front, hidden, before ? last : next);
    }
    look_between(at_distance, front, last, next);
    front.samples = {last, std::move(next)};
    return {};
  }

  void look_between(const SpectrumAt& at_distance, const Front& front, const SpectrumSample& low,
                    const SpectrumSample& high) {
    bool complete = true;
    for (SpectrumCrossing& crossing : find_crossings(at_distance, low, high, complete)) {
      // Flutter sets in where two oscillations meet; two divergences that meet are unstable before.
      const bool counts = crossing.flutter ? sees_flutter_ && crossing.pairs > 0 && crossing.omega2 > 0 : true;
      if (!counts) continue;
      const int times = crossing.flutter ? crossing.pairs : std::abs(crossing.values);
      const double omega = crossing.flutter ? std::sqrt(crossing.omega2) : 0;
      for (int k = 0; k < times; ++k)
        loads_.push_back({front.sign * crossing.s, crossing.flutter, omega, crossing.mode});
    }
  }

  Buckling& buckling_;
  const std::function<bool()>& go_on_;
  StaticTangent tangent_;
  std::unique_ptr<CirculatoryMotions> motions_;
  bool sees_flutter_ = false;
  CirculatoryModes present_;
  double step_ = 0, farthest_ = 0;
  std::size_t wanted_;
  Front fronts_[2] = {{1}, {-1}};
  std::vector<CriticalLoad> loads_;
};

Report Buckling::find_without_energy(BucklingReport& report, const std::function<bool()>& go_on) {
  CirculatorySearch search(*this, go_on);
  std::vector<CriticalLoad> loads;
  if (Report outcome = search.run(loads, report); !outcome.ok()) return outcome;
  report.flutter_sought = search.sees_flutter();
  for (CriticalLoad& load : loads) {
    const double value = options_.present + load.distance;
    (load.flutter ? report.flutter : report.loads).push_back(value);
    report.critical.push_back({value, load.omega});
    const double largest = decisive_component(*plan_, load.shape);
    for (double& x : load.shape) x /= largest;
    report.shapes.push_back(std::move(load.shape));
  }
  if (loads.empty()) {
    report.warnings.push_back(search.farthest() > 0
                                  ? fmt::format("no value of the parameter within {:.6g} of the present one makes this "
                                                "equilibrium {}",
                                                search.farthest(), search.sees_flutter() ? "unstable" : "diverge")
                                  : "the parameter does not change how this equilibrium moves");
  } else if (static_cast<int>(loads.size()) < options_.count) {
    report.warnings.push_back(
        fmt::format("there are only {} such values within {:.6g} of the present one", loads.size(), search.farthest()));
  }
  return {};
}

}  // namespace catena
