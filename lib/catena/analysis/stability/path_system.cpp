#include "catena/analysis/stability/path_system.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/modes_operator.hpp"
#include "catena/analysis/statics/solvers/static_settling.hpp"
#include "catena/assembly/length_scale.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Steps grow only after four iterations and fewer (path_march.cpp): one that needs twelve is too long.
constexpr int most_iterations = 12;
// Accepted where rounding prevents a smaller residual.
constexpr double nearly_solved = 1e-9;
// Steps larger than this have left the path: parts of the mechanism's extent, or rad.
constexpr double astray = 3;
// A system without a length of its own takes one where it is placed first.
StaticSystem& with_length(StaticSystem& system) {
  if (lacks_length(system.evaluator())) system.move_to(system.evaluator().given_configuration());
  return system;
}

}  // namespace

PathSystem::PathSystem(StaticSystem& system, ModelAt model_at, double p, double scale)
    : system_(with_length(system)),
      evaluator_(system.evaluator()),
      plan_(system.plan()),
      model_at_(std::move(model_at)),
      p_(p),
      scale_(scale),
      time_(evaluator_.time()),
      weight_(length_weights(system)) {
  Vec2<double> mean{};
  for (int b = 0; b < plan_.moving; ++b) {
    first_origin_.push_back(evaluator_.origin(b));
    mean += (1.0 / plan_.moving) * evaluator_.origin(b);
  }
  double square = 0;
  for (const Vec2<double>& origin : first_origin_) square += squared_norm(origin - mean) / plan_.moving;
  extent_ = std::max(system.length(), std::sqrt(square));
  for (int c = 0; c < plan_.columns; ++c) {
    const double length = plan_.coordinate[at(c)] % 3 == 2 ? system.length() : extent_;
    weight_[at(c)] /= plan_.moving * length * length;
  }
  placed_.assign(at(plan_.coordinates()), 0.0);
  given_.resize(at(plan_.columns + plan_.rows));
  if (!evaluator_.conservative()) {
    system_.move_to(evaluator_.given_configuration());
    tangent_.emplace(system_);
    spectrum_tangent_.emplace(system_);
  }
  for (auto* vector : {&correction_, &newton_, &along_, &derivative_, &side_, &here_}) vector->resize(given_.size());
}

bool PathSystem::set_parameter(double p) {
  if (p == p_) return true;
  const auto known =
      std::find_if(models_.begin(), models_.end(), [&](const auto& entry) { return entry.second && entry.first == p; });
  std::shared_ptr<const Model> model = known != models_.end() ? known->second : model_at_(p);
  if (!model) return false;
  if (known == models_.end()) {
    models_[next_model_] = {p, model};
    next_model_ = (next_model_ + 1) % models_.size();
  }
  evaluator_.set_model(*model);
  model_ = std::move(model);
  evaluator_.set_time(time_);
  system_.take_over_model();
  p_ = p;
  return true;
}

bool PathSystem::move_to(const PathPoint& x) {
  if (!set_parameter(x.p)) return false;
  // Bodies that do not move keep the pose of their model.
  const std::vector<double> given = evaluator_.given_configuration();
  std::copy(given.begin() + 3 * plan_.moving, given.end(), placed_.begin() + 3 * plan_.moving);
  for (int b = 0; b < plan_.moving; ++b) {
    const Vec2<double> shift = first_origin_[at(b)] - evaluator_.origin(b);
    placed_[at(3 * b)] = x.q[at(3 * b)] + shift.x;
    placed_[at(3 * b + 1)] = x.q[at(3 * b + 1)] + shift.y;
    placed_[at(3 * b + 2)] = x.q[at(3 * b + 2)];
  }
  system_.move_to(placed_);
  return true;
}

bool PathSystem::factorize(const PathPoint& x) {
  if (!move_to(x)) return false;
  if (is_circulatory()) factored_ = x;
  return factorize_here(x.lambda, 0);
}

