#include "catena/analysis/sensitivity/motion_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "catena/base/at.hpp"

namespace catena {

MotionDerivatives::MotionDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters,
                                     GivenByModel start, DerivativeAim aim)
    : StateDerivatives(evaluator, models, parameters),
      n_(at(plan().coordinates())),
      switches_(this->evaluator().model(), plan()),
      system_(evaluator.shared_plan(), SaddleBlock::diagonal),
      given_start_(start),
      aim_(std::move(aim)),
      values_(n_),
      stage_(2 * n_),
      y_(2 * n_) {
  for (std::size_t k = 0; k < groups().size(); ++k) {
    Track& track = tracks_.emplace_back();
    for (DesignVector* y : {&track.begin, &track.end, &track.before, &track.after}) y->resize(2 * n_);
    track.stage.assign(16, DesignVector(2 * n_));
  }
  if (groups().empty() || !AdjointMechanism::why_not(evaluator.model()).empty()) return;
  again_ = std::make_unique<RecomputedSteps>(this->evaluator());
  if (!again_->why_not().empty()) return;
  tangents_ = std::make_unique<MotionTangents>(this->evaluator(), mechanisms());
  for (auto* rows : {&rows_.begin, &rows_.end, &rows_.now}) rows->assign(2 * n_ * tangents_->width(), 0.0);
  rows_.accelerations.assign(n_ * tangents_->width(), 0.0);
}

bool MotionDerivatives::singular(double t) {
  return fail(
      fmt::format("at t = {:.9g} s the motion passes a singular configuration, beyond which its derivatives are "
                  "not known",
                  t));
}

bool MotionDerivatives::not_shown(double t) {
  return fail(
      fmt::format("the motion could not be looked at at t = {:.9g} s, beyond which its derivatives are not known", t));
}

bool MotionDerivatives::factorize(double t, Side side, std::span<const DesignScalar> q) {
  for (std::size_t c = 0; c < n_; ++c) values_[c] = q[c].v;
  evaluator().set_time(t, side);
  evaluator().set_configuration(values_);
  return system_.factorize(jacobian(), [this] {
    for (int c = 0; c < 3 * plan().moving; ++c) system_.add_diagonal(c, groups().front().mechanism.mass(c).v);
  });
}

// Accelerations and multipliers with their derivatives at y; the factors belong to its values.
bool MotionDerivatives::derivative(Group& group, double t, Side side, const DesignVector& y, DesignVector& slope) {
  const std::span<const DesignScalar> q = std::span(y).first(n_), qd = std::span(y).subspan(n_);
  DesignMechanism& mechanism = group.mechanism;
  mechanism.set_time(t, side);
  mechanism.set_state(q, qd);
  mechanism.rows(group.rows);
  mechanism.applied_forces(group.loads);
  const std::span<double> f = loads_scratch(), b = rows_scratch();
  for (std::size_t c = 0; c < n_; ++c) f[c] = group.loads[c].v;
  for (std::size_t r = 0; r < b.size(); ++r) b[r] = -group.rows[r].dd.v;
  if (!system_.solve(f, b)) return false;
  std::fill(group.qdd.begin(), group.qdd.end(), DesignScalar());
  for (const int c : plan().coordinate) group.qdd[at(c)] = f[at(c)];
  lift(b, group.lambda);
  mechanism.set_state(q, qd, group.qdd);
  mechanism.rows(group.rows);
  for (DesignScalar& load : group.loads) load = -load;
  for (int c = 0; c < 3 * plan().moving; ++c) group.loads[at(c)] += mechanism.mass(c) * group.qdd[at(c)];
  mechanism.add_constraint_loads(group.lambda, group.loads);
  for (std::size_t p = 0; p < at(group.count); ++p) {
    for (std::size_t c = 0; c < n_; ++c) f[c] = -group.loads[c].d[p];
    for (std::size_t r = 0; r < b.size(); ++r) b[r] = -group.rows[r].dd.d[p];
    if (!system_.solve(f, b)) return false;
    for (const int c : plan().coordinate) group.qdd[at(c)].d[p] = f[at(c)];
    for (std::size_t r = 0; r < b.size(); ++r) group.lambda[r].d[p] = b[r];
  }
  std::copy(qd.begin(), qd.end(), slope.begin());
  std::copy(group.qdd.begin(), group.qdd.end(), slope.begin() + static_cast<std::ptrdiff_t>(n_));
  return true;
}

