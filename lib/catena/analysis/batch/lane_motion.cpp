#include "catena/analysis/batch/lane_motion.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// The rules of Kinematics: kinematics.cpp for the first two, kinematics_march.cpp for the others.
constexpr double nearby = 0.1, nearby_contraction = 0.25;
constexpr double largest_turn = 0.1, largest_contraction = 0.25, longest_step = 0.5;
constexpr double sudden_part = 0.6, remaining_part = 0.3;
// Kinematics looks at a singular position where a determinant has fallen to 0.6 of its value within a step however
// short. Halved so often, a step over which that happens is so near to one that lanes leave it to Kinematics.
constexpr int most_halvings = 10;

}  // namespace

LaneMotion::LaneMotion(const LaneProgram& program)
    : solver_(program),
      coordinates_(solver_.coordinates()),
      tails_(program.code().tails),
      multipliers_(program.has_loads() ? program.code().rows : 0),
      largest_margin_(tails_),
      before_(program),
      now_(program),
      next_(program) {}

bool LaneMotion::set_design(int lane, const Model& model, double length_scale) {
  bool finite = solver_.set_design(lane, model, length_scale);
  for (int b = 0; b < coordinates_ / 3; ++b) {
    const Frame<double> pose = solver_.program().given_pose(model, b);
    now_.q[3 * b][lane] = pose.x;
    now_.q[3 * b + 1][lane] = pose.y;
    now_.q[3 * b + 2][lane] = pose.phi;
    finite = finite && std::isfinite(pose.x) && std::isfinite(pose.y) && std::isfinite(pose.phi);
  }
  return finite;
}

void LaneMotion::set_start(int lane, std::span<const double> q) {
  for (int k = 0; k < coordinates_; ++k) now_.q[k][lane] = q[at(k)];
}

unsigned LaneMotion::assemble(const std::array<double, lane_count>& t) {
  now_.t = next_.t = t;
  next_.q.copy(now_.q);
  solver_.solve(next_);
  unsigned near = 0;
  for (int lane = 0; lane < lane_count; ++lane) {
    const bool is_near = solver_.converged(lane) && solver_.first_size(lane) <= nearby &&
                         solver_.contraction(lane) <= nearby_contraction;
    if (is_near) near |= 1U << lane;
  }
  return near;
}

void LaneMotion::begin(unsigned lanes, int rows) {
  alive_ = lanes;
  for (std::string& why : why_) why.clear();
  std::swap(now_, next_);  // where assemble() left them
  has_before_.fill(false);
  largest_margin_.copy(now_.margin);
  for (int k = 0; k < tails_; ++k)
    for (int lane = 0; lane < lane_count; ++lane) largest_margin_[k][lane] = std::abs(largest_margin_[k][lane]);
  watch_margins();
  if (rows <= kept_rows_) return;
  kept_rows_ = rows;
  for (LaneNumbers* kept : {&rows_q_, &rows_qd_, &rows_qdd_}) *kept = LaneNumbers(rows * coordinates_);
  rows_turned_ = LaneNumbers(rows * 2 * (coordinates_ / 3));
  rows_margin_ = LaneNumbers(rows * tails_);
  rows_lambda_ = LaneNumbers(rows * multipliers_);
}

void LaneMotion::leave(unsigned lanes, const char* why) {
  for (int lane = 0; lane < lane_count; ++lane) {
    if (!(lanes & alive_ & 1U << lane)) continue;
    why_[at(lane)] = fmt::format("{} at t = {:.9g} s", why, now_.t[at(lane)]);
  }
  alive_ &= ~lanes;
}

void LaneMotion::watch_margins() {
  unsigned near = 0;
  for (int k = 0; k < tails_; ++k) {
    for (int lane = 0; lane < lane_count; ++lane) {
      const double margin = std::abs(now_.margin[k][lane]);
      double& largest = largest_margin_[k][lane];
      largest = std::max(largest, margin);
      if (!(margin > least_margin * std::min(largest, 1.0))) near |= 1U << lane;
    }
  }
  leave(near, "it comes near to a singular position");
}

void LaneMotion::move_to(const std::array<double, lane_count>& t) {
  unsigned moving = 0;
  for (int lane = 0; lane < lane_count; ++lane) moving |= (t[at(lane)] != now_.t[at(lane)] ? 1U : 0U) << lane;
  if ((moving & alive_) != 0) advance(moving & alive_, t, 0);
}

void LaneMotion::advance(unsigned lanes, const std::array<double, lane_count>& t, int depth) {
  const unsigned made = attempt(lanes, t);
  take(made);
  watch_margins();
  const unsigned left = lanes & ~made & alive_;
  if (left == 0) return;
  if (depth == most_halvings) return leave(left, "no step can be made any more");
  std::array<double, lane_count> half = now_.t;
  for (int lane = 0; lane < lane_count; ++lane) half[at(lane)] += (t[at(lane)] - half[at(lane)]) / 2;
  advance(left, half, depth + 1);
  if ((left & alive_) != 0) advance(left & alive_, t, depth + 1);
}