bool PathSystem::factorize_here(std::span<const double> lambda, double shift) {
  system_.fill(lambda, Curvature::exact, shift);
  if (!is_circulatory()) return system_.factorize().ok();
  tangent_->fill(lambda, shift);
  const double stiffness = std::max(tangent_->largest_stiffness(), system_.force_size() / system_.length());
  tangent_->set_compliance(settling_regularisation / stiffness);
  return tangent_->factorize();
}

double PathSystem::largest_stiffness() const {
  return is_circulatory() ? tangent_->largest_stiffness() : system_.matrix().largest_stiffness();
}

std::optional<PathStability> PathSystem::stability() {
  if (!is_circulatory()) return PathStability{system_.matrix().negative_modes(), 0};
  CirculatoryModes found;
  if (!spectrum(factored_, found)) return std::nullopt;
  return PathStability{found.negative, found.pairs};
}

void PathSystem::residual(const PathPoint& x, std::vector<double>& out) {
  const std::span<double> all = out;
  system_.residual(x.lambda, all.first(at(plan_.columns)));
  std::copy(system_.phi().begin(), system_.phi().end(), all.begin() + plan_.columns);
}

void PathSystem::solve(std::span<const double> given, std::span<double> x) {
  if (is_circulatory())
    tangent_->solve_to_rounding(given, x);
  else
    solve_to_rounding(system_, weight_, given, x, correction_);
}

PathPoint PathSystem::tangent(const PathPoint& x, const PathPoint& previous) {
  parameter_derivative(x, derivative_);
  for (double& d : derivative_) d = -d;
  solve(derivative_, along_);
  PathPoint t{{along_.begin(), along_.begin() + plan_.columns}, {along_.begin() + plan_.columns, along_.end()}, 1};
  const double length = std::copysign(std::sqrt(product(t, t)), product(t, previous));
  for (double& v : t.q) v /= length;
  for (double& v : t.lambda) v /= length;
  t.p /= length;
  return t;
}

PathPoint PathSystem::along_parameter(double sign) const {
  return {std::vector<double>(at(plan_.columns), 0.0), std::vector<double>(at(plan_.rows), 0.0),
          std::copysign(scale_, sign)};
}

double PathSystem::product(const PathPoint& a, const PathPoint& b) const {
  double sum = a.p * b.p / (scale_ * scale_);
  for (std::size_t c = 0; c < weight_.size(); ++c) sum += weight_[c] * a.q[c] * b.q[c];
  return sum;
}

PathPoint PathSystem::advanced(const PathPoint& x, const PathPoint& t, double s) const {
  PathPoint result = x;
  for (int c = 0; c < plan_.columns; ++c) result.q[at(plan_.coordinate[at(c)])] += s * t.q[at(c)];
  for (std::size_t r = 0; r < t.lambda.size(); ++r) result.lambda[r] += s * t.lambda[r];
  result.p += s * t.p;
  return result;
}

double PathSystem::way(const PathPoint& from, const PathPoint& x, const PathPoint& t) const {
  double way = t.p * (x.p - from.p) / (scale_ * scale_);
  for (int c = 0; c < plan_.columns; ++c) {
    const std::size_t coordinate = at(plan_.coordinate[at(c)]);
    way += weight_[at(c)] * t.q[at(c)] * (x.q[coordinate] - from.q[coordinate]);
  }
  return way;
}

