// MotionDerivatives: over steps of the motion and at instants in them by tangents, several steps at a time; in parts
// where laws of state switch.
#include <algorithm>
#include <cmath>
#include <utility>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/sensitivity/motion_derivatives.hpp"
#include "catena/base/at.hpp"

namespace catena {

RecomputedSteps::Stage& MotionDerivatives::place() {
  if (!place_) place_ = again_->make_stage();
  return *place_;
}

void MotionDerivatives::to_rows(DesignVector Track::*y, MotionTangents::Rows& rows) const {
  const std::size_t width = tangents_->width();
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    const DesignVector& from = tracks_[k].*y;
    for (const int coordinate : plan().coordinate) {
      for (const std::size_t i : {at(coordinate), n_ + at(coordinate)})
        std::copy(from[i].d.begin(), from[i].d.end(),
                  rows.begin() + static_cast<std::ptrdiff_t>(i * width + k * parameters_at_once));
    }
  }
}

void MotionDerivatives::from_rows(const MotionTangents::Rows& rows, DesignVector Track::*y) {
  const std::size_t width = tangents_->width();
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    DesignVector& to = tracks_[k].*y;
    for (const int coordinate : plan().coordinate) {
      for (const std::size_t i : {at(coordinate), n_ + at(coordinate)})
        std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(i * width + k * parameters_at_once), parameters_at_once,
                    to[i].d.begin());
    }
  }
}

bool MotionDerivatives::catch_up(double t) {
  // Derivatives inside of a step that was joined with those before it: these first, then it alone.
  if (pending_.empty() && block_.size() > 1 && t > from_ && t < to_) {
    pending_ = block_;
    for (Track& track : tracks_) track.end = track.begin;
  }
  const auto alone = [&] { return !pending_.empty() && t < pending_.back().to ? 1 : 0; };
  while (why().empty() && !pending_.empty() && !(is_part(pending_.front()) && t <= to_))
    take_block(std::span<const Step>(pending_).first(std::max(pending_.size() - at(alone()), std::size_t{1})));
  if (why().empty() && t < from_ && !parts_.empty() && t >= parts_.front().step.from) return_to_part(t);
  return why().empty();
}

void MotionDerivatives::begin_block(double from, const RecomputedSteps::Vector& y) {
  const auto begin = crossed_ == from ? &Track::after : &Track::end;
  take_values(y, begin);
  for (Track& track : tracks_) track.begin = track.*begin;
}

void MotionDerivatives::end_block() {
  for (Track& track : tracks_) track.end = track.begin;
  take_values(step_.end, &Track::end);
  from_rows(rows_.end, &Track::end);
}

bool MotionDerivatives::take_block(std::span<const Step> steps) {
  if (is_part(steps.front())) {
    const Step part = steps.front();
    pending_.erase(pending_.begin());
    return take_part(part);
  }
  parts_.clear();
  const double known = steps.front().to == watched_.too_long_to ? watched_.excess : 0;
  std::size_t count = 1;
  const double missed = known > 1 ? known : take_joined(steps, count);
  if (!why().empty()) return false;
  if (missed > 1) {
    undo_step();
    const Step step = steps.front();
    pending_.erase(pending_.begin());
    return take_in_parts(step, missed);
  }
  note_block(steps.first(count));
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(count));
  return true;
}

double MotionDerivatives::take_joined(std::span<const Step> steps, std::size_t& count) {
  double missed = 0;
  for (;;) {
    begin_block(steps.front().from, steps.front().begin);
    count = tangents_ ? again_->join(steps, RecomputedSteps::From::front, step_) : 0;
    watched_.recomputed = true;
    by_tangents_ = count > 0 && take_by_tangents();
    missed = by_tangents_ ? excess() : 0;
    if (count <= 1 || missed <= 1) break;
    again_->join_less((step_.to - step_.from) / parts_for(missed));
    undo_step();
  }
  if (by_tangents_) return missed;
  count = 1;
  step_ = steps.front();
  return take_in_dual_numbers() ? excess() : 0;
}

// step_ has been taken: it is made of these.
void MotionDerivatives::note_block(std::span<const Step> steps) {
  from_ = step_.from;
  to_ = step_.to;
  has_step_ = true;
  interpolant_ready_ = false;
  ++blocks_;
  block_.assign(steps.begin(), steps.end());
}

bool MotionDerivatives::take_by_tangents() {
  to_rows(&Track::begin, rows_.begin);
  tangents_->step(*again_, step_.to - step_.from, rows_.begin, rows_.end);
  place().y = step_.end;
  watched_.place_serves = false;
  if (!tangents_->project(place(), step_.to, Side::before, rows_.end)) return false;
  end_block();
  return true;
}

