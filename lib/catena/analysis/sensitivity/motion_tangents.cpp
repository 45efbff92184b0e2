#include "catena/analysis/sensitivity/motion_tangents.hpp"

#include <algorithm>

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
  slopes_.assign(16, Rows(2 * n_ * width_));
  stage_.resize(2 * n_ * width_);
  loads_.resize(n_ * width_);
  rows_.resize(at(plan_.rows) * width_);
  lambda_ = rows_;
  masses_.assign(n_, 0.0);
  for (auto* v : {&f_, &x_}) v->resize(n_);
  for (auto* v : {&b_, &mu_}) v->resize(at(plan_.rows));
  for (int c = 0; c < 3 * plan_.moving; ++c) {
    if (plan_.column[at(c)] >= 0) masses_[at(c)] = groups_.front()->mass(c).v;
  }
}

void MotionTangents::add_parameters(double t, Side side, std::span<const double> lambda, std::span<const double> qdd,
                                    const TangentSums& sums) {
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (reached_[g].asks_mechanism()) groups_[g]->set_time(t, side);
    mechanism_.add_parameters(*groups_[g], reached_[g], lambda, qdd, g * parameters_at_once, width_, sums);
  }
}

void MotionTangents::solve(EquationsOfMotion& equations, const Rows& loads, const Rows& rows, double* x) {
  for (std::size_t first = 0; first < width_; first += parameters_at_once) {
    for (std::size_t c = 0; c < n_; ++c) f_[c] = Lanes::load(loads.data() + c * width_ + first);
    for (std::size_t r = 0; r < b_.size(); ++r) b_[r] = -Lanes::load(rows.data() + r * width_ + first);
    equations.solve_motion(f_, b_, x_, mu_, scratch_);
    for (const int c : plan_.coordinate) x_[at(c)].store(x + at(c) * width_ + first);
    for (std::size_t r = 0; r < mu_.size(); ++r) mu_[r].store(lambda_.data() + r * width_ + first);
  }
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

void MotionTangents::slope(const Place& place, const Rows& y, Rows& slope) {
  mechanism_.set_motion(place.evaluator, place.qd, place.qdd, place.side);
  std::fill(loads_.begin(), loads_.end(), 0.0);
  std::fill(rows_.begin(), rows_.end(), 0.0);
  const TangentSums sums{.loads = loads_, .bends = rows_};
  const std::span<const double> all(y);
  mechanism_.add_along(place.evaluator, place.lambda, all.first(n_ * width_), all.subspan(n_ * width_), width_, sums);
  add_parameters(place.t, place.side, place.lambda, place.qdd, sums);
  std::copy(y.begin() + static_cast<std::ptrdiff_t>(n_ * width_), y.end(), slope.begin());
  solve(place.equations, loads_, rows_, slope.data() + n_ * width_);
}

void MotionTangents::step(RecomputedSteps& steps, double h, const Rows& begin, Rows& end) {
  for (int s = 0; s < dormand_prince_8().stages; ++s) step_stage(s, place_of(steps.stage(s)), h, begin);
  finish_step(h, begin, end);
}

void MotionTangents::step_stage(int s, const Place& place, double h, const Rows& begin) {
  add_stages(
      begin, h, dormand_prince_8().a[at(s)], [this](int stage) { return slopes_[at(stage)].data(); }, stage_);
  slope(place, stage_, slopes_[at(s)]);
}

void MotionTangents::finish_step(double h, const Rows& begin, Rows& end) const {
  add_stages(
      begin, h, dormand_prince_8().b, [this](int stage) { return slopes_[at(stage)].data(); }, end);
}

void MotionTangents::prepare_interpolant(RecomputedSteps& steps, double h, const Rows& begin, const Rows& end) {
  const Tableau& table = dormand_prince_8();
  slope(place_of(steps.stage(table.stages)), end, slopes_[at(table.stages)]);
  for (int s = table.stages + 1; s < static_cast<int>(table.c.size()); ++s) {
    add_stages(
        begin, h, table.a[at(s)], [this](int stage) { return slopes_[at(stage)].data(); }, stage_);
    slope(place_of(steps.stage(s)), stage_, slopes_[at(s)]);
  }
}

void MotionTangents::interpolate(double part, double h, const Rows& begin, const Rows& end, Rows& y) const {
  const InterpolantWeights weights = interpolant_weights(part);
  for (std::size_t i = 0; i < y.size(); ++i) y[i] = begin[i] + weights.end * (end[i] - begin[i]);
  for (std::size_t s = 0; s < weights.slope.size(); ++s) {
    if (weights.slope[s] != 0) add_times(y, h * weights.slope[s], slopes_[s]);
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
    double* part = y.data() + (velocity ? n_ * width_ : 0);
    for (std::size_t c = 0; c < n_; ++c) {
      for (std::size_t p = 0; p < width_; ++p) loads_[c * width_ + p] = masses_[c] * part[c * width_ + p];
    }
    solve(stage.equations, loads_, rows_, part);
  }
}

}  // namespace catena