bool MotionDerivatives::project(Group& group, double t, Side side, DesignVector& y) {
  const std::span<DesignScalar> q = std::span(y).first(n_), qd = std::span(y).subspan(n_);
  DesignMechanism& mechanism = group.mechanism;
  mechanism.set_time(t, side);
  const std::span<double> f = loads_scratch(), b = rows_scratch();
  DesignVector bare(n_);  // the part of the state whose derivatives are sought, without them
  for (const bool velocity : {false, true}) {
    const std::span<DesignScalar> part = velocity ? qd : q;
    for (std::size_t c = 0; c < n_; ++c) bare[c] = part[c].v;
    if (!velocity) {
      for (std::size_t c = 0; c < n_; ++c) {
        if (c >= plan().column.size() || plan().column[c] < 0) bare[c] = q[c];
      }
    }
    if (velocity)
      mechanism.set_state(q, bare);
    else
      mechanism.set_state(bare);
    mechanism.rows(group.rows);
    for (std::size_t p = 0; p < at(group.count); ++p) {
      for (std::size_t c = 0; c < n_; ++c)
        f[c] = c < at(3 * plan().moving) ? mechanism.mass(static_cast<int>(c)).v * part[c].d[p] : 0;
      for (std::size_t r = 0; r < b.size(); ++r) b[r] = -(velocity ? group.rows[r].d : group.rows[r].f).d[p];
      if (!system_.solve(f, b)) return false;
      for (const int c : plan().coordinate) part[at(c)].d[p] = f[at(c)];
    }
  }
  return true;
}

bool MotionDerivatives::start(double t, std::span<const double> q, std::span<const double> qd) {
  started_ = true;
  from_ = to_ = t;
  evaluator().set_time(t);
  StartDerivatives start(evaluator(), given_start_);
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    Group& group = groups()[k];
    group.mechanism.lift_configuration(q, std::span(tracks_[k].end).first(n_));
    for (std::size_t c = 0; c < n_; ++c) tracks_[k].end[n_ + c] = qd[c];
    if (!start.find(group.mechanism, group.count, std::span(tracks_[k].end).first(n_),
                    std::span(tracks_[k].end).subspan(n_)))
      return fail("the start of the motion has no derivative: " + start.why());
  }
  if (!start.lack().empty()) lack_derivatives(start.lack());
  const MovingInstant& instant = instant_at(t);
  if (!instant.moves()) return true;
  lack_derivatives(
      fmt::format("the motion begins at t = {:.9g} s, where a function of time jumps at an instant that moves with the "
                  "parameters: earlier or later are different motions",
                  t));
  for (std::size_t p = 0; p < instant.rate.size(); ++p) {
    if (instant.rate[p] == 0) continue;
    for (DesignScalar& y : tracks_[p / parameters_at_once].end)
      y.d[p % parameters_at_once] = std::numeric_limits<double>::quiet_NaN();
  }
  return true;
}

// All stages of a step from `begin`, and `end` by the step's own formula, with derivatives.
bool MotionDerivatives::make_step(double h) {
  const Tableau& table = dormand_prince_8();
  for (int s = 0; s < table.stages; ++s) {
    // Values of the stage are the same in all groups: one factorization serves them all.
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      Track& track = tracks_[k];
      combine_stages(table.a[at(s)], h, track.begin, track.stage, stage_);
      const bool at_end = table.c[at(s)] == 1;
      const double t = at_end ? to_ : from_ + table.c[at(s)] * h;
      const Side side = at_end ? Side::before : Side::after;
      if (k == 0 && !factorize(t, side, std::span(stage_).first(n_))) return singular(t);
      if (!derivative(groups()[k], t, side, stage_, track.stage[at(s)])) return singular(t);
    }
  }
  for (Track& track : tracks_) combine_stages(table.b, h, track.begin, track.stage, track.end);
  std::string trouble = switches_.trouble_in(from_, to_, tracks_.front().stage);
  return trouble.empty() || fail(std::move(trouble));
}

// Values are the motion's own: angles may have been moved by whole turns.
void MotionDerivatives::take_values(const RecomputedSteps::Vector& values, DesignVector Track::*y) {
  for (Track& track : tracks_) {
    for (std::size_t i = 0; i < values.size(); ++i) (track.*y)[i].v = values[i];
  }
}

bool MotionDerivatives::project_end(double t, Side side) {
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    Track& track = tracks_[k];
    if (k == 0 && !factorize(t, side, std::span(track.end).first(n_))) return singular(t);
    if (!project(groups()[k], t, side, track.end)) return singular(t);
  }
  return true;
}