// Steps that were not watched come first. The motion's state is that which was shown, but for whole turns. Before the
// first one nothing may have been shown.
bool MotionDerivatives::begin_stages(double from, double to, std::span<const double> y) {
  watched_.stages = 0;
  if (!started_ && why().empty() && start(from, y.first(n_), y.subspan(n_, n_))) started_by_trial_ = true;
  if (!started_ || !why().empty() || (!pending_.empty() && !catch_up(from)) || to_ != from) return false;
  if (!(watched_.begun && watched_.from == from) && !begin_watched(from, y.subspan(n_, n_))) return false;
  watched_.from = from;
  watched_.to = to;
  watched_.stages = 1;
  return true;
}

bool MotionDerivatives::begin_watched(double from, std::span<const double> rates) {
  const auto begin = crossed_ == from ? &Track::after : &Track::end;
  const DesignVector& y = tracks_.front().*begin;
  for (std::size_t c = 0; c < n_; ++c) {
    if (std::abs(rates[c] - y[n_ + c].v) > thresholds::same_value * std::max(1.0, std::abs(rates[c]))) return false;
  }
  if (!watched_.place_serves || !goes_on_) {
    for (std::size_t i = 0; i < 2 * n_; ++i) place().y[i] = y[i].v;
    if (!RecomputedSteps::evaluate(place(), from, Side::after)) return false;
  }
  // What is known of the last block is overwritten: nothing inside of it can be asked for any more.
  parts_.clear();
  from_ = to_;
  has_step_ = false;
  to_rows(begin, rows_.begin);
  tangents_->step_stage(0, MotionTangents::place_of(place()), 0, rows_.begin);
  watched_.begun = true;
  return true;
}

void MotionDerivatives::watch_stage(int s, double t, Side side, std::span<const double> y,
                                    std::span<const double> slope, EquationsOfMotion& equations) {
  if (watched_.stages != s) return;
  watched_.stages = equations.is_dependent() ? 0 : s + 1;
  if (watched_.stages == 0) return;
  const MotionTangents::Place place{.t = t,
                                    .side = side,
                                    .evaluator = equations.evaluator(),
                                    .equations = equations,
                                    .qd = y.subspan(n_, n_),
                                    .qdd = slope.subspan(n_, n_),
                                    .lambda = equations.multipliers()};
  tangents_->step_stage(s, place, watched_.to - watched_.from, rows_.begin);
}

bool MotionDerivatives::take_watched(const Step& step) {
  const bool watched = std::exchange(watched_.stages, 0) == dormand_prince_8().stages && watched_.from == step.from &&
                       watched_.to == step.to;
  watched_.begun = false;
  watched_.excess = 0;
  if (!watched) return false;
  begin_block(step.from, step.begin);
  step_ = step;
  tangents_->finish_step(step.to - step.from, rows_.begin, rows_.end);
  by_tangents_ = true;
  watched_.place_serves = false;
  if (watched_.excess = excess(); watched_.excess > 1) {
    watched_.too_long_to = step.to;
    return false;
  }
  place().y = step.end;
  if (!RecomputedSteps::evaluate(place(), step.to, Side::before)) return false;
  tangents_->project_with_factors(place(), rows_.end);
  end_block();
  watched_.place_serves = true;
  watched_.recomputed = false;
  note_block(std::span(&step, 1));
  return true;
}

bool MotionDerivatives::take_in_dual_numbers() {
  from_ = step_.from;
  to_ = step_.to;
  if (!make_step(to_ - from_)) return false;
  if (step_.end.empty()) {
    for (const DesignScalar& y : tracks_.front().end) step_.end.push_back(y.v);
  }
  take_values(step_.end, &Track::end);
  return project_end(to_, Side::before);
}

bool MotionDerivatives::retake_in_dual_numbers() {
  by_tangents_ = false;
  interpolant_ready_ = false;
  return take_in_dual_numbers();
}

