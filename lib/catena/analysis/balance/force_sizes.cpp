#include "catena/analysis/balance/force_sizes.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

/// |F| + sum |dF/dq| |q|: the terms of a law of state, which cancel where it holds a body by itself.
double law_size(const Evaluator& evaluator, int law) {
  double size = std::abs(evaluator.law_value(law, {}));
  for (const int body : evaluator.laws()[at(law)].bodies) {
    const std::array<double, 6> gradient = evaluator.law_gradient(law, body, {});
    const Frame<double> place = evaluator.ground_frame(body);
    size += std::abs(gradient[0] * place.x) + std::abs(gradient[1] * place.y) + std::abs(gradient[2] * place.phi);
  }
  return size;
}

}  // namespace

ForceSizes force_sizes(const Evaluator& evaluator) {
  const Plan& plan = evaluator.plan();
  const Model& model = evaluator.model();
  ForceSizes sizes{std::vector<double>(at(plan.coordinates()), 0.0), {}};
  for (int p = 0; p < plan.moving; ++p) {
    const double mass = model.bodies[at(plan.model_body[at(p)])].mass;
    sizes.all[at(3 * p)] = std::abs(mass * model.gravity.x);
    sizes.all[at(3 * p + 1)] = std::abs(mass * model.gravity.y);
  }
  sizes.loads = sizes.all;
  const Twist<double> rest;
  for_each_list(model.forces, [&](const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    constexpr bool is_load = std::is_same_v<E, PointForce<double>> || std::is_same_v<E, Torque<double>>;
    const auto add = [&](int p, const Wrench<double>& wrench) {
      const double parts[] = {wrench.fx, wrench.fy, wrench.moment};
      for (int k = 0; k < 3; ++k) {
        sizes.all[at(3 * p + k)] += std::abs(parts[k]);
        if (is_load) sizes.loads[at(3 * p + k)] += std::abs(parts[k]);
      }
    };
    [[maybe_unused]] double tension = 0;  // of the rope that the elements belong to
    for (const auto& entry : list) {
      std::array<double, static_cast<std::size_t>(E::functions) + 1> f{};
      for (std::size_t k = 0; k < static_cast<std::size_t>(E::functions); ++k) {
        const auto& value = entry.values[k];
        f[k] = value.law >= 0        ? law_size(evaluator, value.law)
               : value.function >= 0 ? model.functions[at(value.function)].evaluate(evaluator.time()).f
                                     : value.constant;
      }
      const auto plan_body = [&](int b) { return b < 0 ? plan.bodies : plan.plan_body[at(b)]; };
      const int i = plan_body(entry.i), j = plan_body(entry.j);
      // Relative to i where it moves, else to j, so that far off the origin no digits are lost.
      const Vec2<double> common = evaluator.ground_frame(i < plan.bodies ? i : j).origin();
      const auto near = [&](int p) {
        Frame<double> frame = evaluator.ground_frame(p);
        frame.x -= common.x;
        frame.y -= common.y;
        return frame;
      };
      const Frame<double> of_i = near(i), of_j = near(j);
      Wrench<double> on_i, on_j;
      if constexpr (Sharing<E>) {
        if (entry.element.pieces > 0) {
          const int head = model.elements[at(entry.id)].index;
          const auto frame = [&](int b) { return evaluator.ground_frame(plan_body(b)); };
          tension = entry.element.k * std::max(-rope_slack<double>(list, head, frame), 0.0);
        }
        if (tension > 0) entry.element.pull(tension, of_i, of_j, on_i, on_j);
      } else {
        entry.element.force(ForceArguments<double>{of_i, of_j, rest, rest, f.data(), common}, on_i, on_j);
      }
      add(i, on_i);
      if (E::bodies == 2) add(j, on_j);
    }
  });
  return sizes;
}

}  // namespace catena