// Once derivatives are lost they stay lost: why() says it, and find() fails. Steps wait until someone asks, or until
// there are as many as may be taken as one; not across an instant at which functions of time jump.
void MotionDerivatives::cover(const MotionStretch& stretch) {
  if (!why().empty()) return;
  if (!between_.empty()) go_to_part(stretch.from);
  between_.clear();
  double looked_at = 0;
  std::optional<Step> step = RecomputedSteps::step_of(stretch, goes_on_ ? &last_end_ : nullptr, looked_at);
  if (!step) {
    not_shown(looked_at);
    return;
  }
  last_end_ = step->end;
  const std::span<const double> y(step->begin);
  const bool tried_elsewhere = std::exchange(started_by_trial_, false) && step->from != to_;
  if ((!started_ || tried_elsewhere) && !start(step->from, y.first(n_), y.subspan(n_))) return;
  // Tangents have no laws of state.
  const Switches switches = !tangents_ && switches_.any() ? switches_.find(stretch) : Switches{};
  take_parts(switches.empty() ? std::vector<double>{} : SwitchInstants::part_ends(switches, stretch.to));
  if (!switches.empty()) {
    if (!take_between(stretch, *step, switches)) return;
  } else if (!take_watched(*step)) {
    pending_.push_back(*std::move(step));
  }
  const MovingInstant& instant = instant_at(stretch.to);
  goes_on_ = instant.order == 0 && stretch.ended_by < 0;
  if (instant.order == 1 || instant.moves()) {
    if (catch_up(stretch.to) && factorize(stretch.to, Side::before, std::span(tracks_.front().end).first(n_)))
      cross();
    else if (why().empty())
      singular(stretch.to);
  } else if (!pending_.empty() && (!tangents_ || pending_.size() >= RecomputedSteps::most_at_once)) {
    take_block(pending_);
  }
}

bool MotionDerivatives::cross() {
  crossed_ = to_;
  const std::vector<double> rate = instant_at(to_).rate;
  std::size_t first = 0;
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    Group& group = groups()[k];
    const auto count = static_cast<std::size_t>(group.count);
    if (!cross(group, tracks_[k], std::span(rate).subspan(first, count))) return singular(to_);
    first += count;
  }
  return true;
}

// The factors are those of the step's end: neither Phi_q nor the masses change.
bool MotionDerivatives::cross(Group& group, Track& track, std::span<const double> rate) {
  DesignMechanism& mechanism = group.mechanism;
  const std::span<double> f = loads_scratch(), b = rows_scratch();
  track.before = track.end;
  track.after = track.before;
  const std::span<const DesignScalar> q_before = std::span(track.before).first(n_);
  const std::span<const DesignScalar> qd_before = std::span(track.before).subspan(n_);
  const std::span<DesignScalar> q = std::span(track.after).first(n_), qd = std::span(track.after).subspan(n_);
  if (!derivative(group, to_, Side::before, track.before, stage_)) return false;
  std::vector<double> jump_of_acceleration(n_);
  for (std::size_t c = 0; c < n_; ++c) jump_of_acceleration[c] = stage_[n_ + c].v;
  // Velocities after, and the blow that makes them.
  mechanism.set_time(to_, Side::after);
  mechanism.set_state(q_before);
  mechanism.rows(group.rows);
  for (std::size_t c = 0; c < n_; ++c)
    f[c] = c < at(3 * plan().moving) ? mechanism.mass(static_cast<int>(c)).v * qd_before[c].v : 0;
  for (std::size_t r = 0; r < b.size(); ++r) b[r] = -group.rows[r].d.v;
  if (!system_.solve(f, b)) return false;
  for (const int c : plan().coordinate) qd[at(c)] = f[at(c)];
  std::vector<DesignScalar> blow(b.begin(), b.end());
  if (!derivative(group, to_, Side::after, track.after, stage_)) return false;
  for (std::size_t c = 0; c < n_; ++c) jump_of_acceleration[c] -= stage_[n_ + c].v;
  // Along the moving instant, where the blow acts.
  DesignVector q_there(q_before.begin(), q_before.end());
  for (const int c : plan().coordinate) {
    for (std::size_t p = 0; p < rate.size(); ++p) {
      q_there[at(c)].d[p] += qd_before[at(c)].v * rate[p];
      q[at(c)].d[p] += (qd_before[at(c)].v - qd[at(c)].v) * rate[p];
    }
  }
  std::fill(group.loads.begin(), group.loads.end(), DesignScalar());
  mechanism.set_state(q_there);
  mechanism.add_constraint_loads(blow, group.loads);
  mechanism.set_state(q, qd);
  mechanism.rows(group.rows);
  for (std::size_t p = 0; p < rate.size(); ++p) {
    for (std::size_t c = 0; c < n_; ++c) {
      f[c] = -group.loads[c].d[p];
      if (c >= at(3 * plan().moving)) continue;
      const DesignScalar& m = mechanism.mass(static_cast<int>(c));
      f[c] += m.v * (qd_before[c].d[p] + jump_of_acceleration[c] * rate[p]) - m.d[p] * (qd[c].v - qd_before[c].v);
    }
    for (std::size_t r = 0; r < b.size(); ++r) b[r] = -group.rows[r].d.d[p];
    if (!system_.solve(f, b)) return false;
    for (const int c : plan().coordinate) qd[at(c)].d[p] = f[at(c)];
  }
  return true;
}

