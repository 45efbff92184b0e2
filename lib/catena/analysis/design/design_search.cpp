#include "catena/analysis/design/design_search.hpp"

#include <algorithm>
#include <cmath>

namespace catena {
namespace {

// How often the way to a failed design is halved before its border counts as found.
constexpr int halvings = 6;
// Designs around a start that fails: corners of a cube of half the range, and its middle.
constexpr double around[] = {0.5, 0.25, 0.75};
// What a constraint that is missed within the tolerance costs, both in their sizes: more than most multipliers, so that
// a design gains nothing by it.
constexpr double price_of_violation = 10;
// Of the objective's size, on the square of the distance beyond a border in parts of the ranges.
constexpr double steepness = 10;
// Designs that are left for judging the best one: its gradient, a step of either length, and the gradient of a better
// one that such a step finds (optimise_design.cpp).
constexpr int for_judging = 4;
// Of all designs one in so many may be left for something else than the search: by a search everywhere for that from
// the best one, and for judging where it is no more.
constexpr int one_in_left = 10;

double size_of(double value, std::span<const double> gradient, const std::vector<double>& range) {
  double sum = 0;
  for (std::size_t v = 0; v < gradient.size(); ++v) sum += gradient[v] * range[v] * gradient[v] * range[v];
  const double size = std::max(std::abs(value), std::sqrt(sum));
  return size > 0 && std::isfinite(size) ? size : 1;
}

bool all_finite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(), [](double value) { return std::isfinite(value); });
}
bool has_values(const DesignValues& values) {
  return std::isfinite(values.objective) && all_finite(values.unequal) && all_finite(values.equal);
}
bool has_gradients(const DesignValues& values, std::size_t variables) {
  const auto has = [&](const std::vector<double>& gradients, std::size_t rows) {
    return gradients.size() == rows * variables && all_finite(gradients);
  };
  return has(values.gradient, 1) && has(values.unequal_gradient, values.unequal.size()) &&
         has(values.equal_gradient, values.equal.size());
}

}  // namespace

DesignSearch::DesignSearch(const DesignProblem& problem, const DesignOptions& options, DesignOutcome& outcome)
    : problem_(problem),
      evaluate_(problem.begin_search ? problem.begin_search() : problem.evaluate),
      options_(options),
      outcome_(outcome),
      gradients_(uses_gradients(options.method)),
      unequal_size_(static_cast<std::size_t>(problem.inequalities), 1.0),
      equal_size_(static_cast<std::size_t>(problem.equations), 1.0) {}

std::vector<double> DesignSearch::design(std::span<const double> u) const {
  std::vector<double> x(u.size());
  for (std::size_t v = 0; v < u.size(); ++v) {
    // The ends exactly: rounding must not lead out of the bounds.
    x[v] = u[v] <= 0   ? problem_.lower[v]
           : u[v] >= 1 ? problem_.upper[v]
                       : problem_.lower[v] + u[v] * (problem_.upper[v] - problem_.lower[v]);
  }
  return x;
}

bool DesignSearch::go_on() {
  cancelled_ = cancelled_ || (options_.go_on && !options_.go_on());
  return !cancelled_ && outcome_.evaluations < most_evaluations();
}

int DesignSearch::most_evaluations() const {
  const int most = options_.max_evaluations;
  if (most < one_in_left * for_judging) return most;
  return most - for_judging - (searches_everywhere(options_.method) && !is_near_ ? most / one_in_left : 0);
}

bool DesignSearch::analyse(std::span<const double> u, Point& point) {
  ++outcome_.evaluations;
  DesignEvaluation evaluation = evaluate_(design(u), gradients_);
  if (evaluation.failure.empty() && !has_values(evaluation.values)) evaluation.failure = "not_finite";
  if (evaluation.failure.empty() && gradients_ && !has_gradients(evaluation.values, u.size()))
    evaluation.failure = "no_derivative";
  if (!evaluation.failure.empty()) {
    ++outcome_.failed[evaluation.failure];
    failures_.push_back({outcome_.evaluations, std::move(evaluation.failure)});
    return false;
  }
  point.u.assign(u.begin(), u.end());
  point.values = std::move(evaluation.values);
  largest_ = std::max(largest_, point.values.objective);
  least_ = std::min(least_, point.values.objective);
  double sum = 0;
  for (std::size_t v = 0; v < point.values.gradient.size(); ++v)
    sum += std::pow(point.values.gradient[v] * (problem_.upper[v] - problem_.lower[v]), 2);
  gradient_size_ = std::max(gradient_size_, std::sqrt(sum));
  return true;
}

