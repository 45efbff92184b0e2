#include "catena/analysis/statics/solvers/static_gaps.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "catena/analysis/statics/solvers/static_active_set.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// The smoothing begins with one of these, L being the size of the mechanism: where many gaps share a load a large t
// makes them act from a distance, with a small t their state alternates. It ends when the active set is certain.
constexpr double first_smoothings[] = {0.1, 0.03, 0.3};
constexpr double last_smoothing = 1e-8;
// Steps of t: the first factor, and the one that ends the search.
constexpr double first_cooling = 0.2, least_cooling = 0.97;
// A point is solved for a t when the change is below this, length scales or rad, and the residual below this part of t.
constexpr double arrived_change = 0.02, arrived_part = 0.1;
// Newton steps for it at all but the first t; if fewer than the second are needed, t decreases faster.
constexpr int most_steps = 8, quick_steps = 3;

// The smoothed complementarity of all gaps, in units.
class SmoothedGaps {
 public:
  SmoothedGaps(const StaticSystem& system, const GapUnits& scale) : system_(system), scale_(scale) {}

  /// Compliance d and right-hand side of every gap's row; other entries are left alone.
  void linearise(std::span<const double> lambda, double t, std::span<double> compliance, std::span<double> gap) const {
    for (int r : system_.plan().gap_rows) {
      const GapUnits u = units_of(system_, r, scale_);
      const double w = system_.phi()[at(r)] / u.gap, p = -lambda[at(r)] / u.force, d = w - p;
      const double root = std::hypot(d, 2 * t);
      // a, b: slopes by w and p; the smaller one without cancellation.
      const double small = 4 * t * t / (root * (root + std::abs(d))), large = (root + std::abs(d)) / root;
      const double a = d > 0 ? small : large, b = d > 0 ? large : small;
      compliance[at(r)] = b * u.gap / (a * u.force);
      gap[at(r)] = (b * p - w - p + root) * u.gap / a;
    }
  }
  /// The residual of the equations, in units.
  double left_over(std::span<const double> lambda, double t) const {
    double most = 0;
    for (int r : system_.plan().gap_rows) {
      const GapUnits u = units_of(system_, r, scale_);
      const double w = system_.phi()[at(r)] / u.gap, p = -lambda[at(r)] / u.force;
      most = std::max(most, std::abs(w + p - std::hypot(w - p, 2 * t)));
    }
    return most;
  }
  /// The multiplier that fits the present gap of row r: p - t^2 / p = -w.
  double fitting(int r, double t) const {
    const GapUnits u = units_of(system_, r, scale_);
    const double w = system_.phi()[at(r)] / u.gap, root = std::hypot(w, 2 * t);
    return -u.force * (w > 0 ? 2 * t * t / (root + w) : (root - w) / 2);
  }

 private:
  const StaticSystem& system_;
  GapUnits scale_;
};

// The larger side of the box that holds all bodies, at least the length scale.
double size_of(StaticSystem& system) {
  const Evaluator& evaluator = system.evaluator();
  Vec2<double> low = evaluator.ground_frame(0).origin(), high = low;
  for (int b = 1; b < system.plan().moving; ++b) {
    const Vec2<double> place = evaluator.ground_frame(b).origin();
    low = {std::min(low.x, place.x), std::min(low.y, place.y)};
    high = {std::max(high.x, place.x), std::max(high.y, place.y)};
  }
  return std::max({system.length(), high.x - low.x, high.y - low.y});
}

// Fills and factors the matrix, exact if allowed and if its inertia is that of a minimum; `exact` reports which.
bool factorize(StaticSystem& system, std::span<const double> lambda, bool may_be_exact, bool& exact) {
  exact = false;
  if (may_be_exact) {
    system.fill(lambda, Curvature::exact, 0);
    exact = system.factorize().ok() && system.matrix().negative_modes() == 0;
    if (exact) return true;
  }
  return factorize_convex(system, lambda);
}

/// One search: the smoothed equations for t that decreases.
class SmoothingSearch {
 public:
  SmoothingSearch(StaticSystem& system, std::span<double> q, std::span<double> lambda, ActiveSet& set,
                  const StaticGapOptions& options)
      : system_(system),
        q_(q),
        lambda_(lambda),
        set_(set),
        options_(options),
        force_(at(system.plan().columns)),
        gap_(at(system.plan().rows)),
        compliance_(at(system.plan().rows), 0.0) {}

  StaticOutcome run(double first_smoothing);

 private:
  enum class Point { sought, solved, too_far };
  bool begin(double first_smoothing);
  bool linearise();
  double step();
  Point judge(double factor) const;
  bool next_smoothing(Point point);
  bool make_step(const std::vector<double>& start);

  StaticSystem& system_;
  std::span<double> q_, lambda_;
  ActiveSet& set_;
  const StaticGapOptions& options_;
  StaticOutcome outcome_;
  std::vector<double> force_, gap_, compliance_, bent_;
  std::optional<SmoothedGaps> gaps_;
  double size_ = 1;  // of the mechanism, m
  double t_ = 0;
  // The last point that was solved, and the factor of t from there.
  KeptPlace before_;
  double t_before_ = 0, cooling_ = first_cooling;
  double reach_ = 1;  // the limit on steps, in sizes
  bool near_ = false, finished_ = false;
  int steps_ = 0;  // for the present t
};

