#include "catena/analysis/assemble.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/whole_turns.hpp"

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

constexpr int max_iterations = 200;
constexpr int max_approach_iterations = 60;
// A body may turn at most this far in one step: beyond it the linearisation says nothing, and linkages flip.
constexpr double largest_turn = 0.5;
// Residuals from here on overflow as soon as they are squared.
constexpr double largest_residual = 1e120;
constexpr double smallest_factor = 1e-4;

}  // namespace

Assembler::Assembler(Evaluator& evaluator)
    : evaluator_(evaluator),
      plan_(evaluator.plan()),
      scaling_(evaluator.plan(), evaluator.length_scale()),
      projector_(evaluator.shared_plan()) {
  const std::vector<double> radius = evaluator.attachment_radii();
  std::vector<double> inverse(at(plan_.columns));
  weights_.resize(at(plan_.columns));
  for (int c = 0; c < plan_.columns; ++c) {
    const int body = plan_.coordinate[at(c)] / 3, k = plan_.coordinate[at(c)] % 3;
    weights_[at(c)] = k == 2 ? radius[at(body)] * radius[at(body)] : 1;
    const auto& values = evaluator.model().bodies[at(plan_.model_body[at(body)])];
    const bool held = k == 0 ? values.hold_x : k == 1 ? values.hold_y : values.hold_angle;
    inverse[at(c)] = held ? 0 : 1 / weights_[at(c)];
  }
  projector_.set_inverse_weights(inverse);
  values_.resize(at(plan_.trash_slot()) + 1);
  evaluator_.start_jacobian(values_);
  phi_.resize(at(plan_.rows));
  lambda_.resize(at(plan_.rows));
  step_.resize(at(plan_.columns));
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
  for (int c = 0; c < plan_.columns; ++c) to[at(plan_.coordinate[at(c)])] += factor * step_[at(c)];
}

double Assembler::weighted_distance(std::span<const double> a, std::span<const double> b) const {
  double sum = 0;
  for (int c = 0; c < plan_.columns; ++c) {
    const double d = a[at(plan_.coordinate[at(c)])] - b[at(plan_.coordinate[at(c)])];
    sum += weights_[at(c)] * d * d;
  }
  return std::sqrt(sum);
}

bool Assembler::restore(std::span<double> q, double tolerance, AssemblyOutcome& outcome) {
  double now = merit(q);
  double damping = 0;
  for (int k = 0; k < max_iterations; ++k) {
    const double residual = scaling_.row_norm(phi_);
    outcome.residual = residual;
    if (!(residual > tolerance)) return std::isfinite(residual);
    evaluator_.jacobian(values_);
    if (!projector_.factorize(values_, evaluator_.counters, damping).ok()) {
      damping = std::max(10 * damping, 1e-8);
      if (damping > 1) return false;
      continue;
    }
    projector_.solve(phi_, step_, lambda_, evaluator_.counters);
    ++outcome.iterations;
    ++evaluator_.counters.iterations;
    double turn = 0;
    for (int c = 0; c < plan_.columns; ++c) {
      step_[at(c)] = -step_[at(c)];
      if (plan_.coordinate[at(c)] % 3 == 2) turn = std::max(turn, std::abs(step_[at(c)]));
    }
    double factor = turn > largest_turn ? largest_turn / turn : 1;
    double then = 0;
    for (; factor >= smallest_factor; factor /= 2) {
      advance(q, factor, trial_);
      then = merit(trial_);
      if (then < (1 - 1e-4 * factor) * now) break;
    }
    if (factor < smallest_factor) {
      // The direction is no use: dependent rows made it long. Shorten it where it is long, or give up.
      merit(q);
      damping = std::max(100 * damping, 1e-6);
      if (damping > 1e6) return false;
      continue;
    }
    damping = damping > 1e-8 ? damping / 10 : 0;
    std::copy(trial_.begin(), trial_.end(), q.begin());
    now = then;
    if (evaluator_.trace)
      (*evaluator_.trace)("assembly", outcome.iterations, scaling_.row_norm(phi_),
                          factor * scaling_.column_norm(step_));
  }
  return false;
}

