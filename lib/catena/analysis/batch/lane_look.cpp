#include "catena/analysis/batch/lane_look.hpp"

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// The quintic between rows is off by far less where the motion is smooth on the scale of its rows.
constexpr double largest_correction = 1e-2;

}  // namespace

LaneLook::LaneLook(const LaneProgram& program, Evaluator& evaluator, std::optional<LaneColumns> columns)
    : solver_(program),
      evaluator_(evaluator),
      columns_(columns),
      row_columns_(std::move(columns)),
      seen_(program),
      q_(catena::at(program.plan().coordinates()), 0.0),
      qd_(q_.size(), 0.0),
      qdd_(q_.size(), 0.0),
      lambda_(program.has_loads() ? catena::at(program.code().rows) : 0, 0.0),
      shift_(catena::at(program.code().moving)) {}

void LaneLook::follow(const LaneMotion& motion, int lane, const Model& model, std::span<const double> instants) {
  motion_ = &motion;
  motion_lane_ = lane;
  instants_ = instants;
  is_seen_.fill(false);
  next_lane_ = next_row_ = 0;
  lost_ = false;
  solver_.set_designs(model, evaluator_.length_scale());
  for (std::optional<LaneColumns>* columns : {&columns_, &row_columns_})
    if (*columns) (*columns)->set_designs(model, solver_);
  q_ = evaluator_.given_configuration();
  const LaneCode& code = solver_.program().code();
  for (int b = 0; b < code.moving; ++b) shift_[catena::at(b)] = Vec2<double>{} - evaluator_.origin(b);
  for (int k = 0; k < lane_count; ++k) foretell(k, instants.front());
}

// q at t, by the rows around it, into a lane.
void LaneLook::foretell(int lane, double t) {
  const int last = static_cast<int>(instants_.size()) - 1;
  // They are asked for in order, mostly: a few rows further on than the one before.
  int k = row_before_[catena::at(lane > 0 ? lane - 1 : 0)];
  const int far = std::min(k + 4, last - 1);
  while (k < far && instants_[catena::at(k) + 1] <= t) ++k;
  if (k >= last || instants_[catena::at(k)] > t || instants_[catena::at(k) + 1] <= t) {
    const auto later = std::upper_bound(instants_.begin(), instants_.end(), t);
    k = std::clamp(static_cast<int>(later - instants_.begin()) - 1, 0, std::max(last - 1, 0));
  }
  row_before_[catena::at(lane)] = k;
  const int next = std::min(k + 1, last);
  const double t0 = instants_[catena::at(k)], h = instants_[catena::at(next)] - t0, u = h != 0 ? (t - t0) / h : 1;
  const double v = 1 - u, u2 = u * u, u3 = u2 * u, v2 = v * v, v3 = v2 * v;
  const double a0 = v3 * (1 + u * (3 + 6 * u)), b0 = h * u * v3 * (1 + 3 * u), c0 = 0.5 * h * h * u2 * v3;
  const double a1 = u3 * (1 + v * (3 + 6 * v)), b1 = -(h * v * u3 * (1 + 3 * v)), c1 = 0.5 * h * h * v2 * u3;
  const double *const q0 = motion_->q(k) + motion_lane_, *const q1 = motion_->q(next) + motion_lane_;
  const double *const v0 = motion_->qd(k) + motion_lane_, *const v1 = motion_->qd(next) + motion_lane_;
  const double *const w0 = motion_->qdd(k) + motion_lane_, *const w1 = motion_->qdd(next) + motion_lane_;
  double* const q = seen_.q.data() + lane;
  for (int n = 0; n < lane_count * solver_.coordinates(); n += lane_count)
    q[n] = (a0 * q0[n] + a1 * q1[n]) + (b0 * v0[n] + b1 * v1[n]) + (c0 * w0[n] + c1 * w1[n]);
  seen_.t[catena::at(lane)] = t;
  const LaneNumbers& places = motion_->places(u < 0.5 ? k : next);
  for (int n = 0; n < 2 * solver_.program().searched().count(); ++n) seen_.places[n][lane] = places[n][motion_lane_];
}

bool LaneLook::is_sound(int lane) const {
  const double t = seen_.t[catena::at(lane)];
  bool sound = t >= instants_.front() && t <= instants_.back() && solver_.converged(lane) &&
               solver_.first_size(lane) <= largest_correction;
  const double* const before = motion_->margin(row_before_[catena::at(lane)]) + motion_lane_;
  for (int k = 0; k < motion_->tails(); ++k) {
    const double there = seen_.margin[k][lane], row = before[lane_count * k];
    sound = sound && there * row > 0 && std::abs(there) > least_margin * std::min(1.0, std::abs(row));
  }
  return sound;
}

