// Dynamics where constraints depend on each other for an instant: at rows, and at the start.
#include <fmt/format.h>

#include "catena/analysis/dynamics.hpp"

namespace catena {
namespace {

// A smallest pivot ratio below this one: accelerations are rounding errors, or formal.
constexpr double near_singular = 1e-8;
// For so many of the moments over which derivatives are taken the slope at a start may stand for those after it.
constexpr double known_moments = 10;

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

// Tells the integrator what the first slope is, where the motion starts at such an instant.
void Dynamics::start_at_singularity() {
  const std::size_t n = q_.size();
  std::copy(q_.begin(), q_.end(), y_row_.begin());
  std::copy(qd_.begin(), qd_.end(), y_row_.begin() + static_cast<std::ptrdiff_t>(n));
  const std::span<double> y(y_row_), slope(slope_row_);
  if (!equations_.accelerations(t_, Side::after, y.first(n), y.subspan(n, n), slope.subspan(n, n))) return;
  dependent_ = equations_.is_dependent();
  if (!(equations_.smallest_pivot_ratio() < near_singular)) return;
  if (!singular_) singular_.emplace(equations_);
  const auto outcome = singular_->solve(t_, y.first(n), y.subspan(n, n), slope.subspan(n, n));
  if (outcome != SingularInstant::Outcome::found) return;
  dependent_ = false;
  if (account_) {
    lambda_row_.assign(static_cast<std::size_t>(plan_->rows), 0.0);
    if (!minimum_norm_) minimum_norm_.emplace(evaluator_);
    if (minimum_norm_->factorize()) minimum_norm_->solve(singular_->loads(), lambda_row_);
    account_->powers(y.subspan(n, n), lambda_row_, slope.subspan(2 * n));
  }
  motion_->know(t_, known_moments * singular_->moment(), slope.subspan(n));
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
        fmt::format("{} constraints depend on each other in a way that leaves accelerations open: accelerations and "
                    "loads there solve the equations, but need not be the limit of the motion",
                    rows_at(formal_t_, formal_rows_)));
  }
}

}  // namespace catena
