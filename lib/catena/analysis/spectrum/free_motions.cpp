#include "catena/analysis/spectrum/free_motions.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/run/name_list.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/modes_dense.hpp"
#include "catena/analysis/spectrum/static_balance.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Part of the largest travel in a motion that a body must have to take part in it: rounding of shapes is far below.
constexpr double least_share = 1e-8;

// Columns of a model above which `check`, which must stay quick, does not search.
constexpr int most_checked_columns = 20000;

// Removes from orthonormal motions (metric W) the one along which the unbalanced forces do work, if there is one.
void drop_driven(const StaticSystem& system, std::span<const double> residual, double force,
                 std::vector<std::vector<double>>& shapes) {
  std::vector<double> work;
  double square = 0;
  for (const std::vector<double>& v : shapes) {
    double sum = 0;
    for (std::size_t c = 0; c < v.size(); ++c) sum += residual[c] * v[c];
    work.push_back(sum);
    square += sum * sum;
  }
  if (!(std::sqrt(square) > thresholds::no_force * force) || shapes.empty()) return;
  // Householder: the first of the new motions has all the work, the others none.
  const std::size_t first = static_cast<std::size_t>(
      std::max_element(work.begin(), work.end(), [](double a, double b) { return std::abs(a) < std::abs(b); }) -
      work.begin());
  std::vector<double> u = work;
  u[first] += std::copysign(std::sqrt(square), work[first]);
  double length = 0;
  for (double x : u) length += x * x;
  std::vector<double> sum(at(system.plan().columns), 0.0);
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    for (std::size_t c = 0; c < sum.size(); ++c) sum[c] += u[k] * shapes[k][c];
  }
  for (std::size_t k = 0; k < shapes.size(); ++k) {
    for (std::size_t c = 0; c < sum.size(); ++c) shapes[k][c] -= 2 / length * u[k] * sum[c];
  }
  shapes.erase(shapes.begin() + static_cast<std::ptrdiff_t>(first));
}

}  // namespace

std::optional<FreeMotions> find_free_motions(StaticSystem& system, std::span<const double> lambda,
                                             double second_order) {
  MotionGroups groups(system, true);
  if (!groups.are_small()) return {};
  std::vector<double> residual(at(system.plan().columns));
  system.residual(lambda, residual);
  // Where forces balance only to rounding, stiffnesses are no more accurate.
  const double force = system.force_scale(lambda), left = system.force_norm(residual);
  const StiffnessFloor floor(system, lambda, left <= thresholds::no_force * force ? left : 0, &groups);
  const std::vector<double> weight = metric_of_arms(system, lambda);
  const DenseModes dense(system, groups, weight);
  FreeMotions result;
  // Groups move independently: a force on one does not hold another.
  std::vector<int> group_of(at(system.plan().columns));
  for (std::size_t g = 0; g < groups.groups().size(); ++g) {
    for (int c : groups.groups()[g].columns) group_of[at(c)] = static_cast<int>(g);
  }
  std::vector<std::vector<std::vector<double>>> neutral_in(groups.groups().size());
  for (Mode& mode : dense.lowest(0, floor)) {
    const bool neutral =
        std::abs(mode.omega2) <= second_order * system.matrix().absolute_quadratic(mode.shape) || mode.omega2 == 0;
    if (!neutral && mode.omega2 < 0 && ++result.negative == 1) result.lowest = mode.shape;
    if (!neutral) continue;
    const auto moved = std::find_if(mode.shape.begin(), mode.shape.end(), [](double v) { return v != 0; });
    const auto column = static_cast<std::size_t>(moved - mode.shape.begin());
    neutral_in[at(group_of[column])].push_back(std::move(mode.shape));
  }
  std::vector<std::vector<double>> shapes;
  for (auto& own : neutral_in) {
    drop_driven(system, residual, force, own);
    for (std::vector<double>& v : own) shapes.push_back(std::move(v));
  }
  result.count = static_cast<int>(shapes.size());
  result.bodies = names_of_moving(system, lambda, shapes);
  result.shapes = std::move(shapes);
  return result;
}

std::optional<FreeMotions> find_free_motions(const std::shared_ptr<const Model>& model, const SystemState& state) {
  PlanOptions options;
  options.released_elements = model->gaps();
  EvaluationWork work;
  Evaluator evaluator(Plan::make(*model, options), *model, work);
  if (!evaluator.conservative() || evaluator.plan().columns > most_checked_columns) return {};
  StaticSystem system(evaluator);
  evaluator.set_time(state.t);
  system.move_to(configuration_of(evaluator, state));
  std::vector<double> lambda(at(system.plan().rows));
  balance_loads(system, lambda);
  system.fill(lambda, Curvature::exact, 0);
  return find_free_motions(system, lambda, 0);
}

std::vector<std::string> names_of_moving(StaticSystem& system, std::span<const double> lambda,
                                         const std::vector<std::vector<double>>& shapes) {
  if (shapes.empty()) return {};
  const Plan& plan = system.plan();
  const Evaluator& evaluator = system.evaluator();
  const std::vector<double> arms = body_arms(system, lambda);
  std::vector<double> share(at(plan.moving), 0.0);
  for (const std::vector<double>& v : shapes) {
    std::vector<double> travel(share.size(), 0.0);
    for (int c = 0; c < plan.columns; ++c) {
      const int coordinate = plan.coordinate[at(c)], body = coordinate / 3;
      const double own = std::abs(v[at(c)]) * (coordinate % 3 == 2 ? arms[at(body)] : 1);
      travel[at(body)] = std::max(travel[at(body)], own);
    }
    const double most = travel.empty() ? 0 : *std::max_element(travel.begin(), travel.end());
    for (std::size_t b = 0; b < travel.size(); ++b) share[b] = std::max(share[b], travel[b] / most);
  }
  std::vector<int> bodies;
  for (int b = 0; b < plan.moving; ++b) {
    if (share[at(b)] > least_share) bodies.push_back(plan.model_body[at(b)]);
  }
  std::sort(bodies.begin(), bodies.end());
  std::vector<std::string> names;
  for (int b : bodies) names.emplace_back(evaluator.model().body_name(b));
  return names;
}

std::string describe_free_motions(int count, const std::vector<std::string>& bodies) {
  NameList names;
  for (const std::string& body : bodies) names.add(body);
  return fmt::format("{} motion{} of {}", count, count > 1 ? "s" : "", names.text());
}

}  // namespace catena