// The stages that its interpolant has beyond those of the step.
bool MotionDerivatives::prepare_interpolant(Group& group, Track& track) {
  const Tableau& table = dormand_prince_8();
  const double h = to_ - from_;
  if (!factorize(to_, Side::before, std::span(track.end).first(n_))) return singular(to_);
  if (!derivative(group, to_, Side::before, track.end, track.stage[12])) return singular(to_);
  for (std::size_t s = 13; s < 16; ++s) {
    const double t = from_ + table.c[s] * h;
    combine_stages(table.a[s], h, track.begin, track.stage, stage_);
    if (!factorize(t, Side::after, std::span(stage_).first(n_))) return singular(t);
    if (!derivative(group, t, Side::after, stage_, track.stage[s])) return singular(t);
  }
  return true;
}

bool MotionDerivatives::find(const Snapshot& snapshot) {
  if (!started_ && !start(snapshot.t, snapshot.q, snapshot.qd)) return false;
  if (!why().empty() || !catch_up(snapshot.t)) return false;
  if (!between_.empty()) go_to_part(snapshot.t);
  if (between_.empty() && (snapshot.t < from_ || snapshot.t > to_)) return not_shown(snapshot.t);
  if (tangents_ && find_by_tangents(snapshot)) return true;
  const bool inside = has_step_ && snapshot.t != to_ && snapshot.t != from_;
  if (inside && by_tangents_ && !retake_in_dual_numbers()) return false;
  if (inside && !interpolant_ready_) {
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      if (!prepare_interpolant(groups()[k], tracks_[k])) return false;
    }
    interpolant_ready_ = true;
  }
  // At a jump the motion may show velocities of either side: its own are those after it.
  const bool jumps = crossed_ == snapshot.t;
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    y_ = jumps ? tracks_[k].after : has_step_ && snapshot.t == from_ ? tracks_[k].begin : tracks_[k].end;
    if (inside) {
      const double h = to_ - from_;
      interpolate_derivatives((snapshot.t - from_) / h, h, tracks_[k].begin, tracks_[k].end, tracks_[k].stage, y_);
    }
    for (std::size_t c = 0; c < n_; ++c) {
      y_[c].v = snapshot.q[c];
      if (!jumps) y_[n_ + c].v = snapshot.qd[c];
    }
    if (k == 0 && !factorize(snapshot.t, Side::after, std::span(y_).first(n_))) return singular(snapshot.t);
    if (!project(groups()[k], snapshot.t, Side::after, y_)) return singular(snapshot.t);
    if (!take_state(groups()[k], snapshot, Side::after, y_)) return false;
  }
  return true;
}

bool MotionDerivatives::find_before(const Snapshot& snapshot) {
  if (crossed_ != snapshot.t || !why().empty()) return false;
  if (!between_.empty()) go_to_part(snapshot.t);
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    const DesignVector& y = tracks_[k].before;
    if (k == 0 && !factorize(snapshot.t, Side::before, std::span(y).first(n_))) return singular(snapshot.t);
    if (!take_state(groups()[k], snapshot, Side::before, y)) return false;
  }
  return true;
}

bool MotionDerivatives::take_state(Group& group, const Snapshot& snapshot, Side side, const DesignVector& y) {
  std::copy_n(y.begin(), n_, group.q.begin());
  std::copy_n(y.begin() + static_cast<std::ptrdiff_t>(n_), n_, group.qd.begin());
  group.mechanism.set_time(snapshot.t, side);
  if (snapshot.qdd.empty()) {
    group.mechanism.set_state(group.q, group.qd);
    return true;
  }
  if (!derivative(group, snapshot.t, side, y, stage_)) return singular(snapshot.t);
  if (!system_.dependent_rows().empty()) leave_out_reactions(group);
  return true;
}

}  // namespace catena
