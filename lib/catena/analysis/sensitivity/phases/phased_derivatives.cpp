#include "catena/analysis/sensitivity/phases/phased_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
PhasedDerivatives::~PhasedDerivatives() = default;

PhasedDerivatives::PhasedDerivatives(PhasedDesign design, GivenByModel start, std::shared_ptr<InstantRates> rates)
    : StateDerivatives(Plan::make(*design.contacts.model, design.all_rows), *design.contacts.model, design.models,
                       design.parameters),
      n_(at(plan().coordinates())),
      models_(std::move(design.models)),
      contacts_(std::move(design.contacts)),
      open_plan_(Plan::make(*contacts_.model, design.open_rows)),
      events_(std::move(design.events)),
      sizes_(std::move(design.sizes)),
      given_start_(start),
      aim_(std::move(design.aim)),
      instants_(std::move(rates)),
      switches_(evaluator().model(), plan()),
      stage_(2 * n_),
      y_(2 * n_) {
  equations_ = std::make_unique<PhaseEquations>(evaluator(), contacts_);
  length_scale_ = std::max(evaluator().length_scale(), 1.0);
  for (const int element : plan().row_element) always_.push_back(open_plan_->element_row[at(element)] >= 0);
  for (const Group& group : groups()) {
    Track& track = tracks_.emplace_back();
    for (DesignVector* y : {&track.begin, &track.end, &track.before}) y->resize(2 * n_);
    track.anchor.resize(at(plan().rows));
    track.stage.assign(16, DesignVector(2 * n_));
    places_.push_back(design_places(group.mechanism.model(), contacts_.points));
    if (std::string trouble = trouble_with_places(group.mechanism.model()); !trouble.empty()) fail(std::move(trouble));
  }
}

PhaseEquations::Design PhasedDerivatives::design(std::size_t k) {
  return {groups()[k].mechanism, places_[k], at(groups()[k].count)};
}

std::string PhasedDerivatives::name(std::size_t place) const {
  return contacts_.model->element_name(contacts_.points[place].element);
}

bool PhasedDerivatives::singular(double t) {
  return fail(
      fmt::format("at t = {:.9g} s the motion passes a singular configuration, or friction wedges, beyond which its "
                  "derivatives are not known",
                  t));
}

bool PhasedDerivatives::not_shown(double t) {
  return fail(
      fmt::format("the motion could not be looked at at t = {:.9g} s, beyond which its derivatives are not known", t));
}

bool PhasedDerivatives::factorize(double t, Side side, const DesignVector& y) {
  return equations_->factorize(t, side, std::span(y).first(n_), groups().front().mechanism);
}

// y' at y; the factors belong to its values, accelerations and multipliers of the group to it.
bool PhasedDerivatives::slope(std::size_t k, double t, Side side, const DesignVector& y, DesignVector& out) {
  Group& group = groups()[k];
  group.mechanism.set_time(t, side);
  const std::span<const DesignScalar> q = std::span(y).first(n_), qd = std::span(y).subspan(n_);
  if (!equations_->accelerate(design(k), q, qd, group.qdd, group.lambda)) return false;
  std::copy(qd.begin(), qd.end(), out.begin());
  std::copy(group.qdd.begin(), group.qdd.end(), out.begin() + static_cast<std::ptrdiff_t>(n_));
  return true;
}

// A parameter has no derivatives from here on.
void PhasedDerivatives::lose(std::size_t k, std::size_t p, Track& track) {
  if (p >= at(groups()[k].count)) return;
  for (DesignScalar& y : track.end) y.d[p] = std::numeric_limits<double>::quiet_NaN();
}

bool PhasedDerivatives::start(double t, std::span<const double> q_values, std::span<const double> qd_values) {
  has_.start = true;
  from_ = to_ = t;
  for (const VelocityJump& jump : phase_.jumps) {
    if (!jump.places.empty()) return fail("the motion begins with an impact: earlier or later are different motions");
  }
  EvaluationWork work;
  Evaluator open(open_plan_, *contacts_.model, work);
  open.go_to_curve_places(evaluator().curve_places());
  open.set_time(t);
  open.set_configuration(q_values);
  StartDerivatives start(open, given_start_);
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    DesignMechanism mechanism(open, models_[k]);
    mechanism.lift_configuration(q_values, q(tracks_[k].end));
    for (std::size_t c = 0; c < n_; ++c) tracks_[k].end[n_ + c] = qd_values[c];
    if (!start.find(mechanism, groups()[k].count, q(tracks_[k].end), qd(tracks_[k].end)))
      return fail("the start of the motion has no derivative: " + start.why());
    groups()[k].mechanism.set_time(t);
    find_anchors(k);
    check_rows(k, t, true);
  }
  if (!lost_.empty()) lack_derivatives(lost_);
  const MovingInstant& instant = instant_at(t);
  if (!instant.moves()) return true;
  lack_derivatives(
      fmt::format("the motion begins at t = {:.9g} s, where a function of time jumps at an instant that moves with the "
                  "parameters: earlier or later are different motions",
                  t));
  for (std::size_t p = 0; p < instant.rate.size(); ++p) {
    if (instant.rate[p] != 0) lose(p / parameters_at_once, p % parameters_at_once, tracks_[p / parameters_at_once]);
  }
  return true;
}