std::vector<double> DesignSearch::best() const {
  std::vector<double> u(outcome_.x.size());
  for (std::size_t v = 0; v < u.size(); ++v)
    u[v] = std::clamp((outcome_.x[v] - problem_.lower[v]) / (problem_.upper[v] - problem_.lower[v]), 0.0, 1.0);
  return u;
}

std::optional<double> DesignSearch::change_along(std::span<const double> direction, double allowed) {
  std::vector<double> u = best();
  for (std::size_t v = 0; v < u.size(); ++v) u[v] = std::clamp(u[v] + direction[v], 0.0, 1.0);
  const double before = outcome_.values.objective;
  if (outcome_.evaluations >= options_.max_evaluations) return {};
  Point point;
  if (!analyse(u, point) || violation_of(point.values) > allowed) return {};
  compare(point);
  return point.values.objective - before;
}

double DesignSearch::violation_of(const DesignValues& values) const {
  double worst = 0;
  for (std::size_t k = 0; k < values.unequal.size(); ++k) worst = std::max(worst, values.unequal[k] / unequal_size_[k]);
  for (std::size_t k = 0; k < values.equal.size(); ++k)
    worst = std::max(worst, std::abs(values.equal[k]) / equal_size_[k]);
  return worst;
}

// Of two designs the one that meets the constraints is better, then the one with the smaller objective; of two that do
// not, the one that misses them by less.
void DesignSearch::compare(const Point& point) {
  const double allowed = 10 * options_.tolerance, violation = violation_of(point.values);
  if (improvements_ > 0) {
    const bool good = violation <= allowed, best_good = outcome_.violation <= allowed;
    const auto merit = [&](double objective, double missed) {
      return objective / objective_size_ + price_of_violation * std::max(missed, 0.0);
    };
    const bool better = good && best_good ? merit(point.values.objective, violation) <
                                                merit(outcome_.values.objective, outcome_.violation)
                                          : good || (!best_good && violation < outcome_.violation);
    if (!better) return;
  }
  ++improvements_;
  improved_.push_back({outcome_.evaluations, point});
  outcome_.x = design(point.u);
  outcome_.values = point.values;
  outcome_.violation = violation;
  if (options_.improved) options_.improved(outcome_.x, outcome_.values);
}

bool DesignSearch::complete_best() {
  if (gradients_) return true;
  if (outcome_.evaluations >= options_.max_evaluations) return false;
  ++outcome_.evaluations;
  DesignEvaluation evaluation = evaluate_(outcome_.x, true);
  const bool complete = evaluation.failure.empty() && has_values(evaluation.values) &&
                        has_gradients(evaluation.values, outcome_.x.size());
  if (!complete) return false;
  outcome_.values = std::move(evaluation.values);
  return true;
}

void DesignSearch::take_sizes(const DesignSearch& other) {
  has_sizes_ = other.has_sizes_;
  objective_size_ = other.objective_size_;
  unequal_size_ = other.unequal_size_;
  equal_size_ = other.equal_size_;
}

bool DesignSearch::absorb(const DesignSearch& other) {
  const int left = most_evaluations() - outcome_.evaluations;
  for (const Improvement& improvement : other.improved_) {
    if (improvement.number <= left) compare(improvement.point);
  }
  for (const Failure& failure : other.failures_) {
    if (failure.number <= left) ++outcome_.failed[failure.reason];
  }
  largest_ = std::max(largest_, other.largest_);
  least_ = std::min(least_, other.least_);
  gradient_size_ = std::max(gradient_size_, other.gradient_size_);
  cancelled_ = cancelled_ || other.cancelled_;
  outcome_.evaluations += std::min(left, other.outcome_.evaluations);
  return other.outcome_.evaluations <= left;
}

