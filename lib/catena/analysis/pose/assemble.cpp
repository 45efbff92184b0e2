#include "catena/analysis/pose/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "catena/analysis/pose/whole_turns.hpp"
#include "catena/analysis/run/far_places.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Steps turn bodies by half a radian at most: a hundred radians of way.
constexpr int max_iterations = 200;
// Steps that turn bodies by more than this multiple are long along nearly dependent combinations of equations. Scaling
// the whole step would leave the other equations unmet, so damping shortens only these parts.
constexpr double far_too_long = 4;
/// Start of a repeated search: near the end of the last one, or near the estimate, every coordinate displaced by at
/// most `displacement` (rad, attachment distances).
struct Start {
  bool from_estimate;
  double displacement;
};
// The first ones leave a symmetric sketch and hardly change which assembly is nearest; the others are for sketches that
// lead to a local minimum of the misfit: of 96 six-bars drawn in one line four did. The last one is repeated.
constexpr Start starts[] = {{false, 1e-3}, {false, 0.03}, {false, 0.3}, {false, 1.0}, {true, 0.3},
                            {true, 1.0},   {true, 1.0},   {true, 2.0},  {true, 2.0},  {true, 3.0}};
// One of some 2500 six-bars needed fourteen.
constexpr std::size_t most_starts = 24;
// Beside a place where branches cross or fold, Newton's steps halve the distance to it, so that residuals fall to a
// quarter each, and end a square root of the tolerance away from it, where all equations look independent. Searches
// that end regularly gain digits at every step; a few such quarters in a row, between these ratios, are none of theirs.
constexpr double slow_least = 0.1, slow_most = 0.6;
constexpr int most_slow_steps = 4;
// Below this misfit, so near to the crossing, equations are regularised: steps are slower, or faster by chance.
constexpr double least_told = 1e-9;
// Searches that end regularly take fewer iterations; a longer one may have come beside a crossing on its way, too.
constexpr int long_search = 20;
// No further start is tried after so many iterations times equations: a factorization costs a microsecond a row.
constexpr double most_work = 4e6;

}  // namespace

Assembler::Assembler(Evaluator& evaluator)
    : evaluator_(evaluator), plan_(evaluator.plan()), scaling_(evaluator.plan(), evaluator.length_scale()) {
  const std::vector<double> radius = evaluator.attachment_radii();
  weights_.resize(at(3 * plan_.moving));
  reach_.resize(weights_.size());
  for (const int c : plan_.coordinate) {
    const int body = c / 3, k = c % 3;
    const auto& values = evaluator.model().bodies[at(plan_.model_body[at(body)])];
    if (k == 0 ? values.hold_x : k == 1 ? values.hold_y : values.hold_angle) continue;
    weights_[at(c)] = k == 2 ? radius[at(body)] * radius[at(body)] : 1;
    reach_[at(c)] = k == 2 ? 1 : radius[at(body)];
  }
  values_.resize(at(plan_.trash_slot()) + 1);
  evaluator_.start_jacobian(values_);
  phi_.resize(at(plan_.rows));
  lambda_.resize(at(plan_.rows));
  step_.resize(weights_.size());
  trial_.resize(at(plan_.coordinates()));
}

// Half the sum of squared residuals, lengths in length scales.
double Assembler::merit(std::span<const double> q) {
  evaluator_.set_configuration(q);
  evaluator_.phi(phi_);
  double sum = 0;
  for (std::size_t r = 0; r < phi_.size(); ++r) {
    const double size = phi_[r] * scaling_.row_unit(static_cast<int>(r));
    sum += size * size;
  }
  return sum / 2;
}

void Assembler::advance(std::span<const double> from, double factor, std::span<double> to) const {
  std::copy(from.begin(), from.end(), to.begin());
  for (std::size_t c = 0; c < step_.size(); ++c) to[c] += factor * step_[c];
}

double Assembler::weighted_distance(std::span<const double> a, std::span<const double> b) const {
  double sum = 0;
  for (std::size_t c = 0; c < weights_.size(); ++c) sum += weights_[c] * (a[c] - b[c]) * (a[c] - b[c]);
  return std::sqrt(sum);
}