// Slides of places that stick keep the value that they have now.
void PhasedDerivatives::find_anchors(std::size_t k) {
  Group& group = groups()[k];
  Track& track = tracks_[k];
  group.mechanism.set_state(q(track.end));
  group.mechanism.rows(group.rows);
  std::fill(track.anchor.begin(), track.anchor.end(), DesignScalar());
  for (std::size_t place = 0; place < contacts_.points.size(); ++place) {
    if (!equations_->sticks(place)) continue;
    const std::size_t row = at(equations_->slide_row(place));
    track.anchor[row].d = group.rows[row].f.d;
  }
}

// What a derivative of a place by a parameter may be though it is none.
double PhasedDerivatives::rounding(std::size_t k, std::size_t p) const {
  const std::size_t number = k * at(parameters_at_once) + p;
  const double size = number < sizes_.size() && sizes_[number] != 0 ? std::abs(sizes_[number]) : 1;
  return thresholds::solved * length_scale_ / size;
}

// A row that begins to hold must be met whatever the parameters are: else another motion begins there. Where the
// instant moves with them the place may not: what is left of it is as wrong as the place was at the instant before.
void PhasedDerivatives::check_rows(std::size_t k, double t, bool starts) {
  Group& group = groups()[k];
  Track& track = tracks_[k];
  group.mechanism.set_state(q(track.end), qd(track.end));
  group.mechanism.rows(group.rows);
  const std::vector<char> met = starts ? always_ : std::vector<char>{};
  for (std::size_t p = 0; p < at(group.count); ++p) {
    double moved = 0;
    for (std::size_t c = 0; c < n_ && !starts; ++c) moved = std::max(moved, std::abs(track.before[c].d[p]));
    const double none = rounding(k, p) + thresholds::same_value * moved;
    const int row = equations_->row_not_met(group.rows, track.anchor, q(track.end), qd(track.end), p, none, met);
    if (row < 0) continue;
    if (lost_.empty())
      lost_ = fmt::format(
          "at t = {:.9g} s \"{}\" begins to hold, but a parameter opens it there or breaks it: one way and the other "
          "are different motions",
          t, contacts_.model->element_name(plan().row_element[at(row)]));
    lose(k, p, track);
  }
}

bool PhasedDerivatives::make_step(double h) {
  const Tableau& table = dormand_prince_8();
  for (int s = 0; s < table.stages; ++s) {
    // Values of the stage are the same in all groups: one factorization serves them all.
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      Track& track = tracks_[k];
      combine_stages(table.a[at(s)], h, track.begin, track.stage, stage_);
      const bool at_end = table.c[at(s)] == 1;
      const double t = at_end ? to_ : from_ + table.c[at(s)] * h;
      const Side side = at_end ? Side::before : Side::after;
      if (k == 0 && !factorize(t, side, stage_)) return singular(t);
      if (!slope(k, t, side, stage_, track.stage[at(s)])) return singular(t);
    }
  }
  for (Track& track : tracks_) combine_stages(table.b, h, track.begin, track.stage, track.end);
  std::string trouble = switches_.trouble_in(from_, to_, tracks_.front().stage);
  return trouble.empty() || fail(std::move(trouble));
}

// Values are the motion's own: angles may have been moved by whole turns.
bool PhasedDerivatives::take_values(const MotionStretch& stretch, double t, DesignVector Track::*y) {
  const std::optional<Snapshot> state = stretch.at(t);
  if (!state) return not_shown(t);
  const std::vector<CurvePlace>& places = state->evaluator.curve_places();
  evaluator().go_to_curve_places(places);
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    groups()[k].mechanism.go_to_curve_places(places);
    for (std::size_t c = 0; c < n_; ++c) {
      (tracks_[k].*y)[c].v = state->q[c];
      (tracks_[k].*y)[n_ + c].v = state->qd[c];
    }
  }
  return true;
}

bool PhasedDerivatives::project(double t, Side side, DesignVector Track::*y) {
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    Track& track = tracks_[k];
    if (k == 0 && !factorize(t, side, track.*y)) return singular(t);
    groups()[k].mechanism.set_time(t, side);
    if (!equations_->project(design(k), track.anchor, q(track.*y), qd(track.*y))) return singular(t);
  }
  return true;
}

