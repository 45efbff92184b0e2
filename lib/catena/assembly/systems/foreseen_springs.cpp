#include "catena/assembly/systems/foreseen_springs.hpp"

#include <algorithm>
#include <cmath>

#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

constexpr int triangle = 21;

// Elastic cables are left out: a foreseen length would make them alternate between slack and taut.
template <class E>
constexpr bool is_spring = std::is_same_v<E, SpringDamper<double>>;

}  // namespace

ForeseenSprings::ForeseenSprings(const Evaluator& evaluator, const HessianSlots& slots) {
  const Plan& plan = evaluator.plan();
  const auto body = [&](int b) { return b < plan.bodies ? b : -1; };
  for_each_list(plan.forces, [&](const auto& block, int type) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    if constexpr (is_spring<E>) {
      static_assert(written_stiffness<E>().size() == triangle);
      for (int e = 0; e < block.size(); ++e) {
        springs_.push_back({.type = type,
                            .entry = block.entry[at(e)],
                            .i = body(block.body_i[at(e)]),
                            .j = body(block.body_j[at(e)]),
                            .slot = triangle * e});
      }
    }
  });
  if (springs_.empty()) return;
  own_ = others_ = slots;
  for_each_list(plan.forces, [&](const auto& block, int type) {
    using E = typename std::remove_cvref_t<decltype(block)>::Element;
    static_cast<void>(block);
    if constexpr (is_spring<E>) others_.forces[at(type)].clear();
  });
  take_over_model(evaluator);
}

void ForeseenSprings::take_over_model(const Evaluator& evaluator) {
  const Model& model = evaluator.model();
  active_ = false;
  for_each_list(model.forces, [&](const auto& list, int type) {
    using E = ElementOf<decltype(list)>;
    if constexpr (is_spring<E>) {
      for (Spring& spring : springs_) {
        if (spring.type != type) continue;
        const auto& entry = list[at(spring.entry)];
        const E& element = entry.element;
        spring.s_i = element.s_i;
        spring.s_j = element.s_j;
        spring.k = element.k;
        spring.free_length = element.length;
        if constexpr (std::is_same_v<E, SpringDamper<double>>) {
          spring.force = entry.values[0].constant;
          spring.function = entry.values[0].function;
          spring.curve = element.curve ? &element.curve : nullptr;
        }
        // Large coordinates are subtracted from each other once, here.
        const auto base = [&](int b, const Vec2<double>& s) { return b < 0 ? s : evaluator.origin(b); };
        spring.apart = base(spring.j, spring.s_j) - base(spring.i, spring.s_i);
      }
    }
  });
}

ForeseenSprings::Geometry ForeseenSprings::geometry_of(const Evaluator& evaluator, const Spring& spring) {
  Geometry g{spring.apart, {}, {}};
  const std::span<const Frame<double>> frames = evaluator.frames();
  if (spring.i >= 0) {
    g.arm_i = frames[at(spring.i)].axis(spring.s_i);
    g.h = g.h - (frames[at(spring.i)].origin() + g.arm_i);
  }
  if (spring.j >= 0) {
    g.arm_j = frames[at(spring.j)].axis(spring.s_j);
    g.h = g.h + (frames[at(spring.j)].origin() + g.arm_j);
  }
  return g;
}

std::pair<double, double> ForeseenSprings::law(const Spring& spring, double length) {
  const double stretch = length - spring.free_length;
  double f = spring.k * stretch + spring.force, slope = spring.k;
  if (spring.curve) {
    const Dual<double, 1> force = spring.curve->force(Dual<double, 1>::variable(stretch, 0));
    f += force.v;
    slope += force.d[0];
  }
  return {f, slope};
}

void ForeseenSprings::foresee(const Evaluator& evaluator, std::span<const double> change) {
  active_ = any();
  const auto& functions = evaluator.model().functions;
  for (Spring& spring : springs_) {
    if (spring.function >= 0) spring.force = functions[at(spring.function)].evaluate(evaluator.time()).f;
    spring.length = spring.free_length;
    if (change.empty()) continue;
    const Geometry g = geometry_of(evaluator, spring);
    spring.length = norm(g.h);
    Vec2<double> by{};
    const auto move = [&](int body, const Vec2<double>& arm, double sign) {
      if (body < 0) return;
      const double* c = change.data() + 3 * body;
      by += sign * (Vec2<double>{c[0], c[1]} + c[2] * perpendicular(arm));
    };
    move(spring.i, g.arm_i, -1);
    move(spring.j, g.arm_j, 1);
    if (spring.length > 0) spring.length += dot(g.h, by) / spring.length;
  }
}

void ForeseenSprings::add(const Evaluator& evaluator, Curvature curvature, std::span<double> values) const {
  const bool convex = curvature == Curvature::convex;
  for (const Spring& spring : springs_) {
    const Geometry geometry = geometry_of(evaluator, spring);
    const double now = norm(geometry.h), length = spring.length > 0 ? spring.length : now;
    const auto [f, slope] = law(spring, length);
    // Along the line, across it, and what turning arms adds; without a line only a spring without free length pulls.
    const Vec2<double> n = now > 0 ? geometry.h / now : Vec2<double>{1, 0};
    double along = slope, across = length > 0 ? f / length : slope;
    double turn_i = f * dot(n, geometry.arm_i), turn_j = -f * dot(n, geometry.arm_j);
    if (convex) {
      along = std::max(along, 0.0);
      // Compression during the iteration is mostly a tension that was not found yet: without stiffness across, slack
      // chains would make very long steps.
      across = std::abs(across);
      turn_i = std::max(turn_i, 0.0);
      turn_j = std::max(turn_j, 0.0);
    }
    const Vec2<double> p = perpendicular(n), ri = perpendicular(geometry.arm_i), rj = perpendicular(geometry.arm_j);
    const double g[6] = {-n.x, -n.y, -dot(n, ri), n.x, n.y, dot(n, rj)};
    const double w[6] = {-p.x, -p.y, -dot(p, ri), p.x, p.y, dot(p, rj)};
    const int* const slots = &own_.forces[at(spring.type)][at(spring.slot)];
    const int* slot = slots;
    for (int r = 0; r < 6; ++r) {
      for (int c = 0; c <= r; ++c) values[at(*slot++)] += along * g[r] * g[c] + across * w[r] * w[c];
    }
    values[at(slots[5])] += turn_i;
    values[at(slots[20])] += turn_j;
  }
}

}  // namespace catena