double Assembler::extent(std::span<const double> q) const { return scaling_.coordinate_norm(plan_, q); }

bool Assembler::restore(std::span<double> q, double tolerance, int most_iterations, AssemblyOutcome& outcome) {
  double now = merit(q);
  double damping = 0;
  int slow_steps = 0;
  for (int k = 0; k < most_iterations; ++k) {
    const double residual = scaling_.row_norm(phi_), ratio = residual / outcome.residual;
    if (k == 0 || (!(ratio > slow_least) && residual > least_told)) slow_steps = 0;
    if (k > 0 && ratio > slow_least && ratio < slow_most) ++slow_steps;
    ends_beside_crossing_ = slow_steps >= most_slow_steps;
    outcome.residual = residual;
    // Coordinates of a body that has moved by many length scales are rounded.
    if (!(residual > std::max(tolerance, attainable_digits * extent(q)))) return std::isfinite(residual);
    evaluator_.jacobian(values_);
    if (!(damping > 0 ? solver_->factorize_damped(values_, damping, evaluator_.counters)
                      : solver_->factorize(values_, evaluator_.counters))) {
      damping = std::max(10 * damping, 1e-8);
      if (damping > 1) break;
      continue;
    }
    solver_->solve(phi_, step_, lambda_, evaluator_.counters);
    ++outcome.iterations;
    ++evaluator_.counters.iterations;
    double turn = 0;
    for (double& move : step_) move = -move;
    for (std::size_t c = 2; c < step_.size(); c += 3) turn = std::max(turn, std::abs(step_[c]));
    if (turn > far_too_long * thresholds::largest_turn && damping < 1) {
      damping = std::max(10 * damping, 1e-8);
      continue;
    }
    double factor = turn > thresholds::largest_turn ? thresholds::largest_turn / turn : 1;
    double then = 0;
    curve_places_ = evaluator_.curve_places();
    for (; factor >= thresholds::smallest_factor; factor /= 2) {
      // A trial that was rejected may have found contacts far from here.
      evaluator_.go_to_curve_places(curve_places_);
      advance(q, factor, trial_);
      then = merit(trial_);
      if (then < (1 - 1e-4 * factor) * now) break;
    }
    if (factor < thresholds::smallest_factor) {
      // The direction fails because nearly dependent equations made it long: damping shortens it, or the search ends.
      evaluator_.go_to_curve_places(curve_places_);
      merit(q);
      damping = std::max(100 * damping, 1e-6);
      if (damping > 1e6) break;
      continue;
    }
    damping = damping > 1e-8 ? damping / 10 : 0;
    std::copy(trial_.begin(), trial_.end(), q.begin());
    now = then;
    if (evaluator_.trace)
      (*evaluator_.trace)("assembly", outcome.iterations, scaling_.row_norm(phi_), factor * extent(step_));
  }
  return outcome.residual <= rounding_of_far_places(evaluator_);
}

// The misfit of a sketch drawn in one line, or as its own mirror image, has no slope across that symmetry: steps stay
// within it and end where the misfit is least there, a saddle. So the search is repeated from near it, every coordinate
// displaced by a different amount, the same amounts every time.
bool Assembler::restore_from_beside(std::span<double> q, std::span<const double> estimate, double tolerance,
                                    bool far_too, AssemblyOutcome& outcome) {
  const std::vector<double> saddle(q.begin(), q.end());
  std::mt19937_64 random(1);
  const std::vector<CurvePlace> places = evaluator_.curve_places();
  std::vector<double> beside_crossing;
  std::vector<CurvePlace> places_beside;
  for (std::size_t k = 0; k < most_starts; ++k) {
    const Start& start = starts[std::min(k, std::size(starts) - 1)];
    if (start.from_estimate && !far_too) break;
    evaluator_.go_to_curve_places(places);
    std::copy_n(start.from_estimate ? estimate.begin() : std::span<const double>(saddle).begin(), q.size(), q.begin());
    for (const int c : plan_.coordinate) {
      const double number = 2 * std::ldexp(static_cast<double>(random() >> 11), -53) - 1;
      q[at(c)] += start.displacement * number * reach_[at(c)];
    }
    if (restore(q, tolerance, max_iterations, outcome)) {
      if (!ends_beside_crossing_) return true;
      if (beside_crossing.empty()) {
        beside_crossing.assign(q.begin(), q.end());
        places_beside = evaluator_.curve_places();
      }
    }
    if (static_cast<double>(outcome.iterations) * plan_.rows > most_work) break;
  }
  std::copy(beside_crossing.begin(), beside_crossing.end(), q.begin());
  evaluator_.go_to_curve_places(beside_crossing.empty() ? places : places_beside);
  ends_beside_crossing_ = true;
  return !beside_crossing.empty();
}