bool DesignSearch::begin(std::vector<double>& u) {
  const std::size_t n = u.size();
  std::vector<double> range(n);
  for (std::size_t v = 0; v < n; ++v) range[v] = problem_.upper[v] - problem_.lower[v];
  bool found = analyse(u, now_);
  for (std::size_t k = 0; !found && k < std::size(around) && go_on(); ++k) {
    std::fill(u.begin(), u.end(), around[k]);
    found = analyse(u, now_);
  }
  if (!found) return false;
  const auto row = [&](const std::vector<double>& all, std::size_t k) {
    return all.size() >= (k + 1) * n ? std::span<const double>(all).subspan(k * n, n) : std::span<const double>();
  };
  if (!has_sizes_) {
    has_sizes_ = true;
    const DesignValues& values = now_.values;
    objective_size_ = size_of(values.objective, values.gradient, range);
    for (std::size_t k = 0; k < unequal_size_.size(); ++k)
      unequal_size_[k] = size_of(values.unequal[k], row(values.unequal_gradient, k), range);
    for (std::size_t k = 0; k < equal_size_.size(); ++k)
      equal_size_[k] = size_of(values.equal[k], row(values.equal_gradient, k), range);
  }
  good_ = now_;
  compare(now_);
  return true;
}

// See the header.
void DesignSearch::replace_failed(std::span<const double> u) {
  const std::size_t n = u.size();
  Point border = good_, trial;
  double reached = 0, failed = 1;
  for (int k = 0; k < halvings && go_on(); ++k) {
    const double part = (reached + failed) / 2;
    std::vector<double> between(n);
    for (std::size_t v = 0; v < n; ++v) between[v] = good_.u[v] + part * (u[v] - good_.u[v]);
    if (analyse(between, trial)) {
      border = trial;
      reached = part;
      compare(border);
    } else {
      failed = part;
    }
  }
  now_ = border;
  now_.u.assign(u.begin(), u.end());
  DesignValues& values = now_.values;
  double beyond = 0;
  const double weight = steepness * std::max(objective_size_, std::abs(values.objective));
  for (std::size_t v = 0; v < n; ++v) {
    const double d = u[v] - border.u[v], range = problem_.upper[v] - problem_.lower[v];
    beyond += d * d;
    if (!values.gradient.empty()) {
      values.objective += values.gradient[v] * range * d;
      values.gradient[v] += 2 * weight * d / range;
    }
    for (std::size_t k = 0; k < values.unequal.size() && !values.unequal_gradient.empty(); ++k)
      values.unequal[k] += values.unequal_gradient[k * n + v] * range * d;
    for (std::size_t k = 0; k < values.equal.size() && !values.equal_gradient.empty(); ++k)
      values.equal[k] += values.equal_gradient[k * n + v] * range * d;
  }
  values.objective += weight * beyond;
}

const DesignSearch::Point& DesignSearch::look(std::span<const double> u) {
  if (std::ranges::equal(u, now_.u)) return now_;
  Point point;
  if (analyse(u, point)) {
    now_ = good_ = std::move(point);
    compare(now_);
  } else {
    replace_failed(u);
  }
  return now_;
}

double DesignSearch::objective(std::span<const double> u, std::span<double> gradient) {
  const Point& point = look(u);
  for (std::size_t v = 0; v < gradient.size(); ++v)
    gradient[v] = point.values.gradient[v] * (problem_.upper[v] - problem_.lower[v]) / objective_size_;
  return point.values.objective / objective_size_;
}

void DesignSearch::unequal(std::span<const double> u, std::span<double> g, std::span<double> jacobian) {
  const DesignValues& values = look(u).values;
  for (std::size_t k = 0; k < g.size(); ++k) g[k] = values.unequal[k] / unequal_size_[k];
  for (std::size_t k = 0; k < jacobian.size(); ++k) {
    const std::size_t v = k % u.size();
    jacobian[k] = values.unequal_gradient[k] * (problem_.upper[v] - problem_.lower[v]) / unequal_size_[k / u.size()];
  }
}

void DesignSearch::equal(std::span<const double> u, std::span<double> h, std::span<double> jacobian) {
  const DesignValues& values = look(u).values;
  for (std::size_t k = 0; k < h.size(); ++k) h[k] = values.equal[k] / equal_size_[k];
  for (std::size_t k = 0; k < jacobian.size(); ++k) {
    const std::size_t v = k % u.size();
    jacobian[k] = values.equal_gradient[k] * (problem_.upper[v] - problem_.lower[v]) / equal_size_[k / u.size()];
  }
}

}  // namespace catena
