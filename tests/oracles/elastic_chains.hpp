// Chains of lumped masses and springs between two pins above a level floor, and their equilibrium by nested bisection.
//
//   segment j from the upper pin, tension (H, V_j), V_j = max(V - j w, 0):   vector = (H, V_j) / T (l + T / k)
//   sum of the vectors = (X, Y);   both sums grow with V and H
//
// w the weight of a mass: one that is lifted takes w off what is above it, one on the floor is carried by it. The lower
// pin is on the floor, and the chain is too short to lie slack, so that H > 0.
#pragma once

#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

#include "catena/elements/forces/spring_damper.hpp"
#include "oracles/one_sided_scenes.hpp"

namespace catena::testing {

struct ElasticChain {
  int count = 10;          ///< springs; one mass fewer
  double length = 1;       ///< of a spring without tension, m
  double stiffness = 1e6;  ///< of a spring, N/m
  double weight = 1;       ///< of a mass, N
  double reach = 8, height = 2;
  double bend = 3;  ///< power of the curve along which the masses are laid out
};

inline std::shared_ptr<Model> elastic_chain(const ElasticChain& c) {
  auto model = std::make_shared<Model>();
  model->gravity = {0, -gravity_of_earth};
  for (int k = 1; k < c.count; ++k) {
    const double t = static_cast<double>(k) / c.count;
    BodyValues body{.mass = c.weight / gravity_of_earth, .position = {c.reach * t, c.height * std::pow(t, c.bend)}};
    body.particle = true;
    model->add_body("node" + std::to_string(k), body);
    model->add("floor" + std::to_string(k), floor_contact(), ground, k - 1);
  }
  for (int k = 0; k < c.count; ++k) {
    SpringDamper<double> spring;
    spring.k = c.stiffness;
    spring.length = c.length;
    if (k + 1 == c.count) spring.s_j = {c.reach, c.height};
    model->add_force("segment" + std::to_string(k), spring, k == 0 ? ground : k - 1, k + 1 == c.count ? ground : k);
  }
  return model;
}

/// Places of the masses from the lower pin on, and the pull of the upper end.
struct ElasticChainSolution {
  std::vector<Vec2<double>> node;
  double pull = 0, lift = 0;
};

inline ElasticChainSolution solve_elastic_chain(const ElasticChain& c) {
  using Long = long double;
  const auto segment = [&](Long h, Long v, Long& x, Long& y) {
    const Long t = std::sqrt(h * h + v * v), long_ = c.length + t / c.stiffness;
    x = h / t * long_;
    y = v / t * long_;
  };
  const auto vertical = [&](Long v, int j) { return std::max(v - j * static_cast<Long>(c.weight), Long(0)); };
  const auto sums = [&](Long h, Long v, Long& x, Long& y) {
    x = y = 0;
    for (int j = 0; j < c.count; ++j) {
      Long dx, dy;
      segment(h, vertical(v, j), dx, dy);
      x += dx;
      y += dy;
    }
  };
  const Long largest = c.stiffness * (c.reach + c.height + c.count * c.length) + c.count * static_cast<Long>(c.weight);
  const auto lift_at = [&](Long h) {
    Long low = 0, high = largest;
    for (int k = 0; k < 100; ++k) {
      const Long v = (low + high) / 2;
      Long x, y;
      sums(h, v, x, y);
      (y < c.height ? low : high) = v;
    }
    return (low + high) / 2;
  };
  Long low = 1e-12L * c.weight, high = largest;
  for (int k = 0; k < 130; ++k) {
    const Long h = std::sqrt(low * high);
    Long x, y;
    sums(h, lift_at(h), x, y);
    (x < c.reach ? low : high) = h;
  }
  const Long h = std::sqrt(low * high), v = lift_at(h);
  ElasticChainSolution solution{.node = std::vector<Vec2<double>>(static_cast<std::size_t>(c.count) - 1),
                                .pull = static_cast<double>(h),
                                .lift = static_cast<double>(v)};
  Long x = c.reach, y = c.height;
  for (int j = 0; j + 1 < c.count; ++j) {
    Long dx, dy;
    segment(h, vertical(v, j), dx, dy);
    x -= dx;
    y -= dy;
    solution.node[static_cast<std::size_t>(c.count - 2 - j)] = {static_cast<double>(x), static_cast<double>(y)};
  }
  return solution;
}

/// Stiff and soft, light and heavy, from half lifted to all but straight, scales from 1 um to 1000 km.
inline ElasticChain random_elastic_chain(std::mt19937& random, int most) {
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  ElasticChain c;
  c.count = 3 + static_cast<int>(std::exp(uniform(0, std::log(most - 2.0))));
  const double size = std::pow(10.0, uniform(-6, 6));
  c.reach = size * uniform(0.5, 1);
  c.height = size * uniform(0.05, 0.6);
  // Between the straight line and the two sides of the corner.
  const double straight = std::hypot(c.reach, c.height), corner = c.reach + c.height;
  c.length = (straight + uniform(0.02, 0.9) * (corner - straight)) / c.count;
  c.weight = std::pow(10.0, uniform(-6, 6)) / c.count;
  // A strain of 1e-1 ... 1e-6 under the chain's own weight.
  c.stiffness = c.count * c.weight / (c.length * std::pow(10.0, uniform(-6, -1)));
  c.bend = uniform(1, 4);
  return c;
}

/// Largest force left at any mass, floor taken into account, beside the chain's weight and pull.
inline double imbalance(const ElasticChain& c, const std::vector<Vec2<double>>& node, double pull) {
  double worst = 0;
  const auto tension = [&](const Vec2<double>& from, const Vec2<double>& to) {
    const Vec2<double> h = to - from;
    return (c.stiffness * (norm(h) - c.length) / norm(h)) * h;
  };
  for (std::size_t k = 0; k < node.size(); ++k) {
    const Vec2<double> before = k == 0 ? Vec2<double>{} : node[k - 1];
    const Vec2<double> after = k + 1 < node.size() ? node[k + 1] : Vec2<double>{c.reach, c.height};
    Vec2<double> sum = tension(node[k], before) + tension(node[k], after) - Vec2<double>{0, c.weight};
    if (node[k].y <= 1e-9 * c.length) sum.y = std::max(sum.y, 0.0);
    worst = std::max({worst, norm(sum), node[k].y < -1e-9 * c.length ? c.weight : 0.0});
  }
  return worst / (c.count * c.weight + pull);
}

/// How the library's answer compares with bisection's.
struct ElasticChainVerdict {
  bool taut = false;  ///< few segments may reach the corner slack: then there is no pull, and more than one place
  bool ok = false, right = false;
  bool folded = false;  ///< in balance elsewhere
  std::string said = {};
};

inline ElasticChainVerdict judge_elastic_chain(const ElasticChain& c) {
  const ElasticChainSolution exact = solve_elastic_chain(c);
  ElasticChainVerdict verdict{.taut = exact.pull > 1e-3 * c.weight};
  if (!verdict.taut) return verdict;
  const auto model = elastic_chain(c);
  Equilibrium analysis(model);
  const EquilibriumReport report = analysis.solve();
  verdict.ok = report.ok();
  verdict.said = report.message;
  if (!verdict.ok) return verdict;
  const SystemState state = analysis.state();
  double worst = 0;
  for (std::size_t k = 0; k < exact.node.size(); ++k) {
    const Vec2<double> place{state.q[3 * k], state.q[3 * k + 1]};
    worst = std::max(worst, norm(place - exact.node[k]) / (c.count * c.length));
  }
  // A segment folded back on the floor may be held there by the weights of its ends: another minimum, of more energy.
  std::vector<Vec2<double>> nodes;
  for (std::size_t k = 0; k < exact.node.size(); ++k) nodes.push_back({state.q[3 * k], state.q[3 * k + 1]});
  verdict.folded = worst > 1e-7 && imbalance(c, nodes, exact.pull) <= 1e-6;
  verdict.right = (worst <= 1e-7 || verdict.folded) && report.stable;
  if (!verdict.right) verdict.said = "off by " + std::to_string(worst) + (report.stable ? "" : ", not stable");
  return verdict;
}

}  // namespace catena::testing
