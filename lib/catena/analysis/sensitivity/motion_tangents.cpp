#include "catena/analysis/sensitivity/motion_tangents.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/motion/stage_sums.hpp"
#include "catena/base/at.hpp"
#include "catena/base/design_scalar.hpp"

namespace catena {

MotionTangents::MotionTangents(const Evaluator& evaluator, std::vector<DesignMechanism*> groups)
    : plan_(evaluator.plan()),
      groups_(std::move(groups)),
      mechanism_(evaluator),
      n_(at(plan_.coordinates())),
      width_(groups_.size() * parameters_at_once) {
  for (const DesignMechanism* group : groups_) reached_.emplace_back(mechanism_, *group);
  accelerations_.assign(16, Rows(n_ * width_));
  stage_.resize(2 * n_ * width_);
  rows_.resize(at(plan_.rows) * width_);
  masses_.assign(n_, 0.0);
  for (int c = 0; c < plan_.coordinates(); ++c) {
    const bool moves = c < 3 * plan_.moving, is_unknown = moves && plan_.column[at(c)] >= 0;
    if (moves) all_.push_back(c);
    if (is_unknown)
      masses_[at(c)] = groups_.front()->mass(c).v;
    else
      no_unknowns_.push_back(c);
  }
}

void MotionTangents::add_parameters(double t, Side side, std::span<const double> lambda, std::span<const double> qdd,
                                    const TangentSums& sums) {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (reached_[g].asks_mechanism()) groups_[g]->set_time(t, side);
    mechanism_.add_parameters(*groups_[g], reached_[g], lambda, qdd, g * parameters_at_once, width_, sums);
  }
}

// Loads on bodies that do not move are left aside.
void MotionTangents::solve(EquationsOfMotion& equations, std::span<double> x) {
  equations.solve_motion_rows(x, rows_, width_, scratch_);
  for (const int c : no_unknowns_) std::fill_n(x.begin() + static_cast<std::ptrdiff_t>(at(c) * width_), width_, 0.0);
}

MotionTangents::Place MotionTangents::place_of(Stage& stage) {
  const std::size_t n = stage.y.size() / 2;
  return {.t = stage.t,
          .side = stage.side,
          .evaluator = stage.evaluator,
          .equations = stage.equations,
          .qd = std::span<const double>(stage.y).subspan(n),
          .qdd = std::span<const double>(stage.slope).subspan(n),
          .lambda = stage.lambda};
}

void MotionTangents::accelerations(const Place& place, const Rows& y, Rows& out) {
  mechanism_.set_motion(place.evaluator, place.qd, place.qdd, place.side);
  std::fill(out.begin(), out.end(), 0.0);
  std::fill(rows_.begin(), rows_.end(), 0.0);
  const TangentSums sums{.loads = out, .bends = rows_};
  const std::span<const double> all(y);
  mechanism_.add_along(place.evaluator, place.lambda, all.first(n_ * width_), all.subspan(n_ * width_), width_, sums);
  add_parameters(place.t, place.side, place.lambda, place.qdd, sums);
  solve(place.equations, out);
}

void MotionTangents::step(RecomputedSteps& steps, double h, const Rows& begin, Rows& end) {
  for (int s = 0; s < dormand_prince_8().stages; ++s) step_stage(s, place_of(steps.stage(s)), h, begin);
  finish_step(h, begin, end);
}

void MotionTangents::add_second_order(const StageWeights& of, double h, const Rows& begin, std::span<const int> which,
                                      Rows& y) const {
  SecondOrderSum sum{.q = begin.data(), .v = begin.data() + n_ * width_, .way = of.way * h, .terms = of.terms};
  for (std::size_t k = 0; k < of.terms; ++k) {
    sum.slope[k] = accelerations_[at(of.stage[k])].data();
    sum.of_q[k] = h * h * of.of_q[k];
    sum.of_v[k] = h * of.of_v[k];
  }
  add_weighted_rows(sum, which, width_, y.data(), y.data() + n_ * width_);
}

void MotionTangents::step_stage(int s, const Place& place, double h, const Rows& begin) {
  add_second_order(second_order_weights()[at(s)], h, begin, mechanism_.read_coordinates(), stage_);
  accelerations(place, stage_, accelerations_[at(s)]);
}

void MotionTangents::finish_step(double h, const Rows& begin, Rows& end) const {
  add_second_order(second_order_weights().back(), h, begin, all_, end);
}

void MotionTangents::find_largest(std::span<const double> rows, std::span<double> largest) const {
  for (const int c : all_) {
    const std::span<const double> row = rows.subspan(at(c) * width_, width_);
    for (std::size_t p = 0; p < width_; ++p) largest[p] = std::max(largest[p], std::abs(row[p]));
  }
}

