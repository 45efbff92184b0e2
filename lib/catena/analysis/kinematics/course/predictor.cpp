#include "catena/analysis/kinematics/course/predictor.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace catena {
namespace {

// Newton's divided differences with repeated nodes: one scheme serves Hermite data of any order and plain points.
// A node holds (instant, derivative); data vectors are addressed symbolically through weights on them.
constexpr int max_nodes = 6;
using Weights = std::array<double, max_nodes>;
// Instants nearer to each other than this part of the way ahead are one: the polynomial through both, whose values
// carry weights of 6 s^5 (qdd known) or 2 s^3 at s times their distance, would amplify their rounding, 2e-16, to more
// than 1e-6: s = (1e10/12)^(1/5) and (1e10/4)^(1/3).
constexpr double one_instant_of_five = 1 / 60.8, one_instant_of_three = 1 / 1357.0;
// Instants that the polynomial goes through where only q is known there, six apart.
constexpr int most_places = 4;
// Six are used where the term of the fifth order is this part of that of the third, so that the errors, of the sixth
// and of the fourth, differ alike. Coordinates of the first bodies tell: a wrong choice costs an iteration.
constexpr double smaller = 0.5;
constexpr std::size_t looked_at = 48;
// Steps shorter than this part of the one ahead: rounding, 2e-16, would be multiplied by (1 + s)^5 at s steps ahead.
constexpr double short_step = 0.25;

struct Nodes {
  int count = 0;
  std::array<double, max_nodes> t{};   // instant of the node
  std::array<int, max_nodes> group{};  // first node of the same instant
};

// Weights of the data in the value and first two derivatives at t of the interpolating polynomial.
std::array<Weights, 3> weights_at(const Nodes& nodes, double t) {
  const int n = nodes.count;
  std::array<Weights, 3> result{};
  for (int datum = 0; datum < n; ++datum) {
    // Divided differences of the data set that is 1 at `datum` and 0 elsewhere.
    std::array<double, max_nodes> f{}, newton{};
    const auto value = [&](int node, int derivative) {
      const int source = nodes.group[static_cast<std::size_t>(node)] + derivative;
      const double factorial = derivative == 2 ? 2 : 1;
      return source == datum ? 1 / factorial : 0.0;
    };
    for (int k = 0; k < n; ++k) f[static_cast<std::size_t>(k)] = value(k, 0);
    newton[0] = f[0];
    for (int order = 1; order < n; ++order) {
      for (int k = 0; k + order < n; ++k) {
        const auto a = static_cast<std::size_t>(k), b = static_cast<std::size_t>(k + order);
        const bool same = nodes.t[a] == nodes.t[b];
        f[a] = same ? value(k, order) : (f[a + 1] - f[a]) / (nodes.t[b] - nodes.t[a]);
      }
      newton[static_cast<std::size_t>(order)] = f[0];
    }
    // Horner with derivatives.
    double p = 0, pd = 0, pdd = 0;
    for (int k = n - 1; k >= 0; --k) {
      const double x = t - nodes.t[static_cast<std::size_t>(k)];
      pdd = pdd * x + 2 * pd;
      pd = pd * x + p;
      p = p * x + newton[static_cast<std::size_t>(k)];
    }
    const auto d = static_cast<std::size_t>(datum);
    result[0][d] = p;
    result[1][d] = pd;
    result[2][d] = pdd;
  }
  return result;
}

/// Weights of q at six instants, the last one first: in the polynomials through four and through all of them, and in
/// their terms of the third and fifth order,  [q_0 ... q_k] (t - t_0) ... (t - t_k-1).
struct Places {
  std::array<double, max_nodes> t{};
  Weights four{}, six{}, third{}, fifth{};

  bool are_apart(double ahead) const {
    const double way = ahead - t[0];
    bool apart = true;
    for (std::size_t k = 0; k + 1 < t.size(); ++k) apart &= (t[k] - t[k + 1]) * way > short_step * way * way;
    return apart;
  }
  void weigh(double ahead) {
    const auto way = [&](std::size_t k) { return ahead - t[k]; };
    const double of_third = way(0) * way(1) * way(2), of_fifth = of_third * way(3) * way(4);
    const double of_four = of_third * way(3), of_six = of_fifth * way(5);
    for (std::size_t k = 0; k < t.size(); ++k) {
      const auto apart = [&](std::size_t j) { return j == k ? 1 : t[k] - t[j]; };
      const double before = apart(0) * apart(1) * apart(2) * apart(3);
      const double inverse = 1 / before, of_all = inverse / (apart(4) * apart(5)), part = 1 / way(k);
      if (k < 4) third[k] = of_third * inverse, four[k] = of_four * inverse * part;
      fifth[k] = of_fifth * of_all;
      six[k] = of_six * of_all * part;
    }
  }
};

}  // namespace

Predictor::Predictor(std::size_t size) : ring_(capacity), rates_(rate_capacity) {
  for (Instant& instant : ring_) instant.q.resize(size);
  for (Rates& rates : rates_) rates.qd.resize(size), rates.qdd.resize(size);
}

