#include "catena/analysis/dynamics/paces.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <numeric>

#include "catena/assembly/evaluate.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/model_part.hpp"

namespace catena {
namespace {

// Paces that differ by less than this share their steps.
constexpr double one_class = 3;

/// By body of the model.
std::vector<double> paces_of_bodies(const std::shared_ptr<const Model>& model) {
  PlanOptions open;
  open.released_elements = model->gaps();
  EvaluationWork work;
  Evaluator evaluator(Plan::make(*model, open), *model, work);
  const Plan& plan = evaluator.plan();
  const double length = evaluator.length_scale();
  evaluator.set_configuration(evaluator.given_configuration());
  std::vector<double> loads(at(plan.coordinates())), rest(loads.size(), 0.0), stiffness(loads.size(), 0.0);
  evaluator.applied_forces(rest, loads);
  evaluator.visit_stiffness(rest, [&](int i, int j, const ElementMatrix& matrix) {
    for (int k = 0; k < 3; ++k) {
      stiffness[at(3 * i + k)] += std::abs(matrix[at(6 * k + k)]);
      stiffness[at(3 * j + k)] += std::abs(matrix[at(6 * (k + 3) + k + 3)]);
    }
  });
  std::vector<double> paces(model->bodies.size(), 0.0);
  for (int p = 0; p < plan.moving; ++p) {
    const int number = plan.model_body[at(p)];
    const BasicBody<double>& body = model->bodies[at(number)];
    double& pace = paces[at(number)];
    pace = std::max(norm(body.velocity) / length, std::abs(body.angular_velocity));
    for (int k = 0; k < 3; ++k) {
      const double mass = k == 2 ? body.inertia : body.mass, unit = k == 2 ? 1 : length;
      if (!(mass > 0)) continue;
      pace = std::max({pace, std::sqrt(std::abs(loads[at(3 * p + k)]) / (mass * unit)),
                       std::sqrt(stiffness[at(3 * p + k)] / mass)});
    }
  }
  for_each_list(model->constraints, [&](const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    if constexpr (E::functions == 1 && !OneSided<E>) {
      const double unit = E::value_unit == UnitKind::angle ? 1 : length;
      for (const auto& entry : list) {
        if (entry.values[0].function < 0) continue;
        const Taylor<double> value = evaluator.element_value(entry.id);
        const double pace = std::max(std::abs(value.d) / unit, std::sqrt(std::abs(value.dd) / unit));
        for (const int body : {entry.i, entry.j}) {
          if (body >= 0) paces[at(body)] = std::max(paces[at(body)], pace);
        }
      }
    }
  });
  return paces;
}

/// By body of the model: whether a one-sided element or dry friction acts on it.
std::vector<char> touching_bodies(const Model& model) {
  std::vector<char> touches(model.bodies.size(), 0);
  for_each_list(model.constraints, [&](const auto& list, int) {
    if constexpr (OneSided<ElementOf<decltype(list)>>) {
      for (const auto& entry : list) {
        for (const int body : {entry.i, entry.j}) {
          if (body >= 0) touches[at(body)] = 1;
        }
      }
    }
  });
  return touches;
}

}  // namespace

std::vector<std::vector<int>> classes_of_pace(const std::shared_ptr<const Model>& model) {
  std::vector<std::vector<int>> groups = separate_groups(*model);
  if (groups.size() < 2) return groups;
  const std::vector<char> touching = touching_bodies(*model);
  const auto touches = [&](const std::vector<int>& group) {
    return std::any_of(group.begin(), group.end(), [&](int body) { return touching[at(body)] != 0; });
  };
  const auto first_touching =
      std::stable_partition(groups.begin(), groups.end(), [&](const auto& group) { return !touches(group); });
  std::vector<std::vector<int>> alone(std::make_move_iterator(first_touching), std::make_move_iterator(groups.end()));
  groups.erase(first_touching, groups.end());
  const std::vector<double> paces = paces_of_bodies(model);
  std::vector<double> pace;
  for (const std::vector<int>& group : groups) {
    pace.push_back(0);
    for (const int body : group) pace.back() = std::max(pace.back(), paces[at(body)]);
  }
  std::vector<std::size_t> order(groups.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return pace[a] < pace[b]; });
  std::vector<std::vector<int>> classes;
  double slowest = 0;
  for (const std::size_t k : order) {
    if (classes.empty() || pace[k] > one_class * slowest) {
      classes.emplace_back();
      slowest = pace[k];
    }
    classes.back().insert(classes.back().end(), groups[k].begin(), groups[k].end());
  }
  // The order of the model keeps neighbouring bodies together, and a mechanism keeps the order it has on its own.
  for (std::vector<int>& bodies : classes) std::sort(bodies.begin(), bodies.end());
  std::move(alone.begin(), alone.end(), std::back_inserter(classes));
  return classes;
}

}  // namespace catena
