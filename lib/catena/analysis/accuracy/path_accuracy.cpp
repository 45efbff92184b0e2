#include "catena/analysis/accuracy/path_accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/accuracy/flutter_place.hpp"
#include "catena/analysis/balance/static_accuracy.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double no_multiplier = std::numeric_limits<double>::quiet_NaN();
// Rows that are disturbed beside those at critical points: each costs three models more, and some ten solves. What
// Newton's method left differs from row to row, and is looked for in all.
constexpr std::size_t disturbed_rows = 20;

}  // namespace

PathAccuracy::PathAccuracy(const Path& analysis, std::shared_ptr<const Model> first, ModelAt model_at,
                           const PathOptions& options, double t, const ColumnSet& columns)
    : first_(std::move(first)),
      columns_(columns),
      info_{{"parameter", UnitKind::own}},
      evaluator_(analysis.shared_plan(), *first_, evaluation_),
      system_(evaluator_),
      path_(system_, std::move(model_at), options.from, std::max(std::abs(options.to - options.from), 1e-300)),
      terms_(evaluator_),
      errors_(columns.size() + 1) {
  info_.insert(info_.end(), columns.info().begin(), columns.info().end());
  evaluator_.set_time(t);
  path_.set_time(t);
  for (int b = 0; b < evaluator_.plan().moving; ++b) origin_.push_back(evaluator_.origin(b));
}

// Places relative to the origins of the first model, as PathSystem has them.
void PathAccuracy::take(double value, const Snapshot& snapshot, std::span<const double> row) {
  errors_.take_row(row);
  if (evaluator_.plan().columns > Disturbance::most_columns) return;
  Row& kept = rows_.emplace_back();
  kept.values.assign(row.begin(), row.end());
  kept.point.p = value;
  kept.point.q.assign(snapshot.q.begin(), snapshot.q.end());
  kept.point.lambda.assign(snapshot.lambda.begin(), snapshot.lambda.end());
  for (std::size_t b = 0; b < origin_.size(); ++b) {
    const Vec2<double> shift = snapshot.evaluator.origin(static_cast<int>(b)) - origin_[b];
    kept.point.q[3 * b] += shift.x;
    kept.point.q[3 * b + 1] += shift.y;
  }
}

// Evenly spread over the path, its ends and critical points among them.
std::vector<std::size_t> PathAccuracy::chosen(const PathReport& report) const {
  std::vector<std::size_t> numbers;
  const std::size_t last = rows_.size() - 1, count = std::min(last, disturbed_rows - 1);
  for (std::size_t k = 0; k <= count; ++k) numbers.push_back(count > 0 ? k * last / count : 0);
  for (const PathCritical& critical : report.critical) numbers.push_back(at(critical.row));
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
  return numbers;
}

std::vector<double> PathAccuracy::digits(const PathReport& report) {
  const auto crosses = [](const PathCritical& critical) { return critical.branch; };
  if (!report.ok() || rows_.empty() || system_.has_gaps()) return {};
  if (std::any_of(report.critical.begin(), report.critical.end(), crosses)) return {};
  if (evaluator_.time() != 0 && !first_->functions.empty()) return {};
  const std::vector<std::size_t> numbers = chosen(report);
  for (std::size_t number = 0; number < rows_.size(); ++number) {
    if (!examine(rows_[number], std::binary_search(numbers.begin(), numbers.end(), number))) return {};
  }
  for (const PathCritical& critical : report.critical) {
    if (critical.flutter && !take_place_of_flutter(rows_[at(critical.row)])) return {};
  }
  errors_.take_places(info_, evaluator_.length_scale());
  return errors_.digits();
}

// Takes what lies along the path out of the answer to these right-hand sides.
bool PathAccuracy::answer(const PathPoint& tangent, std::span<const double> right_side) {
  const std::size_t columns = at(evaluator_.plan().columns);
  solution_.resize(right_side.size());
  path_.solve(right_side, solution_);
  const auto middle = solution_.begin() + static_cast<std::ptrdiff_t>(columns);
  change_ = {{solution_.begin(), middle}, {middle, solution_.end()}, 0};
  const double along = path_.product(tangent, change_);
  for (std::size_t c = 0; c < columns; ++c) change_.q[c] -= along * tangent.q[c];
  for (std::size_t r = 0; r < change_.lambda.size(); ++r) change_.lambda[r] -= along * tangent.lambda[r];
  change_.p = -along * tangent.p;
  return std::isfinite(path_.product(change_, change_));
}