// Once derivatives are lost they stay lost: why() says it, and find() fails.
void PhasedDerivatives::cover(const MotionStretch& stretch) {
  if (!why().empty()) return;
  if (!has_.start) {
    const std::optional<Snapshot> state = stretch.at(stretch.from);
    if (!state) {
      not_shown(stretch.from);
      return;
    }
    const std::vector<double> q(state->q.begin(), state->q.end()), qd(state->qd.begin(), state->qd.end());
    if (!start(stretch.from, q, qd)) return;
  }
  if (!parts_.empty()) go_to_part(stretch.from);
  if (!take_values(stretch, stretch.from, &Track::end)) return;
  parts_.clear();
  has_.step = false;
  to_ = stretch.from;
  const std::vector<double> ends = smooth_parts(stretch, power_places(contacts_, phase_.states, places_));
  if (ends.empty()) {
    not_shown(stretch.to);
    return;
  }
  if (!cover_between(stretch, ends, switches_.any() ? switches_.find(stretch) : Switches{})) return;
  found_.clear();
  if (stretch.ended_by >= 0) find_rates(stretch);
  const MovingInstant& instant = instant_at(to_);
  if (instant.order == 1 || instant.moves()) cross_functions();
}

const DesignVector& PhasedDerivatives::end_of_step(const Track& track) const {
  return crossed_.t == to_ ? track.before : track.end;
}

// The stages that its interpolant has beyond those of the step.
bool PhasedDerivatives::prepare_interpolant() {
  const Tableau& table = dormand_prince_8();
  const double h = to_ - from_;
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    Track& track = tracks_[k];
    const DesignVector& end = end_of_step(track);
    if (!factorize(to_, Side::before, end)) return singular(to_);
    if (!slope(k, to_, Side::before, end, track.stage[12])) return singular(to_);
    for (std::size_t s = 13; s < 16; ++s) {
      const double t = from_ + table.c[s] * h;
      combine_stages(table.a[s], h, track.begin, track.stage, stage_);
      if (!factorize(t, Side::after, stage_)) return singular(t);
      if (!slope(k, t, Side::after, stage_, track.stage[s])) return singular(t);
    }
  }
  return true;
}

bool PhasedDerivatives::find(const Snapshot& snapshot) {
  if (!why().empty()) return false;
  if (!has_.start) {
    const std::vector<double> q(snapshot.q.begin(), snapshot.q.end()), qd(snapshot.qd.begin(), snapshot.qd.end());
    if (!start(snapshot.t, q, qd)) return false;
  }
  if (!go_to_part(snapshot.t)) return not_shown(snapshot.t);
  const bool inside = has_.step && snapshot.t != to_ && snapshot.t != from_;
  if (inside && !has_.interpolant) {
    if (!prepare_interpolant()) return false;
    has_.interpolant = true;
  }
  // At a jump of functions the motion may show velocities of either side: its own are those after it.
  const bool jumps = crossed_.t == snapshot.t;
  const std::vector<CurvePlace>& places = snapshot.evaluator.curve_places();
  evaluator().go_to_curve_places(places);
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    Group& group = groups()[k];
    Track& track = tracks_[k];
    group.mechanism.go_to_curve_places(places);
    y_ = has_.step && snapshot.t == from_ ? track.begin : track.end;
    if (inside) {
      const double h = to_ - from_;
      interpolate_derivatives((snapshot.t - from_) / h, h, track.begin, end_of_step(track), track.stage, y_);
    }
    for (std::size_t c = 0; c < n_; ++c) {
      y_[c].v = snapshot.q[c];
      if (!jumps) y_[n_ + c].v = snapshot.qd[c];
    }
    if (k == 0 && !factorize(snapshot.t, Side::after, y_)) return singular(snapshot.t);
    group.mechanism.set_time(snapshot.t, Side::after);
    if (!equations_->project(design(k), track.anchor, q(y_), qd(y_))) return singular(snapshot.t);
    if (!take_state(k, snapshot, Side::after, y_)) return false;
  }
  return true;
}

bool PhasedDerivatives::find_before(const Snapshot& snapshot) {
  if (crossed_.t != snapshot.t || !why().empty()) return false;
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    const DesignVector& y = tracks_[k].before;
    if (k == 0 && !factorize(snapshot.t, Side::before, y)) return singular(snapshot.t);
    if (!take_state(k, snapshot, Side::before, y)) return false;
  }
  return true;
}

bool PhasedDerivatives::take_state(std::size_t k, const Snapshot& snapshot, Side side, const DesignVector& y) {
  Group& group = groups()[k];
  std::copy_n(y.begin(), n_, group.q.begin());
  std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(n_), n_, group.qd.begin());
  if (!slope(k, snapshot.t, side, y, stage_)) return singular(snapshot.t);
  // Shares of friction are found with the values of the parameters alone.
  leave_out_shares(group, equations_->shared_rows());
  equations_->contacts(design(k), group.lambda, group.contacts);
  if (!equations_->dependent_rows().empty()) leave_out_reactions(group);
  return true;
}

const std::vector<double>* PhasedDerivatives::phase_instant(double t) const {
  const auto found = phase_instants_.find(t);
  return found == phase_instants_.end() ? nullptr : &found->second;
}

}  // namespace catena
