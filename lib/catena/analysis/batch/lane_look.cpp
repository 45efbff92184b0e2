#include "catena/analysis/batch/lane_look.hpp"

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// The quintic between rows is off by far less where the motion is smooth on the scale of its rows.
constexpr double largest_correction = 1e-2;

}  // namespace

LaneLook::LaneLook(const LaneProgram& program, Evaluator& evaluator)
    : solver_(program),
      evaluator_(evaluator),
      before_(program),
      after_(program),
      seen_(program),
      q_(catena::at(program.plan().coordinates()), 0.0),
      qd_(q_.size(), 0.0),
      qdd_(q_.size(), 0.0),
      shift_(catena::at(program.code().moving)) {}

void LaneLook::follow(const LaneMotion& motion, int lane, const Model& model, std::span<const double> instants) {
  motion_ = &motion;
  motion_lane_ = lane;
  instants_ = instants;
  is_seen_.fill(false);
  lost_ = false;
  for (int k = 0; k < lane_count; ++k) solver_.set_design(k, model, evaluator_.length_scale());
  q_ = evaluator_.given_configuration();
  const LaneCode& code = solver_.program().code();
  for (int b = 0; b < code.moving; ++b)
    shift_[catena::at(b)] = Vec2<double>{code.origin_x, code.origin_y} - evaluator_.origin(b);
  for (int k = 0; k < lane_count; ++k) gather(k, instants.front());
}

// The rows around an instant into a lane.
void LaneLook::gather(int lane, double t) {
  const auto later = std::upper_bound(instants_.begin(), instants_.end(), t);
  const auto last = static_cast<std::ptrdiff_t>(instants_.size()) - 1;
  const int k = static_cast<int>(std::clamp<std::ptrdiff_t>(later - instants_.begin() - 1, 0, last > 0 ? last - 1 : 0));
  const int next = std::min(k + 1, static_cast<int>(last));
  const auto copy = [lane, from_lane = motion_lane_](LaneNumbers& numbers, const double* from, int count) {
    double* to = numbers.data() + lane;
    from += from_lane;
    for (int n = 0; n < count; ++n, to += lane_count, from += lane_count) *to = *from;
  };
  for (auto [state, row] : {std::pair(&before_, k), std::pair(&after_, next)}) {
    state->t[catena::at(lane)] = instants_[catena::at(row)];
    copy(state->q, motion_->q(row), solver_.coordinates());
    copy(state->qd, motion_->qd(row), solver_.coordinates());
    copy(state->qdd, motion_->qdd(row), solver_.coordinates());
    copy(state->margin, motion_->margin(row), motion_->tails());
  }
  seen_.t[catena::at(lane)] = t;
}

void LaneLook::expect(std::span<const double> instants) {
  if (instants.empty()) return;
  const int count = static_cast<int>(std::min(instants.size(), catena::at(lane_count)));
  is_seen_.fill(false);
  for (int lane = 0; lane < count; ++lane) gather(lane, instants[catena::at(lane)]);
  // Lanes of the same pack that are left over hold what was seen last.
  solver_.foretell(before_, after_, seen_);
  solver_.solve(seen_, count);
  for (int lane = 0; lane < count; ++lane) {
    const double t = seen_.t[catena::at(lane)];
    bool sound = t >= instants_.front() && t <= instants_.back() && solver_.converged(lane) &&
                 solver_.first_size(lane) <= largest_correction;
    for (int k = 0; k < motion_->tails(); ++k) {
      const double there = seen_.margin[k][lane], row = before_.margin[k][lane];
      sound = sound && there * row > 0 && std::abs(there) > least_margin * std::min(1.0, std::abs(row));
    }
    is_seen_[catena::at(lane)] = sound;
  }
}

Snapshot LaneLook::show(double t, double residual) {
  evaluator_.set_time(t);
  evaluator_.set_configuration(q_);
  Snapshot snapshot{.evaluator = evaluator_, .t = t, .q = q_, .qd = qd_, .qdd = qdd_};
  snapshot.residual = residual * evaluator_.length_scale();
  return snapshot;
}

Snapshot LaneLook::row(std::size_t k) {
  const int number = static_cast<int>(k);
  for (int n = 0; n < solver_.coordinates(); ++n) {
    const int place = lane_count * n + motion_lane_;
    const Vec2<double>& shift = shift_[catena::at(n / 3)];
    q_[catena::at(n)] = motion_->q(number)[place] + (n % 3 == 0 ? shift.x : n % 3 == 1 ? shift.y : 0);
    qd_[catena::at(n)] = motion_->qd(number)[place];
    qdd_[catena::at(n)] = motion_->qdd(number)[place];
  }
  return show(instants_[k], 0);
}

std::optional<Snapshot> LaneLook::at(double t) {
  const auto found = std::lower_bound(instants_.begin(), instants_.end(), t);
  if (found != instants_.end() && *found == t) return row(static_cast<std::size_t>(found - instants_.begin()));
  for (int attempt = 0; attempt < 2; ++attempt) {
    for (int lane = 0; lane < lane_count; ++lane) {
      if (!is_seen_[catena::at(lane)] || seen_.t[catena::at(lane)] != t) continue;
      for (int n = 0; n < solver_.coordinates(); ++n) {
        const Vec2<double>& shift = shift_[catena::at(n / 3)];
        q_[catena::at(n)] = seen_.q[n][lane] + (n % 3 == 0 ? shift.x : n % 3 == 1 ? shift.y : 0);
        qd_[catena::at(n)] = seen_.qd[n][lane];
        qdd_[catena::at(n)] = seen_.qdd[n][lane];
      }
      return show(t, solver_.residual(lane));
    }
    if (attempt == 0) expect(std::span(&t, 1));
  }
  lost_ = true;
  return {};
}

}  // namespace catena