void Assembler::approach_estimate(std::span<double> q, std::span<const double> estimate, double tolerance,
                                  AssemblyOutcome& outcome) {
  std::vector<double> candidate(q.begin(), q.end()), pull(step_.size()), out(phi_.size());
  double distance = weighted_distance(q, estimate);
  for (int k = 0; k < max_approach_iterations && distance > 0; ++k) {
    evaluator_.set_configuration(q);
    evaluator_.jacobian(values_);
    if (!projector_.factorize(values_, evaluator_.counters).ok()) return;
    for (int c = 0; c < plan_.columns; ++c) {
      const int i = plan_.coordinate[at(c)];
      pull[at(c)] = estimate[at(i)] - q[at(i)];
    }
    // The part of the pull that the constraints allow.
    std::fill(out.begin(), out.end(), 0.0);
    multiply_add(plan_.jacobian, std::span<const double>(values_).first(at(plan_.trash_slot())), pull, out);
    projector_.solve(out, step_, lambda_, evaluator_.counters);
    double size = 0;
    for (int c = 0; c < plan_.columns; ++c) {
      step_[at(c)] = pull[at(c)] - step_[at(c)];
      size += weights_[at(c)] * step_[at(c)] * step_[at(c)];
    }
    if (std::sqrt(size) <= 1e-10 * distance) return;
    const std::vector<double> direction = step_;
    bool closer = false;
    for (double factor = 1; factor > 1e-3 && !closer; factor /= 2) {
      step_ = direction;
      advance(q, factor, candidate);
      AssemblyOutcome trial;
      closer = restore(candidate, tolerance, trial) && weighted_distance(candidate, estimate) < distance * (1 - 1e-12);
      outcome.iterations += trial.iterations;
    }
    if (!closer) return;
    std::copy(candidate.begin(), candidate.end(), q.begin());
    distance = weighted_distance(q, estimate);
  }
}

int Assembler::element_out_of_range(std::span<const double> q) {
  merit(q);
  for (std::size_t row = 0; row < phi_.size(); ++row) {
    if (!(std::abs(phi_[row]) < largest_residual)) return plan_.row_element[row];
  }
  return -1;
}

AssemblyOutcome Assembler::assemble(std::span<double> q, double tolerance) {
  AssemblyOutcome outcome;
  if (plan_.rows == 0) return outcome;
  const std::vector<double> given(q.begin(), q.end());
  move_whole_turns(evaluator_, q);
  const std::vector<double> estimate(q.begin(), q.end());
  if (!restore(q, tolerance, outcome)) {
    if (const int element = element_out_of_range(estimate); element >= 0) {
      outcome.status = Status::not_assembled;
      outcome.message = fmt::format(
          "{} \"{}\" cannot be evaluated in the given configuration: places or lengths are too large for double "
          "precision",
          evaluator_.model().element_type(element), evaluator_.model().element_name(element));
      std::copy(given.begin(), given.end(), q.begin());
      return outcome;
    }
    // The best configuration found may differ a lot from what was given without being any use: keep what was given.
    const Conflict conflict = find_conflict(evaluator_, projector_, q);
    outcome.misfits = conflict.unmet;
    outcome.status = Status::not_assembled;
    outcome.message =
        fmt::format("the constraints cannot all be met from the given configuration; nearest: {}; likely cause: {}",
                    describe_misfits(evaluator_.model(), outcome.misfits),
                    describe_held(evaluator_.model()) + describe_cause(evaluator_.model(), conflict));
    std::copy(given.begin(), given.end(), q.begin());
    evaluator_.set_configuration(q);
    return outcome;
  }
  if (weighted_distance(q, estimate) > 0) {
    approach_estimate(q, estimate, tolerance, outcome);
  }
  merit(q);
  outcome.residual = scaling_.row_norm(phi_);
  for (int c = 0; c < plan_.columns; ++c) {
    const int i = plan_.coordinate[at(c)];
    double& largest = i % 3 == 2 ? outcome.turned : outcome.shifted;
    largest = std::max(largest, std::abs(q[at(i)] - estimate[at(i)]));
  }
  outcome.moved = weighted_distance(q, estimate) / std::sqrt(std::max(1, plan_.moving));
  return outcome;
}

}  // namespace catena
