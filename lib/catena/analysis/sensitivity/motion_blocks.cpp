// MotionDerivatives: over steps of the motion and at instants in them by tangents, several steps at a time.
#include <algorithm>

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
  while (why().empty() && pending_.size() > at(alone()))
    take_block(std::span<const Step>(pending_).first(pending_.size() - at(alone())));
  if (why().empty() && !pending_.empty()) take_block(pending_);
  return why().empty();
}

bool MotionDerivatives::take_block(std::span<const Step> steps) {
  const auto begin = crossed_ == steps.front().from ? &Track::after : &Track::end;
  take_values(steps.front().begin, begin);
  for (Track& track : tracks_) track.begin = track.*begin;
  std::size_t count = tangents_ ? again_->join(steps, RecomputedSteps::From::front, step_) : 0;
  by_tangents_ = count > 0 && take_by_tangents();
  if (!by_tangents_) {
    count = 1;
    step_ = steps.front();
    if (!take_in_dual_numbers()) return false;
  }
  from_ = step_.from;
  to_ = step_.to;
  has_step_ = true;
  interpolant_ready_ = false;
  ++blocks_;
  block_.assign(steps.begin(), steps.begin() + static_cast<std::ptrdiff_t>(count));
  pending_.erase(pending_.begin(), pending_.begin() + static_cast<std::ptrdiff_t>(count));
  return true;
}

bool MotionDerivatives::take_by_tangents() {
  to_rows(&Track::begin, rows_.begin);
  tangents_->step(*again_, step_.to - step_.from, rows_.begin, rows_.end);
  place().y = step_.end;
  if (!tangents_->project(place(), step_.to, Side::before, rows_.end)) return false;
  for (Track& track : tracks_) track.end = track.begin;
  take_values(step_.end, &Track::end);
  from_rows(rows_.end, &Track::end);
  return true;
}

bool MotionDerivatives::take_in_dual_numbers() {
  from_ = step_.from;
  to_ = step_.to;
  if (!make_step(to_ - from_)) return false;
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
      if (!again_->prepare_interpolant(step_)) return false;
      tangents_->prepare_interpolant(*again_, h, rows_.begin, rows_.end);
      interpolant_ready_ = true;
    }
    tangents_->interpolate((t - from_) / h, h, rows_.begin, rows_.end, rows_.now);
  } else {
    to_rows(jumps ? &Track::after : has_step_ && t == from_ ? &Track::begin : &Track::end, rows_.now);
  }
  RecomputedSteps::Stage& there = place();
  std::copy(snapshot.q.begin(), snapshot.q.end(), there.y.begin());
  for (std::size_t c = 0; c < n_; ++c) there.y[n_ + c] = jumps ? tracks_.front().after[n_ + c].v : snapshot.qd[c];
  if (!tangents_->project(there, t, Side::after, rows_.now)) return false;
  const bool accelerates = !snapshot.qdd.empty();
  if (accelerates) {
    if (!RecomputedSteps::evaluate(there, t, Side::after)) return false;
    tangents_->slope(there, rows_.now, rows_.slope);
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
      take(rows_.slope, n_ + c, group.qdd[c]);
    }
    for (std::size_t r = 0; accelerates && r < group.lambda.size(); ++r) {
      group.lambda[r] = there.lambda[r];
      take(tangents_->multipliers(), r, group.lambda[r]);
    }
    group.mechanism.set_state(group.q, group.qd);
  }
  return true;
}

}  // namespace catena