// E3 is asked for where E5 alone is too large.
double MotionTangents::error(double h, const Rows& begin, const Rows& end, const DerivativeAim& aim) {
  const std::size_t part = n_ * width_;
  enum : std::size_t { of_q, of_qd, of_qdd, high_q, high_qd, low_q, low_qd, kinds };
  largest_.assign(kinds * width_, 0.0);
  const auto largest = [&](std::size_t kind) { return std::span(largest_).subspan(kind * width_, width_); };
  for (const Rows* y : {&begin, &end}) {
    find_largest(std::span(*y).first(part), largest(of_q));
    find_largest(std::span(*y).subspan(part), largest(of_qd));
  }
  for (const int s : {0, dormand_prince_8().stages - 1}) find_largest(accelerations_[at(s)], largest(of_qdd));
  const auto find = [&](const StageSum& weights, std::size_t kind) {
    sum_.resize(part);
    add_stages(
        {}, 1, weights, [this](int k) { return accelerations_[at(k)].data(); }, sum_);
    find_largest(sum_, largest(kind));
  };
  const auto relative = [&](std::size_t p, std::size_t q, std::size_t qd) {
    return relative_error(h, largest(q)[p], largest(qd)[p], {largest(of_q)[p], largest(of_qd)[p], largest(of_qdd)[p]},
                          aim.least(p));
  };
  find(embedded_error_high().of_q, high_q);
  find(embedded_error_high().of_qd, high_qd);
  double worst = 0;
  for (std::size_t p = 0; p < width_; ++p) worst = std::max(worst, relative(p, high_q, high_qd));
  if (worst <= aim.allowed()) return worst;
  find(embedded_error_low().of_q, low_q);
  find(embedded_error_low().of_qd, low_qd);
  worst = 0;
  for (std::size_t p = 0; p < width_; ++p)
    worst = std::max(worst, error_of_step(relative(p, high_q, high_qd), relative(p, low_q, low_qd)));
  return worst;
}

// The velocities of all stages are wanted here: those of the step first.
void MotionTangents::prepare_interpolant(RecomputedSteps& steps, double h, const Rows& begin, const Rows& end) {
  const Tableau& table = dormand_prince_8();
  const std::size_t part = n_ * width_;
  velocities_.resize(table.c.size());
  const auto find_velocities = [&](std::size_t s) {
    velocities_[s].resize(part);
    add_stages(
        std::span(begin).subspan(part), h, table.a[s], [this](int k) { return accelerations_[at(k)].data(); },
        velocities_[s]);
  };
  const auto last = at(table.stages);
  for (std::size_t s = 0; s < last; ++s) find_velocities(s);
  velocities_[last].assign(end.begin() + static_cast<std::ptrdiff_t>(part), end.end());
  accelerations(place_of(steps.stage(table.stages)), end, accelerations_[last]);
  for (std::size_t s = last + 1; s < table.c.size(); ++s) {
    find_velocities(s);
    add_stages(
        std::span(begin).first(part), h, table.a[s], [this](int k) { return velocities_[at(k)].data(); },
        std::span(stage_).first(part));
    std::copy(velocities_[s].begin(), velocities_[s].end(), stage_.begin() + static_cast<std::ptrdiff_t>(part));
    accelerations(place_of(steps.stage(static_cast<int>(s))), stage_, accelerations_[s]);
  }
}

void MotionTangents::interpolate(double part, double h, const Rows& begin, const Rows& end, Rows& y) const {
  const InterpolantWeights weights = interpolant_weights(part);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = begin[i] + weights.end * (end[i] - begin[i]);
  for (std::size_t s = 0; s < weights.slope.size(); ++s) {
    if (weights.slope[s] == 0) continue;
    add_times(std::span(y).first(n_ * width_), h * weights.slope[s], velocities_[s]);
    add_times(std::span(y).subspan(n_ * width_), h * weights.slope[s], accelerations_[s]);
  }
}

bool MotionTangents::project(Stage& stage, double t, Side side, Rows& y) {
  stage.t = t;
  stage.side = side;
  if (plan_.rows == 0) return true;
  if (!stage.equations.factorize(t, side, std::span<const double>(stage.y).first(n_)) || stage.equations.is_dependent())
    return false;
  project_with_factors(stage, y);
  return true;
}

void MotionTangents::project_with_factors(Stage& stage, Rows& y) {
  if (plan_.rows == 0) return;
  mechanism_.set_motion(stage.evaluator, std::span<const double>(stage.y).subspan(n_), {}, stage.side);
  const std::span<const double> all(y);
  for (const bool velocity : {false, true}) {
    std::fill(rows_.begin(), rows_.end(), 0.0);
    TangentSums sums;
    (velocity ? sums.rates : sums.phi) = rows_;
    if (velocity) {
      mechanism_.add_along(stage.evaluator, {}, all.first(n_ * width_), all.subspan(n_ * width_), width_, sums);
    }
    add_parameters(stage.t, stage.side, {}, {}, sums);
    const std::span<double> part = std::span(y).subspan(velocity ? n_ * width_ : 0, n_ * width_);
    for (std::size_t c = 0; c < n_; ++c) {
      for (std::size_t p = 0; p < width_; ++p) part[c * width_ + p] *= masses_[c];
    }
    solve(stage.equations, part);
  }
}

}  // namespace catena
