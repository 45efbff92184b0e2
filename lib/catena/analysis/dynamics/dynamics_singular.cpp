// Dynamics where constraints depend on each other for an instant: at rows, and at the start.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/pose/scaling.hpp"

namespace catena {
namespace {

// A smallest pivot ratio below this one: accelerations are rounding errors, or formal.
constexpr double near_singular = 1e-8;
// For so many of the moments over which derivatives are taken the slope at a start may stand for those after it.
constexpr double known_moments = 10;

// Projection meets constraints to 1e-15, and what follows from them to that divided by a sine; in length scales or rad.
constexpr double contradiction = 1e-9;

std::string rows_at(double t, std::int64_t rows) {
  return fmt::format("at t = {:.12g} s{}", t, rows > 1 ? fmt::format(" and in {} more rows", rows - 1) : "");
}

}  // namespace

// Accelerations of the row at t by the limit of the motion, where the equations of motion do not have them.
void Dynamics::look_for_singularity(double t) {
  at_singularity_ = false;
  if (always_dependent_ || !(equations_.smallest_pivot_ratio() < near_singular)) return;
  if (!singular_) singular_.emplace(equations_);
  const std::size_t n = q_.size();
  const std::span<double> y(y_row_), slope(slope_row_);
  const auto outcome = singular_->solve(t, y.first(n), y.subspan(n, n), slope.subspan(n, n));
  at_singularity_ = outcome == SingularInstant::Outcome::found;
  if (outcome == SingularInstant::Outcome::always_dependent) dependent_ = true;
  if (outcome == SingularInstant::Outcome::not_found && formal_rows_++ == 0) formal_t_ = t;
  if (!at_singularity_) return;
  if (singular_rows_++ == 0) singular_t_ = t;
  unbounded_ |= singular_->unbounded();
  if (!singular_names_.empty() || !needs_.multipliers) return;
  if (!minimum_norm_) minimum_norm_.emplace(evaluator_);
  if (minimum_norm_->factorize()) singular_names_ = minimum_norm_->name_ambiguous();
}

// Whether the motion starts at such an instant; it then knows its first slope. The integrator was started, and the
// factors are those of the start.
bool Dynamics::know_singular_start() {
  dependent_ = equations_.is_singular();
  if (!(equations_.smallest_pivot_ratio() < near_singular)) return false;
  const std::size_t n = q_.size();
  const std::span<double> y(y_row_), slope(slope_row_);
  if (!singular_) singular_.emplace(equations_);
  const auto outcome = singular_->solve(t_, y.first(n), y.subspan(n, n), slope.subspan(n, n));
  if (outcome != SingularInstant::Outcome::found) return false;
  dependent_ = false;
  if (account_) {
    lambda_row_.assign(static_cast<std::size_t>(plan_->rows), 0.0);
    if (!minimum_norm_) minimum_norm_.emplace(evaluator_);
    if (minimum_norm_->factorize()) minimum_norm_->solve(singular_->loads(), lambda_row_);
    account_->powers(y.subspan(n, n), lambda_row_, slope.subspan(2 * n));
    motion_->add_losses(slope.subspan(2 * n));
  }
  motion_->know(t_, known_moments * singular_->moment(), slope.subspan(n));
  return true;
}

// Rows that were left out must follow from the others all along: drivers may agree at first and contradict each other
// later.
Report Dynamics::check_redundant_rows() {
  Report report;
  if (redundant_.count() == 0 || !integrator_->meets_constraints()) return report;
  if (!(integrator_->position_residual() > contradiction)) return report;
  evaluator_.set_time(t_, Side::before);
  evaluator_.set_configuration(integrator_->state().first(q_.size()));
  std::vector<double> phi(static_cast<std::size_t>(plan_->rows));
  evaluator_.phi(phi);
  int worst = 0;
  const double length = evaluator_.length_scale(), left = row_norm(*plan_, phi, length, &worst);
  if (!(left > contradiction)) return report;
  const auto row = static_cast<std::size_t>(worst);
  const int element = plan_->row_element[row];
  report.status = Status::inconsistent;
  report.message = fmt::format(
      "constraints that depend on each other contradict each other at t = {:.12g} s: {} \"{}\" misses by {:.3g} {} "
      "where the others are met; likely cause: drivers that ask for different motions of the same parts",
      t_, model_->element_type(element), model_->element_name(element), left * (plan_->row_is_angle[row] ? 1 : length),
      plan_->row_is_angle[row] ? "rad" : "m");
  return report;
}

void Dynamics::remark_on_singularities(std::vector<std::string>& warnings) const {
  if (singular_rows_ > 0) {
    std::string remark = fmt::format(
        "{} the mechanism is in a singular position: accelerations and loads there are the limit of the motion",
        rows_at(singular_t_, singular_rows_));
    if (!singular_names_.empty()) {
      remark += fmt::format("; reactions of {} {}: the least that carry the rest are given", singular_names_,
                            unbounded_ ? "grow without bound" : "are not determined");
    }
    warnings.push_back(std::move(remark));
  }
  if (formal_rows_ > 0) {
    warnings.push_back(
        fmt::format("{} constraints depend on each other and do not determine the accelerations: accelerations and "
                    "loads there solve the equations, but need not be the limit of the motion",
                    rows_at(formal_t_, formal_rows_)));
  }
}

}  // namespace catena