void Assembler::give_up(std::span<double> q, std::span<const double> given, std::span<const double> estimate,
                        AssemblyOutcome& outcome) {
  if (const int element = element_out_of_range(estimate); element >= 0) {
    outcome.status = Status::not_assembled;
    outcome.message = fmt::format(
        "{} \"{}\" cannot be evaluated in the given configuration: places or lengths are too large for double "
        "precision",
        evaluator_.model().element_type(element), evaluator_.model().element_name(element));
    std::copy(given.begin(), given.end(), q.begin());
    return;
  }
  // The best configuration found may differ a lot from the given one without being of use: keep the given one.
  const Conflict conflict = find_conflict(evaluator_, *solver_, q);
  outcome.misfits = conflict.unmet;
  outcome.status = Status::not_assembled;
  outcome.message =
      fmt::format("the constraints cannot all be met from the given configuration; nearest: {}; likely cause: {}",
                  describe_misfits(evaluator_.model(), outcome.misfits),
                  describe_held(evaluator_.model()) + describe_cause(evaluator_.model(), conflict));
  std::copy(given.begin(), given.end(), q.begin());
  evaluator_.set_configuration(q);
}

AssemblyOutcome Assembler::assemble(std::span<double> q, double tolerance) {
  AssemblyOutcome outcome;
  if (plan_.rows == 0) return outcome;
  const std::vector<double> given(q.begin(), q.end());
  move_whole_turns(evaluator_, q);
  const std::vector<double> estimate(q.begin(), q.end());
  merit(q);
  if (!solver_ && !(scaling_.row_norm(phi_) <= tolerance)) {
    solver_.emplace(evaluator_.shared_plan());
    solver_->set_metric(weights_);
  }
  bool met = restore(q, tolerance, max_iterations, outcome);
  if (!met) {
    // If all repetitions fail, the conflicting constraints are determined from the end of the first search.
    std::vector<double> beside(q.begin(), q.end());
    const double residual = outcome.residual;
    met = restore_from_beside(beside, estimate, tolerance, true, outcome);
    if (met) {
      std::copy(beside.begin(), beside.end(), q.begin());
    } else {
      outcome.residual = residual;
    }
  } else if (ends_beside_crossing_) {
    const std::vector<CurvePlace> places = evaluator_.curve_places();
    std::vector<double> beside(q.begin(), q.end());
    if (restore_from_beside(beside, estimate, tolerance, false, outcome) && !ends_beside_crossing_)
      std::copy(beside.begin(), beside.end(), q.begin());
    else
      evaluator_.go_to_curve_places(places);
  }
  if (!met) {
    give_up(q, given, estimate, outcome);
    return outcome;
  }
  if (weighted_distance(q, estimate) > 0) approach_estimate(q, estimate, tolerance, outcome);
  if (outcome.iterations > long_search) land_on_crossing(q);
  merit(q);
  outcome.residual = scaling_.row_norm(phi_);
  for (const int i : plan_.coordinate) {
    double& largest = i % 3 == 2 ? outcome.turned : outcome.shifted;
    largest = std::max(largest, std::abs(q[at(i)] - estimate[at(i)]));
  }
  outcome.moved = weighted_distance(q, estimate) / std::sqrt(std::max(1, plan_.moving));
  return outcome;
}

}  // namespace catena
