// Dynamics where constraints depend on each other for an instant: at rows, and at the start.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/branches/branch_keeping.hpp"
#include "catena/analysis/dynamics/dynamics.hpp"
#include "catena/analysis/pose/scaling.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// For so many of the moments over which derivatives are taken the slope at a start may stand for those after it.
constexpr double known_moments = 10;

}  // namespace

// Accelerations of the row at t by the limit of the motion, where the equations of motion do not have them.
void Dynamics::look_for_singularity(double t) {
  const std::size_t n = q_.size();
  const std::span<double> y(row_.y), slope(row_.slope);
  if (!singular_.look(t, y.first(n), y.subspan(n, n), slope.subspan(n, n))) return;
  if (singular_.has_names() || !run_.needs.multipliers) return;
  if (MinimumNorm* least = reactions_.factorize(evaluator_)) singular_.name(least->name_ambiguous());
}

// What holds steps up where the motion has come to a place at which two branches nearly meet, or constraints depend on
// each other; else empty.
std::string Dynamics::near_branches() {
  const int row = equations_.weakest_row();
  std::string cause;
  if (plan_->rows > 0 && equations_.smallest_pivot_ratio() < dependence::likely_cause && row >= 0) {
    const int element = plan_->row_element[static_cast<std::size_t>(row)];
    cause = fmt::format("a singular configuration: {} \"{}\" depends on other constraints there",
                        model_->element_type(element), model_->element_name(element));
  }
  if (!BranchKeeping::judges(equations_)) return cause;
  evaluator_.set_time(under_way_.integrator->time());
  const double gap = BranchKeeping(equations_).narrow_gap(equations_, under_way_.integrator->state().first(q_.size()));
  if (gap == 0) return cause;
  return fmt::format(
      "two branches of the motion that pass each other here at a distance of {:.2g} rad or length scales, nearer than "
      "steps can tell apart at a tolerance of {:.3g}: give dimensions that agree exactly or differ by 1e-9 and more, "
      "or a larger tolerance",
      gap, options_.tolerance);
}

// Whether the motion starts at such an instant; it then knows its first slope. The integrator was started, and the
// factors are those of the start.
bool Dynamics::know_singular_start() {
  const std::size_t n = q_.size();
  const std::span<double> y(row_.y), slope(row_.slope);
  if (!singular_.look_at_start(t_, y.first(n), y.subspan(n, n), slope.subspan(n, n))) return false;
  if (work_.account) {
    row_.lambda.assign(static_cast<std::size_t>(plan_->rows), 0.0);
    if (MinimumNorm* least = reactions_.factorize(evaluator_)) least->solve(singular_.loads(), row_.lambda);
    work_.account->powers(y.subspan(n, n), row_.lambda, slope.subspan(2 * n));
    under_way_.motion->add_losses(slope.subspan(2 * n));
  }
  under_way_.motion->know(t_, known_moments * singular_.moment(), slope.subspan(n));
  return true;
}

// Rows that were left out must follow from the others all along: drivers may agree at first and contradict each other
// later.
Report Dynamics::check_redundant_rows() {
  Report report;
  if (redundant_.count() == 0 || !under_way_.integrator->meets_constraints()) return report;
  if (!(under_way_.integrator->position_residual() > thresholds::contradiction)) return report;
  evaluator_.set_time(t_, Side::before);
  evaluator_.set_configuration(under_way_.integrator->state().first(q_.size()));
  std::vector<double> phi(static_cast<std::size_t>(plan_->rows));
  evaluator_.phi(phi);
  int worst = 0;
  const double length = evaluator_.length_scale(), left = row_norm(*plan_, phi, length, &worst);
  if (!(left > thresholds::contradiction)) return report;
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

}  // namespace catena