bool MotionDerivatives::find_by_tangents(const Snapshot& snapshot) {
  const double t = snapshot.t, h = to_ - from_;
  const bool jumps = crossed_ == t, inside = has_step_ && t != to_ && t != from_ && !jumps;
  if (inside && !by_tangents_) return false;
  if (inside) {
    if (!interpolant_ready_) {
      if (!watched_.recomputed && !again_->recompute(step_)) return false;
      watched_.recomputed = true;
      if (!again_->prepare_interpolant(step_)) return false;
      tangents_->prepare_interpolant(*again_, h, rows_.begin, rows_.end);
      interpolant_ready_ = true;
    }
    tangents_->interpolate((t - from_) / h, h, rows_.begin, rows_.end, rows_.now);
  } else {
    to_rows(jumps ? &Track::after : has_step_ && t == from_ ? &Track::begin : &Track::end, rows_.now);
  }
  RecomputedSteps::Stage& there = place();
  watched_.place_serves = false;
  std::copy(snapshot.q.begin(), snapshot.q.end(), there.y.begin());
  for (std::size_t c = 0; c < n_; ++c) there.y[n_ + c] = jumps ? tracks_.front().after[n_ + c].v : snapshot.qd[c];
  if (!tangents_->project(there, t, Side::after, rows_.now)) return false;
  const bool accelerates = !snapshot.qdd.empty();
  if (accelerates) {
    if (!RecomputedSteps::evaluate(there, t, Side::after)) return false;
    tangents_->accelerations(MotionTangents::place_of(there), rows_.now, rows_.accelerations);
  }
  const std::size_t width = tangents_->width();
  for (std::size_t k = 0; k < tracks_.size(); ++k) {
    Group& group = groups()[k];
    const auto take = [&](const MotionTangents::Rows& rows, std::size_t row, DesignScalar& x) {
      std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(row * width + k * parameters_at_once), parameters_at_once,
                  x.d.begin());
    };
    group.mechanism.set_time(t, Side::after);
    group.mechanism.lift_configuration(snapshot.q, group.q);
    std::fill(group.qdd.begin(), group.qdd.end(), DesignScalar());
    for (std::size_t c = 0; c < n_; ++c) group.qd[c] = there.y[n_ + c];
    for (const int coordinate : plan().coordinate) {
      const std::size_t c = at(coordinate);
      take(rows_.now, c, group.q[c]);
      take(rows_.now, n_ + c, group.qd[c]);
      if (!accelerates) continue;
      group.qdd[c] = there.slope[n_ + c];
      take(rows_.accelerations, c, group.qdd[c]);
    }
    for (std::size_t r = 0; accelerates && r < group.lambda.size(); ++r) {
      group.lambda[r] = there.lambda[r];
      take(tangents_->multipliers(), r, group.lambda[r]);
    }
    group.mechanism.set_state(group.q, group.qd);
  }
  return true;
}

bool MotionDerivatives::take_between(const MotionStretch& stretch, const Step& whole, const Switches& switches) {
  if (!catch_up(whole.from)) return false;
  // Functions of time may have jumped where the step begins.
  if (crossed_ == whole.from) {
    for (Track& track : tracks_) track.end = track.after;
  }
  take_values(whole.begin, &Track::end);
  has_step_ = false;
  parts_.clear();
  double from = whole.from;
  const auto take = [&](double to) {
    keep_part();
    Step part{from, to, {}, to == whole.to ? whole.end : RecomputedSteps::Vector{}};
    for (const DesignScalar& y : tracks_.front().end) part.begin.push_back(y.v);
    if (!take_part(part)) return false;
    from = to;
    return true;
  };
  const auto rate = [](const MotionStretch& some, const auto& f) { return rate_at_end(some, f); };
  SwitchInstants::Carrier carrier{evaluator(), {}, {}, take, [this] { keep_part(); }, rate};
  for (std::size_t k = 0; k < tracks_.size(); ++k)
    carrier.groups.push_back({groups()[k].mechanism, tracks_[k].end, DesignVector(2 * n_), at(groups()[k].count)});
  carrier.find_slopes = [&](double t) {
    const Side side = t == whole.to ? Side::before : Side::after;
    if (!factorize(t, side, std::span(tracks_.front().end).first(n_))) return singular(t);
    for (std::size_t k = 0; k < tracks_.size(); ++k) {
      if (!derivative(groups()[k], t, side, tracks_[k].end, carrier.groups[k].slope)) return singular(t);
    }
    return true;
  };
  for (const SwitchInstants::Switch& one : switches) {
    std::string trouble;
    const std::optional<double> behind = switches_.pass(one, stretch, from, carrier, trouble);
    if (!behind) return fail(std::move(trouble));
    from = from_ = to_ = *behind;
    has_step_ = interpolant_ready_ = false;
  }
  return from == whole.to || take(whole.to);
}

void MotionDerivatives::keep_part() {
  if (has_step_) between_.push_back({from_, to_, has_step_, interpolant_ready_, tracks_});
}

void MotionDerivatives::go_to_part(double t) {
  const auto distance = [t](double from, double to) { return std::max({from - t, t - to, 0.0}); };
  const auto nearest = std::min_element(between_.begin(), between_.end(), [&](const Between& a, const Between& b) {
    return distance(a.from, a.to) < distance(b.from, b.to);
  });
  if (nearest == between_.end() || distance(from_, to_) <= distance(nearest->from, nearest->to)) return;
  std::swap(from_, nearest->from);
  std::swap(to_, nearest->to);
  std::swap(has_step_, nearest->step);
  std::swap(interpolant_ready_, nearest->interpolant);
  std::swap(tracks_, nearest->tracks);
}

}  // namespace catena