// Multipliers of the equations from the mechanism without its gaps, forces of gaps from where they are.
bool SmoothingSearch::begin(double first_smoothing) {
  const Plan& plan = system_.plan();
  set_.closed.assign(plan.gap_rows.size(), 0);
  system_.close_gaps(set_.closed);
  system_.move_to(q_);
  std::fill(lambda_.begin(), lambda_.end(), 0.0);
  if (!(system_.has_springs() ? first_tensions(system_, lambda_) : first_multipliers(system_, lambda_))) return false;
  system_.use_gaps();
  system_.move_to(q_);
  size_ = size_of(system_);
  gaps_.emplace(system_, GapUnits{size_, typical_force(system_)});
  t_ = t_before_ = first_smoothing;
  for (int r : plan.gap_rows) lambda_[at(r)] = gaps_->fitting(r, t_);
  before_.keep(system_, q_, lambda_);
  return true;
}

// The matrix and right-hand sides of a step. False: it cannot be factored.
bool SmoothingSearch::linearise() {
  for (std::size_t r = 0; r < gap_.size(); ++r) gap_[r] = -system_.phi()[r];
  gaps_->linearise(lambda_, t_, compliance_, gap_);
  system_.matrix().set_compliance(compliance_);
  // A force below the one that fits its gap, or a pull, is temporary and must not enter K.
  bent_.assign(lambda_.begin(), lambda_.end());
  for (int r : system_.plan().gap_rows) bent_[at(r)] = std::min(bent_[at(r)], gaps_->fitting(r, t_));
  if (!factorize(system_, bent_, near_, outcome_.exact)) return false;
  for (std::size_t c = 0; c < force_.size(); ++c) force_[c] = -system_.gradient()[c];
  return true;
}

// Moves by a step; the part of it that was made.
double SmoothingSearch::step() {
  const StaticStep step = system_.solve(force_, gap_, near_ ? 1e-13 : 1e-9);
  const double change = system_.change_norm(step.change);
  // Where almost nothing resists only the direction of a step is useful: none is longer than the mechanism, but for
  // those on a long way.
  const double factor = std::isfinite(change) ? std::min(1.0, reach_ * size_ / (system_.length() * change)) : 0.0;
  reach_ = factor < 1 ? 2 * reach_ : 1;
  if (factor > 0) {
    system_.foresee(step.change, factor, newton_turn);
    system_.advance(q_, step.change, factor, newton_turn);
    for (std::size_t r = 0; r < lambda_.size(); ++r) lambda_[r] += factor * (step.lambda[r] - lambda_[r]);
    system_.move_to(q_);
  }
  outcome_.step = change;
  if (const IterationTrace* trace = system_.evaluator().trace)
    (*trace)("gaps", outcome_.iterations, gaps_->left_over(lambda_, t_), change);
  near_ = change <= exact_change;
  ++steps_;
  return factor;
}

SmoothingSearch::Point SmoothingSearch::judge(double factor) const {
  if (outcome_.step <= arrived_change && gaps_->left_over(lambda_, t_) <= arrived_part * t_) return Point::solved;
  const bool first = t_before_ == t_;
  return factor > 0 && steps_ < (first ? options_.first_steps : most_steps) ? Point::sought : Point::too_far;
}

// The next t, from the present point or from the last one that was solved. False: shorter steps of t do not help.
bool SmoothingSearch::next_smoothing(Point point) {
  const bool first = t_before_ == t_;
  if (point == Point::solved) {
    if (!first && steps_ <= quick_steps) cooling_ *= cooling_;
    before_.keep(system_, q_, lambda_);
    t_before_ = t_;
  } else {
    cooling_ = std::sqrt(cooling_);
    if (first || cooling_ > least_cooling) return false;
    before_.take_back(system_, q_, lambda_);
    system_.forget_lengths();
  }
  t_ = std::max(t_before_ * cooling_, 0.5 * last_smoothing);
  steps_ = 0;
  return true;
}

// False: the search ends.
bool SmoothingSearch::make_step(const std::vector<double>& start) {
  const auto ended = [&](StaticEnd end) {
    outcome_.end = end;
    return false;
  };
  if (!linearise()) return ended(StaticEnd::singular);
  const double factor = step();
  if (travel_between(start, q_).is_lost(size_)) return ended(StaticEnd::unbounded);
  const Point point = judge(factor);
  if (point == Point::sought) return true;
  if (point == Point::too_far || t_ > last_smoothing) return next_smoothing(point);
  const int smoothed = outcome_.iterations;
  system_.forget_lengths();
  outcome_ = finish_with_gaps(system_, q_, lambda_, set_, options_);
  outcome_.iterations += smoothed;
  finished_ = true;
  return false;
}

StaticOutcome SmoothingSearch::run(double first_smoothing) {
  const std::vector<double> start(q_.begin(), q_.end());
  if (!begin(first_smoothing)) {
    outcome_.end = StaticEnd::singular;
    return outcome_;
  }
  iterate(system_, options_.max_iterations, outcome_, [&] { return make_step(start); });
  if (finished_ || outcome_.end != StaticEnd::slow) return outcome_;
  std::vector<double> residual(force_.size());
  system_.residual(lambda_, residual);
  outcome_.residual = system_.force_norm(residual);
  return outcome_;
}

}  // namespace

StaticOutcome solve_with_gaps(StaticSystem& system, std::span<double> q, std::span<double> lambda, ActiveSet& set,
                              const StaticGapOptions& options) {
  const std::vector<double> start(q.begin(), q.end());
  const std::vector<CurvePlace> places = system.evaluator().curve_places();
  StaticOutcome outcome;
  int iterations = 0;
  for (const double t : first_smoothings) {
    std::copy(start.begin(), start.end(), q.begin());
    system.evaluator().go_to_curve_places(places);
    outcome = SmoothingSearch(system, q, lambda, set, options).run(t);
    system.forget_lengths();
    iterations += outcome.iterations;
    if (outcome.converged() || outcome.end == StaticEnd::unbounded || outcome.end == StaticEnd::cancelled) break;
  }
  outcome.iterations = iterations;
  return outcome;
}

}  // namespace catena
