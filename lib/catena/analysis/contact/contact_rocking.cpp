// Feet that land and lift in turns, as those of a block that rocks: each landing lifts the other foot more slowly, and
// the instants accumulate as those of a bouncing ball do, though nothing bounces.
//
//   T_0, T_1, T_2 ...  time aloft of the feet in turns,  T_n+1 = r T_n      they end at  t + T r / (1 - r)
//
// A foot that lifts more slowly than `rest_speed` in such a row of ever shorter flights stays where it is. Source:
// G. W. Housner, The behavior of inverted pendulum structures during earthquakes (1963), for r.
#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "catena/analysis/contact/contact_switch.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
// Closed places that an impact opens too slowly to matter, where the places that are hit and they took turns before.
std::vector<std::size_t> ContactSwitch::rocking(double t, const std::vector<std::size_t>& hit) const {
  std::vector<std::size_t> lifted;
  const bool shorter =
      std::all_of(hit.begin(), hit.end(), [&](std::size_t k) { return t - past_.left_at[k] < past_.flight[k]; });
  if (!shorter) return lifted;
  for (const std::size_t k : active_) {
    if (points_[k].kind != ContactKind::rigid || std::isnan(past_.flight[k])) continue;
    if (std::find(hit.begin(), hit.end(), k) != hit.end()) continue;
    if (gap_[k].rate > part_of_speed(k, no_speed) && gap_[k].rate < rest_speed(k)) lifted.push_back(k);
  }
  return lifted;
}

// Both feet are then at rest: what was left of their rates is taken away, in the metric of the masses. Returns
// when ever shorter flights would have ended, or t.
double ContactSwitch::end_rocking(double t, const std::vector<std::size_t>& hit, std::span<double> qd) {
  std::vector<std::size_t> held = rocking(t, hit);
  if (held.empty()) return t;
  held.insert(held.end(), hit.begin(), hit.end());
  // What is at rest stays so.
  const auto rests = [&](std::size_t k, const Evaluator::ScalarMotion& motion) {
    return std::abs(motion.rate) <= part_of_speed(k, no_speed);
  };
  const auto first_at_rest = static_cast<std::ptrdiff_t>(held.size());
  for (const std::size_t k : active_) {
    const bool is_held = std::find(held.begin(), held.begin() + first_at_rest, k) != held.begin() + first_at_rest;
    if (!is_held && points_[k].kind == ContactKind::rigid && rests(k, gap_[k])) held.push_back(k);
  }
  // Rows across, and along where friction holds what moves so little.
  std::vector<std::size_t> rows;
  for (std::size_t n = 0; n < held.size(); ++n) {
    const std::size_t k = held[n];
    const auto a = static_cast<std::size_t>(std::find(active_.begin(), active_.end(), k) - active_.begin());
    rows.push_back(2 * a);
    const bool grips = points_[k].has_friction() && points_[k].is_exact();
    const bool was_at_rest = static_cast<std::ptrdiff_t>(n) >= first_at_rest;
    if (grips && (was_at_rest ? rests(k, slide_[k]) : std::abs(slide_[k].rate) < rest_speed(k)))
      rows.push_back(2 * a + 1);
  }
  bring_to_rest(rows, qd);
  if (jump_) jump_->settles = true;
  look(qd);
  // Two flights of one foot lie two ratios apart.
  const double flight = t - past_.left_at[hit.front()], ratio = std::sqrt(flight / past_.flight[hit.front()]);
  return ratio < 1 ? t + flight * ratio / (1 - ratio) : t;
}

// Takes the rates of rows, numbered as those of D, away by impulses there.
void ContactSwitch::bring_to_rest(const std::vector<std::size_t>& rows, std::span<double> qd) {
  const auto size = static_cast<Eigen::Index>(rows.size());
  const auto row = [&](Eigen::Index r) { return rows[static_cast<std::size_t>(r)]; };
  Eigen::MatrixXd response(size, size);
  Eigen::VectorXd rate(size), unit(size);
  for (Eigen::Index r = 0; r < size; ++r) {
    const std::size_t k = active_[row(r) / 2];
    const Evaluator::ScalarMotion& motion = row(r) % 2 == 0 ? gap_[k] : slide_[k];
    rate(r) = motion.rate;
    for (Eigen::Index c = 0; c < size; ++c) response(r, c) = product(motion, change_[row(c)]);
    // What constraints and drivers carry altogether is left with rounding.
    unit(r) = gives_way(row(r), response(r, r)) ? 1 / std::sqrt(response(r, r)) : 0;
  }
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
  factors.setThreshold(ContactProblem::no_response);
  factors.compute(unit.asDiagonal() * response * unit.asDiagonal());
  const Eigen::VectorXd impulse = unit.cwiseProduct(factors.solve(-unit.cwiseProduct(rate)));
  for (Eigen::Index c = 0; c < size; ++c) {
    for (std::size_t k = 0; k < qd.size(); ++k) qd[k] += change_[row(c)][k] * impulse(c);
    for (std::size_t r = 0; r < p_.size(); ++r) p_[r] += multipliers_[row(c)][r] * impulse(c);
  }
}

// Rates of touching places that cannot be told from rest are none. Else a place that stays would be held by moving the
// others a little, which then seem to close or to open: places would take turns at one instant without end.
void ContactSwitch::settle(std::span<double> qd) {
  std::vector<std::size_t> rows;
  bool moves = false;
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const std::size_t k = active_[a];
    const double rest = part_of_speed(k, no_speed);
    const auto take = [&](std::size_t row, const Evaluator::ScalarMotion& motion) {
      if (!(std::abs(motion.rate) <= rest)) return;
      rows.push_back(row);
      moves |=
          std::abs(motion.rate) > thresholds::sum_rounding * std::max(size_of_product(motion, qd), part_of_speed(k, 1));
    };
    if (points_[k].kind == ContactKind::rigid) take(2 * a, gap_[k]);
    if (points_[k].kind == ContactKind::rigid && points_[k].has_friction() && points_[k].is_exact())
      take(2 * a + 1, slide_[k]);
  }
  if (!moves) return;
  find_responses();
  bring_to_rest(rows, qd);
  look(qd);
}

void ContactSwitch::note_flights(double t, const std::vector<std::size_t>& hit) {
  for (const std::size_t k : hit) {
    if (std::isfinite(past_.left_at[k])) past_.flight[k] = t - past_.left_at[k];
  }
}

}  // namespace catena
