#include "catena/analysis/sensitivity/motion_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

// A velocity that differs by more than this part of it from the one at the end of the step before has jumped: that a
// driver jumps; projections change less.
constexpr double a_jump = 1e-3;

}  // namespace

MotionDerivatives::MotionDerivatives(const Evaluator& evaluator, const DesignModels& models, int parameters,
                                     GivenByModel start)
    : StateDerivatives(evaluator, models, parameters),
      n_(at(plan().coordinates())),
      system_(evaluator.shared_plan(), SaddleBlock::diagonal),
      given_start_(start),
      values_(n_),
      stage_(2 * n_),
      y_(2 * n_) {
  for (std::size_t k = 0; k < groups().size(); ++k) {
    Track& track = tracks_.emplace_back();
    track.begin.resize(2 * n_);
    track.end.resize(2 * n_);
    track.stage.assign(16, Vector(2 * n_));
    track.interpolant.assign(7, Vector(2 * n_));
  }
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
  const std::span<const double> phi_q = jacobian();
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (!system_.begin(phi_q)) return false;
    for (int c = 0; c < 3 * plan().moving; ++c) system_.add_diagonal(c, groups().front().mechanism.mass(c).v);
    if (system_.factorize()) return true;
    system_.forget_rows();
  }
  return false;
}

// Accelerations and multipliers with their derivatives at y; the factors belong to its values.
bool MotionDerivatives::derivative(Group& group, double t, Side side, const Vector& y, Vector& slope) {
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

void MotionDerivatives::combine(const StageSum& sum, double h, const Vector& from, const std::vector<Vector>& stages,
                                Vector& out) const {
  out = from;
  for (const StageTerm& term : sum) {
    const DesignScalar weight(h * term.weight);
    const Vector& k = stages[at(term.stage)];
    for (std::size_t i = 0; i < out.size(); ++i) out[i] += weight * k[i];
  }
}

bool MotionDerivatives::project(Group& group, double t, Side side, Vector& y) {
  const std::span<DesignScalar> q = std::span(y).first(n_), qd = std::span(y).subspan(n_);
  DesignMechanism& mechanism = group.mechanism;
  mechanism.set_time(t, side);
  const std::span<double> f = loads_scratch(), b = rows_scratch();
  Vector bare(n_);  // the part of the state whose derivatives are sought, without them
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
  return true;
}

// All stages of a step from `begin`, and `end` by the step's own formula, with derivatives.
bool MotionDerivatives::make_step(double h) {
  const Tableau& table = dormand_prince_8();
  for (int s = 0; s < table.stages; ++s) {
    // Values of the stage are the same in all groups: one factorization serves them all.
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      Track& track = tracks_[k];
      combine(table.a[at(s)], h, track.begin, track.stage, stage_);
      const bool at_end = table.c[at(s)] == 1;
      const double t = at_end ? to_ : from_ + table.c[at(s)] * h;
      const Side side = at_end ? Side::before : Side::after;
      if (k == 0 && !factorize(t, side, std::span(stage_).first(n_))) return singular(t);
      if (!derivative(groups()[k], t, side, stage_, track.stage[at(s)])) return singular(t);
    }
  }
  for (Track& track : tracks_) combine(table.b, h, track.begin, track.stage, track.end);
  return true;
}

// Values are the motion's own: angles may have been moved by whole turns, velocities by a jump.
bool MotionDerivatives::take_values(const MotionStretch& stretch, double t, bool& jumped) {
  const std::optional<Snapshot> state = stretch.at(t);
  if (!state) return not_shown(t);
  jumped = false;
  for (Track& track : tracks_) {
    for (std::size_t c = 0; c < n_; ++c) {
      jumped = jumped || std::abs(track.end[n_ + c].v - state->qd[c]) > a_jump * std::abs(state->qd[c]);
      track.end[c].v = state->q[c];
      track.end[n_ + c].v = state->qd[c];
    }
  }
  return true;
}

bool MotionDerivatives::project_end(double t, Side side) {
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    Track& track = tracks_[k];
    if (k == 0 && !factorize(t, side, std::span(track.end).first(n_))) return singular(t);
    if (!project(groups()[k], t, side, track.end)) return singular(t);
  }
  return true;
}

