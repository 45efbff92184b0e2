// Velocities, accelerations and multipliers at the present instant, and whether redundant equations agree with them.
#include <fmt/format.h>

#include "catena/analysis/kinematics/kinematics.hpp"

namespace catena {
namespace {

// Below this reciprocal condition number reactions are taken from both sides of the singular configuration: a bridge,
// which meets the constraints to 2e-12, gives them there with a relative error of 1e-6.
constexpr double reactions_determined = 1e-6;
// Pivots of blocks above this part of the largest that they have been determine rates to that accuracy.
constexpr double well_determined = 1e-3;

}  // namespace

DrivenInstant Kinematics::here() const {
  const std::span<const double> unknown;
  return {now_.t, now_.q, now_.has_velocity ? std::span<const double>(now_.qd) : unknown,
          now_.has_acceleration ? std::span<const double>(now_.qdd) : unknown};
}

Report Kinematics::find_rates(const Needs& needs) {
  Report report;
  const bool acceleration = needs.acceleration || needs.multipliers;
  if (!needs.velocity && !acceleration) return report;
  if (now_.on_bridge) {
    // The bridge gives the rates; multipliers need factors of the matrix, which show whether they can be computed.
    if (!needs.multipliers) return report;
    if (solver_.factor_at(now_.q) > reactions_determined) return reactions_.solve(here());
    reactions_.take_limit(here(), stretch_);
    return report;
  }
  // Predictions cover the quantities that run() needs.
  const bool start = predicted_.t == now_.t && !predicted_.qd.empty();
  const bool acceleration_start = start && !predicted_.qdd.empty();
  predicted_.t.reset();
  if (start) now_.qd.swap(predicted_.qd);
  if (!solver_.solve_velocity(now_.qd, start)) {
    report.status = Status::singular;
    report.message = fmt::format(
        "velocities are not determined at t = {:.12g} s: the mechanism is at a singular configuration", now_.t);
    return report;
  }
  now_.has_velocity = true;
  if (!acceleration) return report;
  if (acceleration_start) now_.qdd.swap(predicted_.qdd);
  if (!solver_.solve_acceleration(now_.qd, now_.qdd, acceleration_start)) {
    report.status = Status::singular;
    report.message = fmt::format(
        "accelerations are not determined at t = {:.12g} s: the mechanism is at a singular configuration", now_.t);
    return report;
  }
  now_.has_acceleration = true;
  return needs.multipliers ? reactions_.solve(here()) : report;
}

// The velocity at the present point makes the first prediction where none is known yet.
bool Kinematics::find_velocity() {
  evaluator_.set_time(now_.t);
  trial_ = now_.q;
  if (!solver_.solve_position(trial_).converged || !solver_.solve_velocity(now_.qd, false)) return false;
  now_.has_velocity = true;
  predictor_.push(now_.t, now_.q, now_.qd, {});
  return true;
}

// Where the equations in use come near to dependence, others may be better conditioned. False: they are not.
bool Kinematics::choose_better_rows() {
  if (!rows_.has_redundant_rows()) return false;
  evaluator_.set_time(now_.t);
  if (!rows_.choose_better(now_.q)) return false;
  margins_.forget();
  remember_margins();
  return true;
}

Report Kinematics::check_redundant_rates(double allowed, bool in_words) {
  // Near a singular configuration rates are as accurate as the equations in use allow, which may be no digit at all.
  if (now_.on_bridge || margins_.has_fallen(well_determined)) return {};
  return rows_.check_rates(here(), allowed, in_words);
}

}  // namespace catena
