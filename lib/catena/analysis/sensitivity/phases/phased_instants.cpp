// PhasedDerivatives: how the instants move at which phases end and events happen.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/contact/contact_loads.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/sensitivity/phases/phased_derivatives.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
// Rates of two conditions of one instant that differ by less than this part are one: they are good to 1e-8.
constexpr double one_rate = thresholds::same_value;

bool is_one(double a, double b) { return std::abs(a - b) <= one_rate * std::max(std::abs(a), std::abs(b)); }

/// The rates of an instant that is given by two conditions; where they move apart it has none.
void join(std::vector<double>& rate, const std::vector<double>& other) {
  for (std::size_t p = 0; p < rate.size(); ++p) {
    if (!is_one(rate[p], other[p])) rate[p] = unknown;
  }
}

}  // namespace

// What is zero where a place's phase ends, at the group's state; see ContactPhases.
DesignScalar PhasedDerivatives::end_value(std::size_t k, const WatchedPlace& watched) {
  const PlaceLaw law = equations_->law(places_[k][watched.place], watched.place);
  return law.end_value(equations_->motion(groups()[k].mechanism, watched.place), groups()[k].lambda, watched.ends);
}

// t*_p of a place that changes at the end of the step.
std::optional<std::vector<double>> PhasedDerivatives::rate_of_place(const MotionStretch* stretch,
                                                                    const WatchedPlace& watched) {
  std::vector<double> by_parameter;
  PhaseEquations::EndRate end;
  if (!factorize(to_, Side::before, tracks_.front().end)) return {};
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    if (!slope(k, to_, Side::before, tracks_[k].end, stage_)) return {};
    const DesignScalar value = end_value(k, watched);
    for (std::size_t p = 0; p < at(groups()[k].count); ++p) by_parameter.push_back(value.d[p]);
    if (k > 0) continue;
    std::vector<double> qd(n_);
    for (std::size_t c = 0; c < n_; ++c) qd[c] = tracks_[0].end[n_ + c].v;
    end = equations_->rate_of_end(groups()[0].mechanism, places_[0][watched.place], watched, fastest(evaluator(), qd));
    if (!end.trouble.empty()) lost_ = end.trouble;
  }
  if (!end.rate && end.trouble.empty() && stretch) {
    end.rate = rate_at_end(*stretch, [&](double t) -> std::optional<double> {
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
  if (watched.ends == PhaseEnd::shares) std::fill(by_parameter.begin(), by_parameter.end(), unknown);
  for (double& rate : by_parameter) rate = rate == 0 ? 0 : end.rate && *end.rate != 0 ? -rate / *end.rate : unknown;
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
  if (!is_first && !(std::abs(value - event.value) <= thresholds::solved * std::max(std::abs(event.value), 1.0)))
    return {};
  const std::optional<double> by_time = rate_at_end(stretch, event.column);
  if (!by_time) return {};
  const double change = std::abs(*by_time) * (to_ - from_);
  if (!is_first && change <= thresholds::no_jump * std::max(std::abs(event.value), 1.0)) return {};
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

// Whether a place is beyond the end of its phase by more than rounding, before the phase has lasted: what put it there,
// an impact, did so whatever the parameters are.
bool PhasedDerivatives::has_passed(const WatchedPlace& watched) {
  const DesignVector& y = tracks_.front().end;
  if (!factorize(to_, Side::after, y) || !slope(0, to_, Side::after, y, stage_)) return false;
  std::vector<double> qd(n_);
  for (std::size_t c = 0; c < n_; ++c) qd[c] = y[n_ + c].v;
  const double speed = fastest(evaluator(), qd), length = evaluator().length_scale();
  const PlaceLaw law = equations_->law(places_[0][watched.place], watched.place);
  return law.has_passed(equations_->motion(groups()[0].mechanism, watched.place), groups()[0].lambda, watched.ends,
                        length, speed);
}

// How the instant moves at which this phase begins.
std::vector<double> PhasedDerivatives::rates_of(const MotionPhase& phase) {
  std::vector<double> none(at(parameters()), 0.0), rate = none;
  if (phase.functions_jump) rate = instant_at(phase.t).rate;
  if (phase.ended_by >= 0 && at(phase.ended_by) < phase_.watched.size()) {
    const int number = static_cast<int>(events_.size()) + phase.ended_by;
    if (const auto found = found_.find(number); found != found_.end()) return found->second;
    const WatchedPlace& watched = phase_.watched[at(phase.ended_by)];
    if (from_ == to_ && !crossed_.rate.empty() && has_passed(watched)) {
      note_instant(*instants_, phase.t, crossed_.rate);
      return crossed_.rate;
    }
    const auto own = rate_of_place(nullptr, watched);
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

}  // namespace catena
