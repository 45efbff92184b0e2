#include "catena/analysis/statics/equilibrium_gradient.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catena/analysis/spectrum/modes_operator.hpp"

namespace catena {
namespace {

// Of the last correction: larger ones come of factors of another matrix.
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
  for (auto* v : {&right_, &x_, &correction_}) v->resize(size);
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
  return solve_to_rounding(system_, length_weights(system_), right_, x_, correction_) <= rough;
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