// Once derivatives are lost they stay lost: why() says it, and find() fails.
void MotionDerivatives::cover(const MotionStretch& stretch) {
  if (!why().empty()) return;
  if (!started_) {
    const std::optional<Snapshot> state = stretch.at(stretch.from);
    if (!state) {
      not_shown(stretch.from);
      return;
    }
    if (!start(stretch.from, state->q, state->qd)) return;
  }
  bool jumped = false;
  if (!take_values(stretch, stretch.from, jumped)) return;
  if (jumped && !project_end(stretch.from, Side::after)) return;
  for (Track& track : tracks_) track.begin.swap(track.end);
  from_ = stretch.from;
  to_ = stretch.to;
  has_step_ = true;
  interpolant_ready_ = false;
  if (make_step(to_ - from_) && take_values(stretch, to_, jumped)) project_end(to_, Side::before);
}

// See runge_kutta_interpolant.cpp.
bool MotionDerivatives::prepare_interpolant(Group& group, Track& track) {
  const Tableau& table = dormand_prince_8();
  const double h = to_ - from_;
  if (!factorize(to_, Side::before, std::span(track.end).first(n_))) return singular(to_);
  if (!derivative(group, to_, Side::before, track.end, track.stage[12])) return singular(to_);
  for (std::size_t s = 13; s < 16; ++s) {
    const double t = from_ + table.c[s] * h;
    combine(table.a[s], h, track.begin, track.stage, stage_);
    if (!factorize(t, Side::after, std::span(stage_).first(n_))) return singular(t);
    if (!derivative(group, t, Side::after, stage_, track.stage[s])) return singular(t);
  }
  const DesignScalar length(h);
  for (std::size_t i = 0; i < 2 * n_; ++i) {
    const DesignScalar difference = track.end[i] - track.begin[i], bend = length * track.stage[0][i] - difference;
    track.interpolant[0][i] = difference;
    track.interpolant[1][i] = bend;
    track.interpolant[2][i] = difference - length * track.stage[12][i] - bend;
  }
  const Vector zero(2 * n_);
  for (std::size_t k = 0; k < 4; ++k) combine(table.interpolant[k], h, zero, track.stage, track.interpolant[3 + k]);
  return true;
}

void MotionDerivatives::interpolate(const Track& track, double t, Vector& y) const {
  const double s = (t - from_) / (to_ - from_), r = 1 - s;
  const auto& c = track.interpolant;
  for (std::size_t i = 0; i < y.size(); ++i) {
    for (std::size_t p = 0; p < static_cast<std::size_t>(parameters_at_once); ++p) {
      const auto d = [&](std::size_t k) { return c[k][i].d[p]; };
      y[i].d[p] =
          track.begin[i].d[p] + s * (d(0) + r * (d(1) + s * (d(2) + r * (d(3) + s * (d(4) + r * (d(5) + s * d(6)))))));
    }
  }
}

bool MotionDerivatives::find(const Snapshot& snapshot) {
  if (!started_ && !start(snapshot.t, snapshot.q, snapshot.qd)) return false;
  if (!why().empty()) return false;
  if (snapshot.t < from_ || snapshot.t > to_) return not_shown(snapshot.t);
  const bool inside = has_step_ && snapshot.t != to_ && snapshot.t != from_;
  if (inside && !interpolant_ready_) {
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      if (!prepare_interpolant(groups()[k], tracks_[k])) return false;
    }
    interpolant_ready_ = true;
  }
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    Group& group = groups()[k];
    y_ = has_step_ && snapshot.t == from_ ? tracks_[k].begin : tracks_[k].end;
    if (inside) interpolate(tracks_[k], snapshot.t, y_);
    for (std::size_t c = 0; c < n_; ++c) {
      y_[c].v = snapshot.q[c];
      y_[n_ + c].v = snapshot.qd[c];
    }
    if (k == 0 && !factorize(snapshot.t, Side::after, std::span(y_).first(n_))) return singular(snapshot.t);
    if (!project(group, snapshot.t, Side::after, y_)) return singular(snapshot.t);
    std::copy_n(y_.begin(), n_, group.q.begin());
    std::copy_n(y_.begin() + static_cast<std::ptrdiff_t>(n_), n_, group.qd.begin());
    if (snapshot.qdd.empty()) {
      group.mechanism.set_state(group.q, group.qd);
      continue;
    }
    if (!derivative(group, snapshot.t, Side::after, y_, stage_)) return singular(snapshot.t);
    if (!system_.dependent_rows().empty()) leave_out_reactions(group);
  }
  return true;
}

}  // namespace catena
