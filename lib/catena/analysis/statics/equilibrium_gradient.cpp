#include "catena/analysis/statics/equilibrium_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace catena {
namespace {

// Refined until a correction is this part of the solution, or no longer a tenth of the one before: each gains the
// digits that the regularisation leaves (kkt_matrix.hpp), seven to ten.
constexpr double refined = 1e-14, least_progress = 0.1;
constexpr int most_refinements = 6;
// Of corrections that no longer fall: what is left is rounding x condition, or the factors are of another matrix.
constexpr double rough = 1e-9;

}  // namespace

EquilibriumGradient::EquilibriumGradient(Equilibrium& rest)
    : system_(rest.system()), q_(rest.q()), lambda_(rest.lambda()), neutral_(rest.is_neutral()) {
  if (!rest.is_solved()) throw std::invalid_argument("gradient of an equilibrium: it is not solved");
  if (!system_.evaluator().conservative() || !system_.evaluator().laws().empty())
    throw std::invalid_argument(
        "gradient of an equilibrium: forces without a potential act, whose stiffness is not "
        "symmetric");
  const std::size_t size = at(plan().columns + plan().rows);
  for (auto* v : {&right_, &x_, &residual_, &correction_}) v->resize(size);
  w_.assign(at(plan().coordinates()), 0.0);
  system_.move_to(q_);
  system_.forget_lengths();
  system_.fill(lambda_, Curvature::exact, 0);
}

bool EquilibriumGradient::measure(std::span<const double> by_q, std::span<const double> by_lambda) {
  const std::size_t columns = at(plan().columns);
  if ((!by_q.empty() && by_q.size() != 3 * evaluator().model().bodies.size()) ||
      (!by_lambda.empty() && by_lambda.size() != at(plan().rows)))
    throw std::invalid_argument(
        "gradient of an equilibrium: derivatives of the measure have other sizes than what it "
        "is taken of");
  std::fill(right_.begin(), right_.end(), 0.0);
  for (std::size_t c = 0; c < columns && !by_q.empty(); ++c) {
    const int coordinate = plan().coordinate[c];
    right_[c] = by_q[at(3 * plan().model_body[at(coordinate / 3)] + coordinate % 3)];
  }
  std::copy(by_lambda.begin(), by_lambda.end(), right_.begin() + plan().columns);
  return solve();
}

bool EquilibriumGradient::measure_multiplier(int element, int row) {
  if (element < 0 || at(element) >= plan().element_row.size() || plan().element_row[at(element)] < 0 || row < 0 ||
      plan().element_row[at(element)] + row >= plan().rows ||
      plan().row_element[at(plan().element_row[at(element)] + row)] != element)
    throw std::out_of_range("gradient of an equilibrium: no such row of an element");
  std::fill(right_.begin(), right_.end(), 0.0);
  right_[at(plan().columns + plan().element_row[at(element)] + row)] = 1;
  return solve();
}

bool EquilibriumGradient::solve() {
  if (neutral_) return false;
  if (!refine()) {
    if (!system_.factorize().ok() || !refine()) return false;
  }
  for (int c = 0; c < plan().columns; ++c) w_[at(plan().coordinate[at(c)])] = x_[at(c)];
  return true;
}

// Against the true matrix: the factors are of a regularised one.
bool EquilibriumGradient::refine() {
  if (!system_.has_factors()) return false;
  KktMatrix& matrix = system_.matrix();
  const std::size_t columns = at(plan().columns);
  const auto sizes = [&](std::span<const double> x) {
    std::array<double, 2> size{};
    for (std::size_t k = 0; k < x.size(); ++k)
      size[k >= columns] = std::max(size[k >= columns], std::abs(x[k]) / (k < columns ? matrix.inverse_arms()[k] : 1));
    return size;
  };
  x_ = right_;
  matrix.solve_unrefined(x_, system_.evaluator().counters);
  double before = 1;
  for (int n = 0; n < most_refinements; ++n) {
    matrix.multiply(x_, residual_);
    for (std::size_t k = 0; k < x_.size(); ++k) correction_[k] = right_[k] - residual_[k];
    matrix.solve_unrefined(correction_, system_.evaluator().counters);
    for (std::size_t k = 0; k < x_.size(); ++k) x_[k] += correction_[k];
    const auto change = sizes(correction_), all = sizes(x_);
    if (!std::isfinite(all[0] + all[1])) return false;
    const double part = std::max(all[0] > 0 ? change[0] / all[0] : 0, all[1] > 0 ? change[1] / all[1] : 0);
    if (part <= refined) return true;
    if (part > least_progress * before) return part <= rough;
    before = part;
  }
  return before <= rough;
}

Frame<EquilibriumGradient::Along> EquilibriumGradient::frame(int plan_body) const {
  const Frame<double>& f = evaluator().frames()[at(plan_body)];
  const double* w = w_.data() + 3 * plan_body;
  const auto along = [](double value, double rate) {
    return Along(DesignScalar(value), std::array<DesignScalar, 1>{DesignScalar(rate)});
  };
  return {along(f.x, w[0]), along(f.y, w[1]), along(f.phi, w[2]), along(f.c, -f.s * w[2]), along(f.s, f.c * w[2])};
}

EquilibriumGradient::Pair EquilibriumGradient::frames(int body_i, int body_j, int bodies) const {
  Pair pair;
  pair.i = frame(body_i);
  const Vec2<double> origin = evaluator().origin(body_i);
  if (bodies == 1) {
    pair.ground = origin;
    return pair;
  }
  pair.j = frame(body_j);
  const Vec2<double> apart = evaluator().origin(body_j) - origin;
  pair.j.x += Along(DesignScalar(apart.x));
  pair.j.y += Along(DesignScalar(apart.y));
  return pair;
}

std::vector<double> EquilibriumGradient::by_masses() const {
  const Model& model = evaluator().model();
  std::vector<double> gradient(model.bodies.size(), 0.0);
  for (int b = 0; b < plan().moving; ++b)
    gradient[at(plan().model_body[at(b)])] = model.gravity.x * w_[at(3 * b)] + model.gravity.y * w_[at(3 * b + 1)];
  return gradient;
}

}  // namespace catena
