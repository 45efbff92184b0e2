// RungeKutta::advance: the size of steps, and the measures near singular positions.
#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/dynamics/integrators/runge_kutta.hpp"

namespace catena {
namespace {

constexpr double safety = 0.9;
constexpr double largest_growth = 2.5, largest_cut = 0.2;
// Where no step across a singular position is good enough, the best is taken if its error is below this.
constexpr double largest_crossing_error = 300;
constexpr double other_steps[] = {0.8, 0.6, 1.15, 0.4, 0.9, 1.3};  // what is tried instead of h ...
// ... and before them, near a singular position, steps that have it in the middle of the widest gaps between stages of
// order 8, 0.333 ... 0.6 and 0.651 ... 0.857 of a step, if they are not very different from h and their error, which
// grows with the eighth power, may stay below what is taken at last.
constexpr double gaps[] = {0.467, 0.754};
constexpr double least_aimed = 0.3, largest_aimed = 3;
// A step whose smallest pivot ratio is this part of the one at its end has the singular position within it.
constexpr double passed = 0.3;
// Pivot ratios below which all methods project, and above which they cease to.
constexpr double nearly_singular = 0.1, regular = 0.2;
// A passage may lie within a step of which a pivot ratio is this small, compared with those at both ends, or of which
// one end is, compared with the other.
constexpr double dip_inside = 0.35, dip_at_end = 0.02;
// The first step that is tried where one had left its branch.
constexpr double shortened = 0.125;
// Steps, with those that are rejected, in which a motion must have turned into the other direction: twice as many as
// parallel cranks off by 1e-10 need at a tolerance of 1e-10.
constexpr int most_tries_of_turn = 500;
constexpr int rejections_before_low_order = 8, low_order_run = 30;
constexpr int most_rejections = 100;

}  // namespace

// Chooses the next step after a rejection; order 5 is used when order 8 fails repeatedly.
void RungeKutta::reject(double h) {
  ++motion_.equations().evaluator().counters.rejected;
  h_ = h;
  if (++rejections_ % rejections_before_low_order == 0 && tableau().order == 8 && options_.may_lower_order) {
    low_order_left_ = low_order_run;
  }
}

// Another step size in place of h, so that neither its end nor a stage lies beside a singular position.
bool RungeKutta::detour(double h, double error) {
  static_assert(std::size(gaps) + std::size(other_steps) <= most_detours);
  if (detours_ == 0) {
    detour_steps_.clear();
    // Pivots fall with the square of the distance.
    const double before = std::sqrt(start_ratio_), after = std::sqrt(pivot_ratio()) * (passes() ? 1 : -1);
    const double largest = std::min(largest_aimed, std::pow(largest_crossing_error / error, 0.125));
    for (const double gap : gaps) {
      const double part = before / ((before + after) * gap);
      if (part > least_aimed && part < largest) detour_steps_.push_back(part * h);
    }
    for (const double part : other_steps) detour_steps_.push_back(part * h);
  }
  if (detours_ == static_cast<int>(detour_steps_.size())) return false;
  ++motion_.equations().evaluator().counters.rejected;
  h_ = detour_steps_[static_cast<std::size_t>(detours_++)];
  return true;
}

bool RungeKutta::passes() const { return smallest_stage_ratio_ < passed * pivot_ratio(); }

void RungeKutta::repeat_with_projected_stages(double h) {
  projecting_stages_ = true;
  best_error_ = std::numeric_limits<double>::infinity();
  best_step_ = 0;
  best_passes_ = taking_best_ = false;
  h_ = h;
}

// Repeats a step of size h that failed near a singular position: with projected stages; with other sizes; at last takes
// the best of those if it is acceptable. One that has the position behind it is better than all that only come nearer:
// from there the passage would be worse. False: none succeeds, h_ is unchanged. `error` is without that of rounding.
bool RungeKutta::try_crossing(double h, double error, double rounding) {
  if (!projecting_stages_) {
    repeat_with_projected_stages(h);
    return true;
  }
  const bool better = passes() == best_passes_ ? std::max(error, rounding) < best_error_ : passes();
  if (error < largest_crossing_error && better) {
    best_error_ = std::max(error, rounding);
    best_step_ = h;
    best_passes_ = passes();
  }
  if (detour(h, error)) return true;
  if (best_step_ == 0) return false;
  h_ = best_step_;
  // Small masses may have been weighed anew since, and its rounding is another one by the new ratios of pivots.
  accepted_error_ = largest_crossing_error;
  taking_best_ = true;
  best_step_ = 0;
  return true;
}

// Whether the step of size h, which passes beside a singular position, has ended on another branch. The passage is
// where the sines, roots of the pivot ratios, would be zero if they changed in proportion to time.
bool RungeKutta::leaves_branch(double h) {
  EquationsOfMotion& equations = motion_.equations();
  const double end = pivot_ratio(), least = std::min(start_ratio_, end), most = std::max(start_ratio_, end);
  if (!(std::min(smallest_stage_ratio_, least) < nearly_singular)) return false;
  if (!(smallest_stage_ratio_ < dip_inside * least) && !(least < dip_at_end * most)) return false;
  if (!branches_) return false;
  const double before = std::sqrt(start_ratio_), s = before / (before + std::sqrt(end));
  const std::span<const double> y(y_), next(y_new_);
  const std::span<const double> q0 = motion_.q(y), v0 = motion_.qd(y), q1 = motion_.q(next), v1 = motion_.qd(next);
  y_stage_.assign(y_.size(), 0.0);
  const std::span<double> middle = motion_.q(std::span(y_stage_));
  for (std::size_t k = 0; k < middle.size(); ++k) {
    const double r = 1 - s;
    middle[k] = r * r * ((1 + 2 * s) * q0[k] + s * h * v0[k]) + s * s * ((3 - 2 * s) * q1[k] - r * h * v1[k]);
  }
  Evaluator& evaluator = equations.evaluator();
  const std::vector<CurvePlace> places = evaluator.curve_places();
  const bool left = branches_->leaves(equations, q0, q1, middle);
  evaluator.go_to_curve_places(places);
  evaluator.set_configuration(q1);
  return left;
}

// Repeats a step of size h that has left its branch with steps that follow the branch round its corner.
void RungeKutta::turn(double h) {
  if (!turning_) {
    ++turns_;
    tries_of_turn_ = 0;
    step_that_left_ = h;
  }
  turning_ = true;
  reject(shortened * h);
}

// Counts a try of a step in a turn. Where a turn takes too many, its corner is one that rounding does not let steps
// follow: the passage is then crossed as one where branches cross, and judged no more.
bool RungeKutta::gives_up_turn() {
  if (!turning_ || ++tries_of_turn_ <= most_tries_of_turn) return false;
  turning_ = false;
  crosses_anyway_ = true;
  --turns_;
  ++turns_given_up_;
  return true;
}

bool RungeKutta::advance(double limit) {
  const bool fixed = options_.fixed_step > 0;
  const double smallest = scale_.smallest_step(t_);
  double proposed = fixed ? options_.fixed_step : h_;
  detours_ = 0;
  projecting_stages_ = taking_best_ = false;
  accepted_error_ = 1;
  rejections_ = 0;
  // Short steps would end again and again beside a singular position.
  long_steps_ = !fixed && start_ratio_ < nearly_singular;
  // A choice of coordinates made at a singular position serves nowhere.
  if (!projects() && start_ratio_ < nearly_singular && !begin_projection()) return false;
  if (!follow_motion()) return false;
  std::copy(slope_.begin(), slope_.end(), stage_[0].begin());
  motion_.equations().evaluator().take_turns(motion_.q(std::span(y_)));
  interpolant_ready_ = false;
  h_ = proposed;
  while (true) {
    motion_.equations().evaluator().go_to_curve_places(curve_places_);
    if (gives_up_turn()) {
      h_ = proposed = step_that_left_;
      rejections_ = 0;
    }
    const double remaining = limit - t_;
    const bool lands = h_ * (fixed ? 1 + 1e-9 : 1.01) >= remaining;
    // Two equal steps instead of a long one and a tiny one.
    double h = lands ? remaining : h_;
    if (!lands && !fixed && detours_ == 0 && 2 * h > remaining) h = remaining / 2;
    if ((h < smallest && !lands) || rejections_ > most_rejections) return false;
    t_new_ = lands ? limit : t_ + h;
    if (!evaluate_stages(h)) {
      culprit_ = -1;
      if (fixed) return false;
      reject(h / 4);
      continue;
    }
    if (!projects() && smallest_stage_ratio_ < nearly_singular) {
      if (!begin_projection()) return false;
      continue;
    }
    double error = fixed ? 0 : error_size(h);
    if (!(error <= 1) && std::isfinite(error)) error = compared_with_end(h, error);
    bool factored = false;
    if (!(error <= 1) && std::isfinite(error) && projects()) {
      factored = factorize_new_point();
      if (factored) error = filtered_error(h, error);
    }
    if (!fixed && motion_.works() > 0) error = std::max(error, error_of_work(h));
    if (!std::isfinite(error)) error = 1e10;
    const double growth =
        std::clamp(safety * std::pow(std::max(error, 1e-10), -1.0 / tableau().order), largest_cut, largest_growth);
    const double rounding = projecting_stages_ && !fixed && dips() ? rounding_of_crossing(h) : 0;
    const bool accurate = std::max(error, taking_best_ ? 0 : rounding) <= accepted_error_;
    if (accurate && !fixed && !projecting_stages_ && projects() && dips()) {
      // Errors of stages across the constraints affect each other here, and the estimate does not contain all of it.
      repeat_with_projected_stages(h);
      continue;
    }
    if (!accurate) {
      // Near a singular position a shorter step would only end closer to it.
      if (projects() && dips() && try_crossing(h, error, rounding)) continue;
      reject(h * std::min(growth, 1.0));
      continue;
    }
    step_error_ = std::max(error, 1.0);
    if (!factored && !factorize_new_point()) {
      if (fixed) return false;
      reject(h / 4);
      continue;
    }
    const double ratio = pivot_ratio();
    if (ratio > 10 * singular_ratio_) passing_singular_ = false;
    if (ratio < singular_ratio_ && !passing_singular_ && !turning_ && !lands && !fixed && projects()) {
      if (detour(h, error)) continue;
      passing_singular_ = true;
    }
    if (!finish_step()) {
      culprit_ = -1;
      if (fixed) return false;
      reject(h / 4);
      continue;
    }
    if (projects() && !fixed && !crosses_anyway_ && leaves_branch(h)) {
      turn(h);
      continue;
    }
    accept(growth, std::max(proposed, h));
    return true;
  }
}

void RungeKutta::accept(double growth, double proposed) {
  const double h = t_new_ - t_;
  ++motion_.equations().evaluator().counters.steps;
  by_ends_ = tableau().order == 5;
  if (low_order_left_ > 0) {
    --low_order_left_;
    ++low_order_steps_;
  }
  if (crossing_) {
    ++projected_steps_;
    crossing_ = pivot_ratio() < regular;
    if (partitions()) partition_->forget();
  }
  t_before_ = t_;
  t_ = t_new_;
  y_before_.swap(y_);
  y_.swap(y_new_);
  slope_.swap(slope_new_);
  motion_.equations().evaluator().curve_places(curve_places_);
  observe_ratio();
  observe_rates();
  if (start_ratio_ > regular) turning_ = crosses_anyway_ = false;
  // A step that was shortened by a limit does not change the usual step.
  h_ = rejections_ > 0 ? h * std::min(growth, 1.0) : std::max(h * growth, h < proposed ? proposed : 0.0);
}

}  // namespace catena
