#include "catena/analysis/batch/lane_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "catena/analysis/kinematics/course/step_rules.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr LaneSolver::Rules rules{.largest_turn = step_rules::largest_turn,
                                  .largest_contraction = step_rules::largest_contraction,
                                  .longest_step = step_rules::longest_step,
                                  .sudden_part = step_rules::sudden_part};
// Kinematics looks at a singular position where a determinant has fallen to 0.6 of its value within a step however
// short. Halved so often, a step over which that happens is so near to one that lanes leave it to Kinematics.
constexpr int most_halvings = 10;

}  // namespace

LaneMotion::LaneMotion(const LaneProgram& program)
    : solver_(program),
      coordinates_(solver_.coordinates()),
      tails_(program.code().tails),
      multipliers_(program.has_loads() ? program.code().rows : 0),
      largest_margin_(tails_) {
  for (int k = 0; k < 3; ++k) own_.emplace_back(program);
  use_own_states();
}

void LaneMotion::use_own_states() {
  before_ = &own_[0];
  now_ = &own_[1];
  next_ = &own_[2];
}

// One that holds nothing: neither where lanes are, nor where they were, nor where they go.
LaneState* LaneMotion::free_state() {
  const auto used = [&](const LaneState& state) { return &state == before_ || &state == now_ || &state == next_; };
  return &*std::find_if_not(own_.begin(), own_.end(), used);
}

// A row is not written to once it is complete.
void LaneMotion::make_own(LaneState*& state) {
  if (is_own(state)) return;
  LaneState* const copy = free_state();
  copy->copy(*state);
  state = copy;
}

bool LaneMotion::set_design(int lane, const Model& model, double length_scale) {
  bool finite = solver_.set_design(lane, model, length_scale);
  // Lengths of curves belong to the design.
  if (!solver_.searches().empty()) {
    while (jumps_.size() <= at(lane)) jumps_.emplace_back(model);
    jumps_[at(lane)] = ContactJumps(model);
  }
  for (int b = 0; b < coordinates_ / 3; ++b) {
    const Frame<double> pose = solver_.program().given_pose(model, b);
    now_->q[3 * b][lane] = pose.x;
    now_->q[3 * b + 1][lane] = pose.y;
    now_->q[3 * b + 2][lane] = pose.phi;
    finite = finite && std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.phi);
  }
  solver_.searches().keep_places(lane, now_->places);
  return finite;
}

void LaneMotion::set_start(int lane, std::span<const double> q, std::span<const CurvePlace> places) {
  for (int k = 0; k < coordinates_; ++k) now_->q[k][lane] = q[at(k)];
  solver_.searches().take_places(places, lane, now_->places);
  solver_.start_anew(lane);
}

unsigned LaneMotion::assemble(const std::array<double, lane_count>& t) {
  now_->t = next_->t = t;
  next_->q.copy(now_->q);
  next_->places.copy(now_->places);
  solver_.solve(*next_);
  unsigned near = 0;
  for (int lane = 0; lane < lane_count; ++lane) {
    const bool is_near = solver_.converged(lane) && solver_.first_size(lane) <= step_rules::nearby &&
                         solver_.contraction(lane) <= step_rules::largest_contraction;
    if (is_near) near |= 1U << lane;
  }
  return near;
}

void LaneMotion::begin(unsigned lanes, int rows) {
  alive_ = lanes;
  for (std::string& why : why_) why.clear();
  std::swap(now_, next_);  // where assemble() left them
  has_before_.fill(false);
  for (ContactJumps& jumps : jumps_) jumps.forget();
  before_->t = now_->t;  // nothing is foretold from before
  largest_margin_.copy(now_->margin);
  for (int k = 0; k < tails_; ++k)
    for (int lane = 0; lane < lane_count; ++lane) largest_margin_[k][lane] = std::abs(largest_margin_[k][lane]);
  watch_margins();
  while (static_cast<int>(rows_.size()) < rows) rows_.emplace_back(solver_.program());
}

void LaneMotion::leave(unsigned lanes, const char* why) {
  for (int lane = 0; lane < lane_count; ++lane) {
    if (!(lanes & alive_ & 1U << lane)) continue;
    why_[at(lane)] = fmt::format("{} at t = {:.9g} s", why, now_->t[at(lane)]);
  }
  alive_ &= ~lanes;
}

void LaneMotion::watch_margins() {
  const unsigned near = solver_.watch(*now_, least_margin, largest_margin_);
  if (near != 0) leave(near, "it comes near to a singular position");
}

void LaneMotion::move_to(const std::array<double, lane_count>& t) {
  unsigned moving = 0;
  for (int lane = 0; lane < lane_count; ++lane) moving |= (t[at(lane)] != now_->t[at(lane)] ? 1U : 0U) << lane;
  if ((moving & alive_) == 0) return;
  next_ = row_;
  advance(moving & alive_, t, 0);
}