int PathSystem::correct(PathPoint& x, const PathPoint& from, const PathPoint& t, double s) {
  double before = 0;
  bool closely = false;
  for (int k = 0; k <= most_iterations; ++k) {
    if (!move_to(x)) {
      refused_value_ = x.p;
      return -1;
    }
    refused_value_.reset();
    residual(x, given_);
    const double place = way(from, x, t) - s;
    const double force = system_.force_norm({given_.data(), at(plan_.columns)});
    const double rounding = k > 0 ? system_.rounding_force() : 0, scale = system_.force_scale(x.lambda) + rounding;
    const double error = std::max({scale > 0 ? force / scale : 0, system_.phi_norm(),
                                   thresholds::carried_rounding / thresholds::solved * std::abs(place)});
    const double exact = std::max(thresholds::carried_rounding, 10 * system_.rounding_change());
    const double noise = exact + (scale > 0 ? rounding / scale : 0);
    if (error <= exact || (k > 0 && error <= nearly_solved && error >= 0.5 * before)) return k;
    if (!std::isfinite(error)) return -1;
    // Where steps do not halve the error a load may have a kink beside x.
    closely = closely || (k > 0 && error > thresholds::least_gain * before);
    before = error;
    if (k == most_iterations) break;
    double dp = 0;
    if (!find_newton_step(x, t, place, closely, dp)) return -1;
    // A residual that may be rounding of the stiffest spring counts as such only if a step would move nothing. That
    // step is made: a short spring is as stiff as its length is short, and rounding of its force is less than its
    // stiffness allows.
    if (error <= noise && system_.change_norm({newton_.data(), at(plan_.columns)}) <= nearly_solved) {
      PathPoint mended = x;
      make_newton_step(mended, dp);
      if (move_to(mended))
        x = std::move(mended);
      else
        move_to(x);
      return k;
    }
    // A law whose own value is zero at rest leaves no force to compare the residual with.
    if (is_circulatory() && k > 0 && system_.phi_norm() <= exact && std::abs(place) <= thresholds::solved &&
        std::abs(dp) <= thresholds::carried_rounding * scale_ &&
        system_.change_norm({newton_.data(), at(plan_.columns)}) <= thresholds::carried_rounding)
      return k;
    make_newton_step(x, dp);
  }
  return -1;
}

// Of the residual, given_, that x leaves, and of its place on the path: newton_, and dp of the parameter. False where
// there is no matrix to solve with, or the step has left the path. The system stays at x.
bool PathSystem::find_newton_step(const PathPoint& x, const PathPoint& t, double place, bool closely, double& dp) {
  // The difference is one-sided: it affects the convergence only.
  PathPoint beside = x;
  beside.p += parameter_step(x, closely);
  if (move_to(beside)) {
    residual(beside, derivative_);
    for (std::size_t i = 0; i < derivative_.size(); ++i)
      derivative_[i] = (derivative_[i] - given_[i]) / (beside.p - x.p);
    move_to(x);
  } else {
    parameter_derivative(x, derivative_);
  }
  // Exactly singular: a matrix slightly away from it serves for a step.
  if (!factorize_here(x.lambda, 0) && !factorize_here(x.lambda, 1e-10 * largest_stiffness())) return false;
  for (double& r : given_) r = -r;
  solve(given_, newton_);
  for (double& d : derivative_) d = -d;
  solve(derivative_, along_);
  double own = t.p / (scale_ * scale_), rest = place;
  for (std::size_t c = 0; c < weight_.size(); ++c) {
    own += weight_[c] * t.q[c] * along_[c];
    rest += weight_[c] * t.q[c] * newton_[c];
  }
  dp = -rest / own;
  for (std::size_t i = 0; i < newton_.size(); ++i) newton_[i] += dp * along_[i];
  for (int c = 0; c < plan_.columns; ++c) {
    const double unit = plan_.coordinate[at(c)] % 3 == 2 ? 1 : extent_;
    if (!(std::abs(newton_[at(c)]) < astray * unit)) return false;
  }
  return true;
}

// By newton_, and by dp of the parameter.
void PathSystem::make_newton_step(PathPoint& x, double dp) const {
  for (int c = 0; c < plan_.columns; ++c) x.q[at(plan_.coordinate[at(c)])] += newton_[at(c)];
  for (int r = 0; r < plan_.rows; ++r) x.lambda[at(r)] += newton_[at(plan_.columns + r)];
  x.p += dp;
}

}  // namespace catena