// Lanes that do not move keep their place: the prediction for where they are is where they are. From a single instant
// by its rates.
void LaneMotion::foretell(const std::array<double, lane_count>& t) {
  next_.t = t;
  solver_.foretell(before_, now_, next_);
  for (int lane = 0; lane < lane_count; ++lane) {
    if (has_before_[at(lane)]) continue;
    const double s = t[at(lane)] - now_.t[at(lane)];
    for (int k = 0; k < coordinates_; ++k)
      next_.q[k][lane] = now_.q[k][lane] + s * (now_.qd[k][lane] + s / 2 * now_.qdd[k][lane]);
  }
}

// One step of these lanes; returns those whose step is sound. `next_` holds the ends.
unsigned LaneMotion::attempt(unsigned lanes, const std::array<double, lane_count>& t) {
  unsigned sound = 0;
  for (int lane = 0; lane < lane_count; ++lane) next_.t[at(lane)] = lanes & 1U << lane ? t[at(lane)] : now_.t[at(lane)];
  for (int lane = 0; lane < lane_count; ++lane) {
    if (lanes & 1U << lane && !heads_for_singularity(lane, next_.t[at(lane)])) sound |= 1U << lane;
  }
  if (sound == 0) return 0;
  foretell(next_.t);
  solver_.solve(next_);
  for (int lane = 0; lane < lane_count; ++lane) {
    if (sound & 1U << lane && !is_sound(lane)) sound &= ~(1U << lane);
  }
  return sound;
}

bool LaneMotion::heads_for_singularity(int lane, double t) const {
  if (!has_before_[at(lane)]) return false;
  const double part = std::abs(t - now_.t[at(lane)]) / std::abs(now_.t[at(lane)] - before_.t[at(lane)]);
  for (int k = 0; k < tails_; ++k) {
    const double here = std::abs(now_.margin[k][lane]);
    if (here + part * (here - std::abs(before_.margin[k][lane])) < remaining_part * here) return true;
  }
  return false;
}

bool LaneMotion::is_sound(int lane) const {
  if (!solver_.converged(lane) || !(solver_.first_turn(lane) <= largest_turn) ||
      !(solver_.contraction(lane) <= largest_contraction))
    return false;
  for (int k = 2; k < coordinates_; k += 3) {
    if (!(std::abs(next_.q[k][lane] - now_.q[k][lane]) <= longest_step)) return false;
  }
  for (int k = 0; k < tails_; ++k) {
    const double here = now_.margin[k][lane], there = next_.margin[k][lane];
    if (!(here * there > 0) || std::abs(there) < sudden_part * std::abs(here)) return false;
  }
  return true;
}

// The ends of their steps are where these lanes are now.
void LaneMotion::take(unsigned lanes) {
  if (lanes == 0) return;
  if (lanes == alive_) {
    std::swap(before_, now_);
    std::swap(now_, next_);
    has_before_.fill(true);
    return;
  }
  for (int lane = 0; lane < lane_count; ++lane) {
    if (!(lanes & 1U << lane)) continue;
    before_.t[at(lane)] = now_.t[at(lane)];
    now_.t[at(lane)] = next_.t[at(lane)];
    has_before_[at(lane)] = true;
    const auto move = [lane](LaneNumbers& to, const LaneNumbers& from) {
      for (std::size_t k = static_cast<std::size_t>(lane); k < to.values(); k += lane_count)
        to.data()[k] = from.data()[k];
    };
    for (LaneNumbers LaneState::*numbers :
         {&LaneState::q, &LaneState::qd, &LaneState::qdd, &LaneState::turned, &LaneState::margin, &LaneState::lambda}) {
      move(before_.*numbers, now_.*numbers);
      move(now_.*numbers, next_.*numbers);
    }
  }
}

void LaneMotion::clear_rows(int lane, int rows) {
  for (LaneNumbers* kept : {&rows_q_, &rows_qd_, &rows_qdd_}) {
    for (int k = 0; k < rows * coordinates_; ++k) (*kept)[k][lane] = std::numeric_limits<double>::quiet_NaN();
  }
  for (int k = 0; k < rows * multipliers_; ++k) rows_lambda_[k][lane] = std::numeric_limits<double>::quiet_NaN();
}

void LaneMotion::put_row(int row, int lane, std::span<const double> q, std::span<const double> qd,
                         std::span<const double> qdd, std::span<const double> lambda) {
  for (int k = 0; k < coordinates_; ++k) {
    rows_q_[row * coordinates_ + k][lane] = q[at(k)];
    if (!qd.empty()) rows_qd_[row * coordinates_ + k][lane] = qd[at(k)];
    if (!qdd.empty()) rows_qdd_[row * coordinates_ + k][lane] = qdd[at(k)];
  }
  for (int k = 0; k < multipliers_ && !lambda.empty(); ++k) rows_lambda_[row * multipliers_ + k][lane] = lambda[at(k)];
}

void LaneMotion::keep_row(int row) {
  const auto keep = [row](LaneNumbers& rows, const LaneNumbers& numbers, int count) {
    std::copy(numbers.data(), numbers.data() + lane_count * count, rows[row * count]);
  };
  keep(rows_q_, now_.q, coordinates_);
  keep(rows_qd_, now_.qd, coordinates_);
  keep(rows_qdd_, now_.qdd, coordinates_);
  keep(rows_turned_, now_.turned, 2 * (coordinates_ / 3));
  keep(rows_margin_, now_.margin, tails_);
  keep(rows_lambda_, now_.lambda, multipliers_);
}

}  // namespace catena