void LaneLook::expect(std::span<const double> instants) {
  if (instants.empty()) return;
  const int count = static_cast<int>(std::min(instants.size(), catena::at(lane_count)));
  is_seen_.fill(false);
  for (int lane = 0; lane < count; ++lane) foretell(lane, instants[catena::at(lane)]);
  // Lanes of the same pack that are left over hold what was seen last.
  solver_.solve(seen_, count);
  for (int lane = 0; lane < count; ++lane) is_seen_[catena::at(lane)] = is_sound(lane);
  next_lane_ = 0;
  if (columns_)
    columns_->evaluate({0, count, seen_.t.data(), seen_.q.data(), seen_.qd.data(), seen_.qdd.data(),
                        seen_.turned.data(), seen_.lambda.data()});
}

std::optional<LaneLook::Place> LaneLook::find_seen(double t) {
  for (int n = 0; n < lane_count; ++n) {
    const int lane = (next_lane_ + n) % lane_count;
    if (!is_seen_[catena::at(lane)] || seen_.t[catena::at(lane)] != t) continue;
    next_lane_ = (lane + 1) % lane_count;
    return Place{-1, lane};
  }
  return {};
}

bool LaneLook::row_at(double t) {
  const auto is_row = [&](int k) {
    if (catena::at(k) >= instants_.size() || instants_[catena::at(k)] != t) return false;
    next_row_ = k;
    return true;
  };
  return is_row(next_row_) || is_row(next_row_ + 1) ||
         is_row(static_cast<int>(std::lower_bound(instants_.begin(), instants_.end(), t) - instants_.begin()));
}

// Rows, which come one after the other, and what was just seen are found at once.
std::optional<LaneLook::Place> LaneLook::find(double t) {
  const bool is_next = is_seen_[catena::at(next_lane_)] && seen_.t[catena::at(next_lane_)] == t;
  if (!is_next && row_at(t)) return Place{next_row_, -1};
  if (const std::optional<Place> place = find_seen(t)) return place;
  expect(std::span(&t, 1));
  const std::optional<Place> place = find_seen(t);
  lost_ = lost_ || !place;
  return place;
}

double LaneLook::pace_of(const double* qd, int lane) const {
  const double length_scale = evaluator_.length_scale();
  double pace = 0;
  for (int n = 0; n < solver_.coordinates(); ++n) {
    const double rate = std::abs(qd[lane_count * n + lane]);
    pace = std::max(pace, n % 3 == 2 ? rate : rate / length_scale);
  }
  return std::isfinite(pace) ? pace : 0;
}

std::optional<double> LaneLook::values(double t, std::span<double> out) {
  const std::optional<Place> place = find(t);
  if (!place) return {};
  if (place->row < 0) {
    for (std::size_t k = 0; k < out.size(); ++k) out[k] = columns_->value(k, place->lane);
    return pace_of(seen_.qd.data(), place->lane);
  }
  const int row = place->row, lane = motion_lane_;
  std::array<double, lane_count> instant{};
  instant[catena::at(lane)] = t;
  row_columns_->evaluate({lane, lane + 1, instant.data(), motion_->q(row), motion_->qd(row), motion_->qdd(row),
                          motion_->turned(row), motion_->lambda(row)});
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = row_columns_->value(k, lane);
  return pace_of(motion_->qd(row), lane);
}

Snapshot LaneLook::show(double t, double residual) {
  evaluator_.set_time(t);
  evaluator_.go_to_curve_places(places_);
  evaluator_.set_configuration(q_);
  Snapshot snapshot{.evaluator = evaluator_, .t = t, .q = q_, .qd = qd_, .qdd = qdd_};
  snapshot.lambda = lambda_;
  snapshot.residual = residual * evaluator_.length_scale();
  return snapshot;
}

std::optional<Snapshot> LaneLook::at(double t) {
  const std::optional<Place> place = find(t);
  if (!place) return {};
  const bool is_row = place->row >= 0;
  const int lane = is_row ? motion_lane_ : place->lane;
  const double* const q = is_row ? motion_->q(place->row) : seen_.q.data();
  const double* const qd = is_row ? motion_->qd(place->row) : seen_.qd.data();
  const double* const qdd = is_row ? motion_->qdd(place->row) : seen_.qdd.data();
  for (int n = 0; n < solver_.coordinates(); ++n) {
    const int number = lane_count * n + lane;
    const Vec2<double>& shift = shift_[catena::at(n / 3)];
    q_[catena::at(n)] = q[number] + (n % 3 == 0 ? shift.x : n % 3 == 1 ? shift.y : 0);
    qd_[catena::at(n)] = qd[number];
    qdd_[catena::at(n)] = qdd[number];
  }
  const double* const lambda = is_row ? motion_->lambda(place->row) : seen_.lambda.data();
  for (std::size_t r = 0; r < lambda_.size(); ++r) lambda_[r] = lambda[lane_count * static_cast<int>(r) + lane];
  solver_.searches().show_places(is_row ? motion_->places(place->row) : seen_.places, lane, places_);
  return show(t, is_row ? 0 : solver_.residual(lane));
}

}  // namespace catena
