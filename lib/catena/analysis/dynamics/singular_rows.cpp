#include "catena/analysis/dynamics/singular_rows.hpp"

#include <fmt/format.h>

#include <utility>

#include "catena/linalg/rank/dependence.hpp"

namespace catena {

void SingularRows::begin_run() {
  dependent_ = always_dependent_ = unbounded_ = false;
  limits_ = formal_ = {};
}

void SingularRows::follow_step() {
  always_dependent_ = std::exchange(dependent_, equations_.is_singular()) && dependent_;
}

bool SingularRows::look(double t, std::span<const double> q, std::span<const double> qd, std::span<double> qdd) {
  here_ = false;
  if (always_dependent_ || !(equations_.smallest_pivot_ratio() < dependence::independent)) return false;
  if (!instant_) instant_.emplace(equations_);
  const SingularInstant::Outcome outcome = instant_->solve(t, q, qd, qdd);
  here_ = outcome == SingularInstant::Outcome::found;
  if (outcome == SingularInstant::Outcome::always_dependent) dependent_ = true;
  if (outcome == SingularInstant::Outcome::not_found && formal_.rows++ == 0) formal_.t = t;
  if (!here_) return false;
  if (limits_.rows++ == 0) limits_.t = t;
  unbounded_ |= instant_->unbounded();
  return true;
}

bool SingularRows::look_at_start(double t, std::span<const double> q, std::span<const double> qd,
                                 std::span<double> qdd) {
  dependent_ = equations_.is_singular();
  if (!(equations_.smallest_pivot_ratio() < dependence::independent)) return false;
  if (!instant_) instant_.emplace(equations_);
  if (instant_->solve(t, q, qd, qdd) != SingularInstant::Outcome::found) return false;
  dependent_ = false;
  return true;
}

std::string SingularRows::told(const Seen& seen) {
  return fmt::format("at t = {:.12g} s{}", seen.t,
                     seen.rows > 1 ? fmt::format(" and in {} more rows", seen.rows - 1) : "");
}

void SingularRows::remark(std::vector<std::string>& warnings) const {
  if (limits_.rows > 0) {
    std::string remark = fmt::format(
        "{} the mechanism is in a singular position: accelerations and loads there are the limit of the motion",
        told(limits_));
    if (!names_.empty()) {
      remark += fmt::format("; reactions of {} {}: the least that carry the rest are given", names_,
                            unbounded_ ? "grow without bound" : "are not determined");
    }
    warnings.push_back(std::move(remark));
  }
  if (formal_.rows > 0) {
    warnings.push_back(
        fmt::format("{} constraints depend on each other and do not determine the accelerations: accelerations and "
                    "loads there solve the equations, but need not be the limit of the motion",
                    told(formal_)));
  }
}

}  // namespace catena
