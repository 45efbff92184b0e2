// Random nets of cables, many of them slack, hung from hooks; judged by the balance of their knots.
//
//   elastic cables    T = k max(|h| - L, 0)          the energy is convex in the knots' places
//   inextensible      |h| <= L,  T >= 0,  T (L - |h|) = 0      a linear energy over a convex set
//
// so that places at which pulls alone balance the weights are the minimum itself, whatever the search did: nothing of
// the library is needed to judge them but the places and, of inextensible cables, the tensions it claims.
#pragma once

#include <fmt/format.h>

#include <array>
#include <string>

#include "oracles/one_sided_scenes.hpp"

namespace catena::testing {

struct SlackNet {
  std::shared_ptr<Model> model = std::make_shared<Model>();
  std::vector<double> weight;             // of the knots
  std::vector<std::array<int, 2>> cable;  // knots, -1: hung from the ground at `place`
  std::vector<Vec2<double>> place;
  std::vector<double> length, stiffness;  // stiffness 0: inextensible
  double total = 0;                       // of the weights
};

struct SlackNetShape {
  int columns = 2, rows = 4;
  double slack = 1.3;  ///< cables are up to so much longer than their knots are apart
  bool elastic = false;
};

/// Rows of knots under a row of hooks, cables to the neighbours below, beside and across.
inline SlackNet make_slack_net(const SlackNetShape& shape, unsigned seed) {
  SlackNet net;
  std::mt19937 random(seed);
  const auto uniform = [&](double low, double high) { return low + (high - low) * (random() / 4294967296.0); };
  const int columns = shape.columns, rows = shape.rows;
  net.model->gravity = {0, -gravity_of_earth};
  std::vector<Vec2<double>> knots;
  for (int k = 0; k < columns * rows; ++k) {
    const double x = k % columns + uniform(-0.2, 0.2), y = -(k / columns) + uniform(-0.2, 0.2);
    knots.push_back({x, y});
    if (k < columns) continue;
    const double mass = uniform(0.5, 2);
    BodyValues body{.mass = mass, .position = {x, y}};
    body.particle = true;
    net.model->add_body("knot" + std::to_string(k), body);
    net.weight.push_back(mass * gravity_of_earth);
    net.total += net.weight.back();
  }
  const auto tie = [&](int a, int b) {
    if (b < columns) return;
    const auto from = static_cast<std::size_t>(a), to = static_cast<std::size_t>(b);
    const double length = norm(knots[to] - knots[from]) * uniform(1, shape.slack);
    const double k = shape.elastic ? uniform(500, 5000) : 0;
    const Vec2<double> hook = a < columns ? knots[from] : Vec2<double>{};
    const int i = a < columns ? ground : a - columns, j = b - columns;
    if (shape.elastic) {
      net.model->add_force("", ElasticCable<double>{hook, {}, length, k}, i, j);
    } else {
      net.model->add("", Cable<double>{hook, {}, length}, i, j);
    }
    net.cable.push_back({i, j});
    net.place.push_back(hook);
    net.length.push_back(length);
    net.stiffness.push_back(k);
  };
  for (int k = 0; k < columns * rows; ++k) {
    const bool inner = k % columns + 1 < columns, below = k + columns < columns * rows;
    if (below) tie(k, k + columns);
    if (inner) tie(k, k + 1);
    if (inner && below) tie(k, k + columns + 1);
  }
  return net;
}

/// Forces on the knots at their places, from tensions; the largest that is left over, N.
inline double imbalance(const SlackNet& net, const std::vector<Vec2<double>>& knot,
                        const std::vector<double>& tension) {
  std::vector<Vec2<double>> sum;
  for (double w : net.weight) sum.push_back({0, -w});
  for (std::size_t c = 0; c < tension.size(); ++c) {
    const auto [i, j] = net.cable[c];
    const auto end = static_cast<std::size_t>(j);
    const Vec2<double> h = knot[end] - (i < 0 ? net.place[c] : knot[static_cast<std::size_t>(i)]);
    if (tension[c] == 0) continue;
    const Vec2<double> pull = (tension[c] / norm(h)) * h;
    sum[end] += -pull;
    if (i >= 0) sum[static_cast<std::size_t>(i)] += pull;
  }
  double largest = 0;
  for (const Vec2<double>& s : sum) largest = std::max(largest, norm(s));
  return largest;
}

inline std::vector<Vec2<double>> knots_of(const Equilibrium& analysis) {
  const SystemState state = analysis.state();
  std::vector<Vec2<double>> knots;
  for (std::size_t k = 0; k + 2 < state.q.size(); k += 3) knots.push_back({state.q[k], state.q[k + 1]});
  return knots;
}

/// How far each cable is beyond its length, m; negative: slack.
inline std::vector<double> stretches(const SlackNet& net, const std::vector<Vec2<double>>& knot) {
  std::vector<double> all;
  for (std::size_t c = 0; c < net.cable.size(); ++c) {
    const auto [i, j] = net.cable[c];
    all.push_back(norm(knot[static_cast<std::size_t>(j)] - (i < 0 ? net.place[c] : knot[static_cast<std::size_t>(i)])) -
                  net.length[c]);
  }
  return all;
}

struct OneSidedVerdict {
  bool ok = false;    ///< the library says so
  std::string fault;  ///< what is wrong with an answer called ok; empty: nothing
  std::string said;   ///< of one that is not ok
};

/// Balance within 1e-9 of the weight; no inextensible cable longer than it is, nor a slack one that pulls.
inline OneSidedVerdict judge_slack_net(const SlackNet& net) {
  Equilibrium analysis(net.model);
  const EquilibriumReport report = analysis.solve();
  OneSidedVerdict verdict{report.ok(), {}, std::string(to_string(report.status)) + ": " + report.message};
  if (!verdict.ok) return verdict;
  const std::vector<Vec2<double>> knot = knots_of(analysis);
  const std::vector<double> stretch = stretches(net, knot);
  const bool elastic = net.stiffness.front() > 0;
  const std::vector<GapState> states = elastic ? std::vector<GapState>{} : gap_states(analysis, *net.model);
  std::vector<double> tension;
  for (std::size_t c = 0; c < stretch.size(); ++c) {
    tension.push_back(elastic ? net.stiffness[c] * std::max(stretch[c], 0.0) : states[c].force);
    if (elastic) continue;
    if (stretch[c] > 1e-9) verdict.fault = fmt::format("cable {} is {:.3g} m too long", c, stretch[c]);
    if (tension[c] < -1e-9 * net.total) verdict.fault = fmt::format("cable {} pushes with {:.3g} N", c, tension[c]);
    if (std::abs(tension[c] * stretch[c]) > 1e-8 * net.total)
      verdict.fault = fmt::format("cable {} pulls with {:.3g} N and is {:.3g} m slack", c, tension[c], -stretch[c]);
  }
  const double left = imbalance(net, knot, tension) / net.total;
  if (!(left <= 1e-9)) verdict.fault = fmt::format("knots are off balance by {:.3g} of the weight", left);
  return verdict;
}

/// A net of any size, slack and material.
inline SlackNet random_slack_net(unsigned seed) {
  std::mt19937 random(seed);
  SlackNetShape shape;
  shape.columns = 2 + static_cast<int>(random() % 8);
  shape.rows = 2 + static_cast<int>(random() % 8);
  shape.slack = 1.02 + 0.6 * (random() / 4294967296.0);
  shape.elastic = random() % 2 == 0;
  return make_slack_net(shape, seed);
}

}  // namespace catena::testing
