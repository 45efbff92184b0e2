#include "catena/analysis/kinematics/course/kinematics_bridge.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catena {
namespace {

constexpr int most_data = 3 * MotionBridge::capacity;
using BridgeWeights = std::array<double, most_data>;

// Weights of the data (three an instant) in the value and the first two derivatives at x of Hermite's polynomial,
// by Newton's divided differences of the data sets that are 1 at one datum and 0 at the others.
std::array<BridgeWeights, 3> hermite_weights(std::span<const double> instants, double x) {
  const std::size_t n = 3 * instants.size();
  const auto place = [&](std::size_t k) { return instants[k / 3]; };
  std::array<BridgeWeights, 3> weights{};
  for (std::size_t datum = 0; datum < n; ++datum) {
    // Entry d of an instant's data is a derivative of order d; repeated differences need it over d!.
    const auto given = [&](std::size_t node, std::size_t derivative) {
      return 3 * (node / 3) + derivative == datum ? (derivative == 2 ? 0.5 : 1.0) : 0.0;
    };
    BridgeWeights f{}, newton{};
    for (std::size_t k = 0; k < n; ++k) f[k] = given(k, 0);
    newton[0] = f[0];
    for (std::size_t order = 1; order < n; ++order) {
      for (std::size_t k = 0; k + order < n; ++k) {
        const double width = place(k + order) - place(k);
        f[k] = width == 0 ? given(k, order) : (f[k + 1] - f[k]) / width;
      }
      newton[order] = f[0];
    }
    double p = 0, pd = 0, pdd = 0;
    for (std::size_t k = n; k-- > 0;) {
      const double step = x - place(k);
      pdd = pdd * step + 2 * pd;
      pd = pd * step + p;
      p = p * step + newton[k];
    }
    weights[0][datum] = p;
    weights[1][datum] = pd;
    weights[2][datum] = pdd;
  }
  return weights;
}

}  // namespace

void MotionBridge::add(double t, std::span<const double> q, std::span<const double> qd, std::span<const double> qdd) {
  nodes_.push_back({t, {q.begin(), q.end()}, {qd.begin(), qd.end()}, {qdd.begin(), qdd.end()}});
}

double MotionBridge::first() const {
  return std::min_element(nodes_.begin(), nodes_.end(), [](const Node& a, const Node& b) { return a.t < b.t; })->t;
}

double MotionBridge::last() const {
  return std::max_element(nodes_.begin(), nodes_.end(), [](const Node& a, const Node& b) { return a.t < b.t; })->t;
}

void MotionBridge::evaluate(double t, std::span<double> q, std::span<double> qd, std::span<double> qdd) const {
  // In units of the bridge's own length, from its middle: differences of instants keep their digits.
  const double centre = (first() + last()) / 2, unit = nodes_.size() > 1 ? (last() - first()) / 2 : 1;
  std::array<double, capacity> instants{};
  for (std::size_t k = 0; k < nodes_.size(); ++k) instants[k] = (nodes_[k].t - centre) / unit;
  const auto weights = hermite_weights(std::span(instants).first(nodes_.size()), (t - centre) / unit);
  const auto combine = [&](std::span<double> out, const BridgeWeights& w, double factor) {
    std::fill(out.begin(), out.end(), 0.0);
    for (std::size_t k = 0; k < nodes_.size() && !out.empty(); ++k) {
      const double a = factor * w[3 * k], b = factor * unit * w[3 * k + 1], c = factor * unit * unit * w[3 * k + 2];
      const Node& node = nodes_[k];
      for (std::size_t i = 0; i < out.size(); ++i) out[i] += a * node.q[i] + b * node.qd[i] + c * node.qdd[i];
    }
  };
  combine(q, weights[0], 1);
  combine(qd, weights[1], 1 / unit);
  combine(qdd, weights[2], 1 / (unit * unit));
}

}  // namespace catena
