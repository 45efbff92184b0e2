#include "catena/analysis/dynamics/error_estimate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace catena {
namespace {

constexpr double finer_tolerance_part = 0.1;  // of the tolerance

/// Records a difference and the size of the quantity.
void note(ErrorOfMotion& kind, double difference, int body, double t) {
  // A difference that is not a number must be kept.
  if (difference <= kind.error) return;
  kind.error = difference;
  kind.body = body;
  kind.t = t;
}

}  // namespace

double EstimatedError::largest() const {
  return std::max({position.relative(), angle.relative(), velocity.relative(), angular_velocity.relative()});
}

DynamicsOptions finer_options(const DynamicsOptions& options) {
  DynamicsOptions finer = options;
  if (options.step > 0) {
    finer.step = options.step / 2;
    return finer;
  }
  finer.tolerance = finer_tolerance_part * options.tolerance;
  if (finer.tolerance < DynamicsOptions::least_tolerance) {
    throw std::invalid_argument(fmt::format(
        "the error at tolerance {:.3g} cannot be estimated: double precision leaves no run at a tenth of it; give at "
        "least {:.0e}",
        options.tolerance, DynamicsOptions::least_tolerance / finer_tolerance_part));
  }
  return finer;
}

ErrorComparison::ErrorComparison(Dynamics& asked, const TimeGrid& grid, RowObserver& target, RowObserver* beside)
    : asked_(asked), grid_(grid), target_(target), beside_(beside) {
  error_.position.scale = asked.evaluator().length_scale();
  error_.angle.scale = 1;
  error_.until = t_ = asked.time();
}

bool ErrorComparison::proceed(double t) {
  t_ = t;
  return proceeding_ = target_.proceed(t);
}

bool ErrorComparison::Other::observe(const Snapshot& snapshot) {
  owner_.q_.assign(snapshot.q.begin(), snapshot.q.end());
  owner_.qd_.assign(snapshot.qd.begin(), snapshot.qd.end());
  return !owner_.beside_ || owner_.beside_->observe(snapshot);
}

// Observers see one run, the finer one; the other one only ends when cancelled.
bool ErrorComparison::Other::proceed(double) { return owner_.proceed(owner_.t_); }

bool ErrorComparison::observe(const Snapshot& snapshot) {
  t_ = snapshot.t;
  // Rows at events are not rows of the grid.
  if (row_ < grid_.size() && grid_[row_] == snapshot.t) {
    ++row_;
    if (asked_.go_on(row_, other_)) compare(snapshot);
    if (!proceeding_) return false;
  }
  return target_.observe(snapshot);
}

void ErrorComparison::compare(const Snapshot& snapshot) {
  const Plan& plan = asked_.plan();
  const std::span<const double> q = snapshot.q, v = snapshot.qd;
  for (int p = 0; p < plan.moving; ++p) {
    const std::size_t c = 3 * static_cast<std::size_t>(p);
    const int body = plan.model_body[static_cast<std::size_t>(p)];
    note(error_.position, std::hypot(q[c] - q_[c], q[c + 1] - q_[c + 1]), body, snapshot.t);
    note(error_.angle, std::abs(q[c + 2] - q_[c + 2]), body, snapshot.t);
    note(error_.velocity, std::hypot(v[c] - qd_[c], v[c + 1] - qd_[c + 1]), body, snapshot.t);
    note(error_.angular_velocity, std::abs(v[c + 2] - qd_[c + 2]), body, snapshot.t);
    error_.velocity.scale = std::max(error_.velocity.scale, std::hypot(v[c], v[c + 1]));
    error_.angular_velocity.scale = std::max(error_.angular_velocity.scale, std::abs(v[c + 2]));
  }
  error_.until = snapshot.t;
}

void add_estimate(AnalysisReport& report, const AnalysisReport& asked, const EstimatedError& error,
                  const DynamicsOptions& options) {
  report.counters += asked.counters;
  if (!asked.ok() && asked.status != Status::cancelled) {
    report.warnings.push_back(
        fmt::format("the error is estimated up to t = {:.12g} s only, where the run it is taken "
                    "from ended: {}",
                    error.until, asked.message));
  }
  const bool fixed = options.step > 0;
  report.warnings.push_back(
      fmt::format("estimated_error is how far a run {} is from the rows given here, which are of one {}",
                  fixed ? fmt::format("with steps of {:.6g} s", options.step)
                        : fmt::format("at tolerance {:.3g}", options.tolerance),
                  fixed ? "with steps half as long" : "at a tenth of it"));
  if (!fixed && error.largest() > EstimatedError::largest_multiple * options.tolerance) {
    report.warnings.push_back(fmt::format(
        "the estimated error is {:.2g} times the tolerance; likely cause: a motion in which small errors grow fast, "
        "forces that are not smooth, or rounding",
        error.largest() / options.tolerance));
  }
}

}  // namespace catena