void LaneMotion::advance(unsigned lanes, const std::array<double, lane_count>& t, int depth) {
  const unsigned made = attempt(lanes, t);
  take(made);
  watch_margins();
  const unsigned left = lanes & ~made & alive_;
  if (left == 0) return;
  if (depth == most_halvings) {
    for (int lane = 0; lane < lane_count; ++lane) {
      const char* const trouble = solver_.trouble(lane);
      if (left & 1U << lane) leave(1U << lane, trouble ? trouble : "no step can be made any more");
    }
    return;
  }
  std::array<double, lane_count> half = now_->t;
  for (int lane = 0; lane < lane_count; ++lane) half[at(lane)] += (t[at(lane)] - half[at(lane)]) / 2;
  advance(left, half, depth + 1);
  if ((left & alive_) != 0) advance(left & alive_, t, depth + 1);
}

// One step of these lanes, from where they are by the motion so far; from a single instant by its rates. Returns those
// whose step is sound. `next_` holds the ends; lanes that do not move keep their place.
unsigned LaneMotion::attempt(unsigned lanes, const std::array<double, lane_count>& t) {
  for (int lane = 0; lane < lane_count; ++lane)
    next_->t[at(lane)] = lanes & 1U << lane ? t[at(lane)] : now_->t[at(lane)];
  const unsigned hopeful = lanes & ~solver_.foretell(*before_, *now_, step_rules::remaining_part, *next_);
  if (hopeful == 0) return 0;
  for (int lane = 0; lane < lane_count; ++lane) {
    if (has_before_[at(lane)]) continue;
    const double s = next_->t[at(lane)] - now_->t[at(lane)];
    for (int k = 0; k < coordinates_; ++k)
      next_->q[k][lane] = now_->q[k][lane] + s * (now_->qd[k][lane] + s / 2 * now_->qdd[k][lane]);
  }
  next_->places.copy(now_->places);
  solver_.solve(*next_);
  return steady_contacts(hopeful & solver_.judge(*now_, *next_, rules));
}

// Those of these lanes whose places of contact go the way that the step before foretells: of a jump they do not,
// however short the step is, and the lane leaves the group. Nothing foretells the first step, which is short.
unsigned LaneMotion::steady_contacts(unsigned lanes) {
  if (solver_.searches().empty()) return lanes;
  unsigned steady = lanes;
  for (int lane = 0; lane < lane_count; ++lane) {
    if (!(lanes & 1U << lane)) continue;
    solver_.searches().show_places(now_->places, lane, places_);
    solver_.searches().show_places(next_->places, lane, nexts_);
    if (jumps_[at(lane)].may_jump(places_, nexts_, next_->t[at(lane)] - now_->t[at(lane)])) steady &= ~(1U << lane);
  }
  return steady;
}

// The ends of their steps are where these lanes are now.
void LaneMotion::take(unsigned lanes) {
  if (lanes == 0) return;
  for (int lane = 0; lane < lane_count && !solver_.searches().empty(); ++lane) {
    if (!(lanes & 1U << lane)) continue;
    solver_.searches().show_places(now_->places, lane, places_);
    solver_.searches().show_places(next_->places, lane, nexts_);
    jumps_[at(lane)].accept(places_, nexts_, next_->t[at(lane)] - now_->t[at(lane)]);
  }
  if (lanes == alive_) {
    before_ = std::exchange(now_, next_);
    next_ = free_state();
    has_before_.fill(true);
    return;
  }
  make_own(before_);
  make_own(now_);
  for (int lane = 0; lane < lane_count; ++lane) {
    if (!(lanes & 1U << lane)) continue;
    before_->take_lane(lane, *now_);
    now_->take_lane(lane, *next_);
    has_before_[at(lane)] = true;
  }
}

void LaneMotion::clear_rows(int lane, int rows) {
  for (int row = 0; row < rows; ++row) {
    LaneState& kept = rows_[at(row)];
    for (LaneNumbers* numbers : {&kept.q, &kept.qd, &kept.qdd}) {
      for (int k = 0; k < coordinates_; ++k) (*numbers)[k][lane] = std::numeric_limits<double>::quiet_NaN();
    }
    for (int k = 0; k < multipliers_; ++k) kept.lambda[k][lane] = std::numeric_limits<double>::quiet_NaN();
  }
}

void LaneMotion::put_row(int row, int lane, std::span<const double> q, std::span<const double> qd,
                         std::span<const double> qdd, std::span<const double> lambda) {
  LaneState& kept = rows_[at(row)];
  for (int k = 0; k < coordinates_; ++k) {
    kept.q[k][lane] = q[at(k)];
    if (!qd.empty()) kept.qd[k][lane] = qd[at(k)];
    if (!qdd.empty()) kept.qdd[k][lane] = qdd[at(k)];
  }
  for (int k = 0; k < multipliers_ && !lambda.empty(); ++k) kept.lambda[k][lane] = lambda[at(k)];
}

void LaneMotion::keep_row() {
  if (now_ == row_) return;
  if (before_ == row_) make_own(before_);
  row_->copy(*now_);
}

}  // namespace catena