bool PathAccuracy::values_at(const PathPoint& x, std::vector<double>& values) {
  if (!path_.move_to(x)) return false;
  const Snapshot snapshot{
      .evaluator = evaluator_, .t = evaluator_.time(), .q = path_.q(), .lambda = x.lambda, .residual = no_multiplier};
  values.resize(columns_.size() + 1);
  values[0] = x.p;
  columns_.evaluate(snapshot, std::span(values).subspan(1));
  return true;
}

bool PathAccuracy::examine(const Row& row, bool disturbed) {
  const std::size_t columns = at(evaluator_.plan().columns);
  if (!path_.factorize(row.point)) return false;
  const PathPoint tangent = path_.tangent(row.point, path_.along_parameter(1));
  // The derivative by the parameter has left the system here.
  right_side_.assign(columns + system_.phi().size(), 0.0);
  const std::span<double> sides = right_side_;
  system_.residual(row.point.lambda, sides.first(columns));
  std::copy(system_.phi().begin(), system_.phi().end(), sides.begin() + static_cast<std::ptrdiff_t>(columns));
  for (double& side : right_side_) side = -side;
  if (!answer(tangent, right_side_)) return false;
  if (!(std::sqrt(path_.product(change_, change_)) <= Disturbance::largest_way)) return false;
  const PathPoint mended = path_.advanced(row.point, change_, 1);
  if (!values_at(mended, mended_values_)) return false;
  square_.assign(row.values.size(), 0.0);
  const std::vector<double> rounding = disturbed ? balance_rounding(system_, mended.lambda) : std::vector<double>{};
  for (int k = 0; disturbed && k < Disturbance::disturbed_values; ++k) {
    if (!disturb(mended, tangent, rounding)) return false;
  }
  for (std::size_t k = 0; k < square_.size(); ++k) {
    if (std::isnan(row.values[k])) continue;
    errors_.take_error(k, std::abs(row.values[k] - mended_values_[k]) +
                              Disturbance::deviations * std::sqrt(square_[k] / Disturbance::disturbed_values));
  }
  return true;
}

// By what the columns change along the path as far as the row is off. False: that is not known.
bool PathAccuracy::take_place_of_flutter(const Row& row) {
  if (!path_.factorize(row.point)) return false;
  const PathPoint tangent = path_.tangent(row.point, path_.along_parameter(1));
  const double way = flutter_place_error(path_, row.point, tangent);
  if (!(way <= Disturbance::largest_way) ||
      !values_at(path_.advanced(row.point, tangent, Disturbance::largest_way), other_))
    return false;
  for (std::size_t k = 0; k < other_.size(); ++k) {
    if (!std::isnan(row.values[k]))
      errors_.take_error(k, std::abs(other_[k] - row.values[k]) / Disturbance::largest_way * way);
  }
  return true;
}

bool PathAccuracy::disturb(const PathPoint& mended, const PathPoint& tangent, std::span<const double> rounding) {
  const Plan& plan = evaluator_.plan();
  const std::size_t columns = at(plan.columns);
  if (!path_.move_to(mended)) return false;
  place_moduli(evaluator_, path_.q(), moduli_);
  const std::span<const double> terms = terms_.sum(system_.jacobian(), moduli_);
  for (std::size_t c = 0; c < columns; ++c) right_side_[c] = Disturbance::usual_rounding * random_.next() * rounding[c];
  for (std::size_t r = 0; r < terms.size(); ++r)
    right_side_[columns + r] = random_.next() * Disturbance::epsilon * terms[r];
  if (!answer(tangent, right_side_)) return false;
  const double way = std::sqrt(path_.product(change_, change_));
  const double size =
      std::min(Disturbance::amplification, way > 0 ? Disturbance::largest_way / way : Disturbance::amplification);
  for (std::size_t c = 0; c < columns; ++c)
    change_.q[c] += Disturbance::epsilon / 2 * random_.next() * moduli_[at(plan.coordinate[c])];
  for (std::size_t r = 0; r < change_.lambda.size(); ++r)
    change_.lambda[r] += Disturbance::epsilon / 2 * random_.next() * mended.lambda[r];
  change_.p += Disturbance::epsilon / 2 * random_.next() * mended.p;
  if (!values_at(path_.advanced(mended, change_, size), other_)) return false;
  for (std::size_t k = 0; k < square_.size(); ++k) {
    const double difference = (other_[k] - mended_values_[k]) / size;
    square_[k] += difference * difference;
  }
  return true;
}

}  // namespace catena