void Predictor::push(double t, std::span<const double> q, std::span<const double> qd, std::span<const double> qdd) {
  if (count_ == 0 || back(0).t != t) {
    head_ = (head_ + 1) % capacity;
    count_ = std::min(count_ + 1, capacity);
  }
  Instant& instant = ring_[static_cast<std::size_t>(head_)];
  Rates& rates = rates_[static_cast<std::size_t>(head_ % rate_capacity)];
  instant.t = t;
  instant.derivatives = qd.empty() ? 0 : qdd.empty() ? 1 : 2;
  std::copy(q.begin(), q.end(), instant.q.begin());
  std::copy(qd.begin(), qd.end(), rates.qd.begin());
  std::copy(qdd.begin(), qdd.end(), rates.qdd.begin());
}

// Six instants at which only q is known, of steps that were not much shorter than the one ahead; false: others.
bool Predictor::predict_from_places(double t, std::span<double> q) const {
  if (count_ < max_nodes) return false;
  Places places;
  std::array<const double*, max_nodes> data{};
  for (int k = 0; k < max_nodes; ++k) {
    if (derivatives(k) > 0) return false;
    places.t[static_cast<std::size_t>(k)] = back(k).t;
    data[static_cast<std::size_t>(k)] = back(k).q.data();
  }
  if (!places.are_apart(t)) return false;
  places.weigh(t);
  const double *a = data[0], *b = data[1], *c = data[2], *d = data[3], *e = data[4], *f = data[5];
  const auto sum = [&](const Weights& w, std::size_t i) {
    return w[0] * a[i] + w[1] * b[i] + w[2] * c[i] + w[3] * d[i] + w[4] * e[i] + w[5] * f[i];
  };
  double third[3] = {}, fifth[3] = {};
  const Weights& w3 = places.third;
  for (std::size_t first = 0; first + 3 <= std::min(q.size(), looked_at); first += 3) {
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t i = first + k;
      third[k] += std::abs(w3[0] * a[i] + w3[1] * b[i] + w3[2] * c[i] + w3[3] * d[i]);
      fifth[k] += std::abs(sum(places.fifth, i));
    }
  }
  const auto shrink = [&](int kind) { return fifth[kind] <= smaller * third[kind]; };
  const Weights& w = shrink(0) && shrink(1) && shrink(2) ? places.six : places.four;
  for (std::size_t i = 0; i < q.size(); ++i) q[i] = sum(w, i);
  return true;
}

bool Predictor::predict(double t, std::span<double> q, std::span<double> qd, std::span<double> qdd) const {
  if (count_ == 0) return false;
  if (qd.empty() && qdd.empty() && predict_from_places(t, q)) return true;
  // With derivatives two instants suffice; without, up to four.
  const int instants = std::min(count_, back(0).derivatives > 0 ? 2 : most_places);
  const double one_instant = back(0).derivatives == 2 ? one_instant_of_five : one_instant_of_three;
  Nodes nodes;
  std::array<const double*, max_nodes> data{};
  for (int k = 0, taken = 0; k < count_ && taken < instants; ++k) {
    const Instant& instant = back(k);
    const auto* const first = nodes.t.data();
    const auto near = [&](double other) { return std::abs(other - instant.t) < one_instant * std::abs(t - back(0).t); };
    if (std::any_of(first, first + nodes.count, near)) continue;
    ++taken;
    const int group = nodes.count;
    for (int d = 0; d <= derivatives(k) && nodes.count < max_nodes; ++d) {
      const auto n = static_cast<std::size_t>(nodes.count++);
      nodes.t[n] = instant.t;
      nodes.group[n] = group;
      data[n] = (d == 0 ? instant.q : d == 1 ? rates(k).qd : rates(k).qdd).data();
    }
  }
  const auto weights = weights_at(nodes, t);
  // Always six terms, those without data with weight zero: a fixed count lets the compiler vectorise over entries.
  for (int k = nodes.count; k < max_nodes; ++k) data[static_cast<std::size_t>(k)] = data[0];
  const double *a = data[0], *b = data[1], *c = data[2], *d = data[3], *e = data[4], *f = data[5];
  const auto sum = [&](const Weights& w, std::size_t i) {
    return w[0] * a[i] + w[1] * b[i] + w[2] * c[i] + w[3] * d[i] + w[4] * e[i] + w[5] * f[i];
  };
  // In one pass if all are needed: the cost in a large scene is that of reading the data.
  double *position = q.data(), *velocity = qd.data(), *acceleration = qdd.data();
  if (!q.empty() && !qd.empty() && !qdd.empty()) {
    for (std::size_t i = 0; i < q.size(); ++i) {
      const double x = sum(weights[0], i), v = sum(weights[1], i), w = sum(weights[2], i);
      position[i] = x, velocity[i] = v, acceleration[i] = w;
    }
    return true;
  }
  for (std::size_t i = 0; i < q.size(); ++i) position[i] = sum(weights[0], i);
  for (std::size_t i = 0; i < qd.size(); ++i) velocity[i] = sum(weights[1], i);
  for (std::size_t i = 0; i < qdd.size(); ++i) acceleration[i] = sum(weights[2], i);
  return true;
}

}  // namespace catena
