// SpectrumDerivatives: frequencies, and loads of divergence, under forces that have no energy: that turn with their
// bodies, or follow laws of state. K is unsymmetric, and has vectors on its left, w, beside those on its right:
//
//   K v + Phi_q^T mu = omega2 M v,   K^T w + Phi_q^T nu = omega2 M w,   Phi_q v = Phi_q w = 0
//   d omega2 = [ w^T (K_p - omega2 M_p) v + mu^T (Phi_q)_p w + nu^T (Phi_q)_p v ] / (w^T M v)
//
// At a load of divergence omega2 = 0, M does not count, and dP = -h_p / h_P with h what stands in brackets.
// w^T K v = -w^T Q_q v + (lambda^T Phi)_qq, mixed along v and w; Q_q v from force_slopes.hpp, with q_p in it. Rates
// that laws read count at rest, as in K. w^T M v is zero where two frequencies meet, and flutter begins: there v and w
// are those of one double omega2 with a single vector, and by
//
//   h = w^T (K - omega2 M) v + mu^T Phi_q w + nu^T Phi_q v,   dP = -h_p / h_P
//
// the two omega2 part as omega2 +- root(h_p dp + h_P dP), so that h keeps its value where they meet. They are known to
// the root of what P is known to, v and w are therefore found as vectors of the least singular value of the matrix at
// their mean, which is regular in P. Source: Seyranian, Mailybaev, Multiparameter Stability Theory (2003), chapter 2.
#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/sensitivity/spectrum/spectrum_derivatives.hpp"
#include "catena/assembly/design/force_slopes.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

// Where two meet: the vectors move by about this part of omega2, and so does what is made of them.
constexpr double beside_meeting = 1e-11;

}  // namespace

std::vector<double> SpectrumDerivatives::weights_of(Metric metric) {
  if (metric == Metric::lengths) return length_metric(evaluator());
  std::vector<double> weights(at(plan().coordinates()), 0.0);
  for (int c = 0; c < 3 * plan().moving; ++c) weights[at(c)] = groups().front().mechanism.mass(c).v;
  return weights;
}

// K - shift W, or its transpose, W the weights.
bool SpectrumDerivatives::factorize_beside(SaddleSystem& system, double shift, std::span<const double> weight,
                                           bool transpose) {
  return system.factorize(jacobian(), [&] {
    system.tangent().add_stiffness(evaluator(), lambda_, transpose);
    for (int c = 0; c < 3 * plan().moving; ++c) system.add_diagonal(c, -shift * weight[at(c)]);
  });
}

bool SpectrumDerivatives::find_left(double omega2, Metric metric, std::span<const double> v, std::span<double> w,
                                    std::span<double> nu) {
  SaddleSystem system(evaluator().shared_plan(), SaddleBlock::elements);
  const std::vector<double> weight = weights_of(metric);
  double size = std::max(std::abs(omega2), 1e-300);
  if (metric == Metric::lengths) {
    evaluator().visit_stiffness({}, [&](int i, int j, const ElementMatrix& m) {
      visit_entries(plan(), i, j, m, [&](int row, int column, double value) {
        if (row == column) size = std::max(size, std::abs(value) / weight[at(row)]);
      });
    });
  }
  if (!factorize_beside(system, omega2 + inverse_iteration::beside * size, weight, true))
    return fail("the vector on the left of its stiffness was not found");
  std::copy(v.begin(), v.end(), w.begin());
  std::vector<double> next(w.size());
  for (int round = 0; round < inverse_iteration::most_rounds; ++round) {
    for (std::size_t c = 0; c < next.size(); ++c) next[c] = weight[c] * w[c];
    std::fill(nu.begin(), nu.end(), 0.0);
    if (!system.solve(next, nu)) break;
    double largest = 0, change = 0;
    for (std::size_t c = 0; c < next.size(); ++c) {
      if (std::abs(next[c]) > std::abs(largest)) largest = next[c];
    }
    if (!(std::abs(largest) > 0)) break;
    for (double& x : nu) x /= largest;
    for (std::size_t c = 0; c < next.size(); ++c) {
      change = std::max(change, std::abs(next[c] / largest - w[c]));
      w[c] = next[c] / largest;
    }
    if (change <= thresholds::solved) return true;
  }
  return fail("the vector on the left of its stiffness did not settle");
}

// Each solution with the matrix or its transpose is the other vector, but for a part that is the ratio of the least
// singular value to the next.
bool SpectrumDerivatives::find_both(double omega2, std::span<double> v, std::span<double> w, std::span<double> nu) {
  const std::vector<double> weight = weights_of(Metric::masses);
  SaddleSystem right(evaluator().shared_plan(), SaddleBlock::elements),
      left(evaluator().shared_plan(), SaddleBlock::elements);
  const double shift = omega2 * (1 + beside_meeting);
  if (!factorize_beside(right, shift, weight, false) || !factorize_beside(left, shift, weight, true))
    return fail("the vectors of the frequency in which two meet were not found");
  std::vector<double> next(v.size()), multipliers(nu.size());
  double changed = 1;
  for (int round = 0; round < inverse_iteration::most_rounds && changed > thresholds::solved; ++round) {
    for (const bool of_left : {true, false}) {
      const std::span<double> from = of_left ? v : w, to = of_left ? w : v;
      for (std::size_t c = 0; c < next.size(); ++c) next[c] = weight[c] * from[c];
      std::fill(multipliers.begin(), multipliers.end(), 0.0);
      if (!(of_left ? left : right).solve(next, multipliers)) return fail("two frequencies meet in a free motion");
      const double largest =
          *std::max_element(next.begin(), next.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
      if (!(std::abs(largest) > 0)) return fail("the vectors of the frequency in which two meet have no mass");
      changed = 0;
      for (std::size_t c = 0; c < next.size(); ++c) {
        changed = std::max(changed, std::abs(next[c] / largest - to[c]));
        to[c] = next[c] / largest;
      }
      for (std::size_t r = 0; of_left && r < nu.size(); ++r) nu[r] = multipliers[r] / largest;
    }
  }
  return changed <= thresholds::solved || fail("the vectors of the frequency in which two meet did not settle");
}

// Forces that only C++ can make show their slopes in no numbers that move with the parameters.
bool SpectrumDerivatives::knows_slopes() {
  const auto& own = std::get<std::vector<ElementEntry<CustomForce<double>, double>>>(evaluator().model().forces);
  return own.empty() || fail("derivatives of frequencies and loads under forces made in C++ are not built");
}

std::vector<double> SpectrumDerivatives::slopes_of(const TwoVectors& of, double omega2, double scale) {
  std::vector<double> slopes;
  for (Group& group : groups()) {
    const DesignScalar sum = left_and_right(group, of, omega2);
    for (std::size_t p = 0; p < at(group.count); ++p) slopes.push_back(sum.d[p] / scale);
  }
  return slopes;
}

std::optional<std::vector<double>> SpectrumDerivatives::gradient_without_energy(double omega2,
                                                                                std::span<const double> shape,
                                                                                Metric metric) {
  if (!knows_slopes()) return {};
  std::vector<double> v(at(plan().coordinates()), 0.0), w(v), nu(at(plan().rows), 0.0);
  for (int c = 0; c < plan().columns; ++c) v[at(plan().coordinate[at(c)])] = shape[at(c)];
  const std::optional<std::vector<double>> mu = holding_multipliers(omega2, v);
  if (!mu || !find_left(omega2, metric, v, w, nu)) return {};
  double scale = metric == Metric::lengths ? 1 : 0;
  for (int c = 0; metric == Metric::masses && c < 3 * plan().moving; ++c)
    scale += w[at(c)] * groups().front().mechanism.mass(c).v * v[at(c)];
  return slopes_of({v, *mu, w, nu}, omega2, scale);
}

std::optional<std::vector<double>> SpectrumDerivatives::gradient_of_meeting(double omega2,
                                                                            std::span<const double> shape) {
  if (!knows_slopes()) return {};
  std::vector<double> v(at(plan().coordinates()), 0.0), w(v), nu(at(plan().rows), 0.0);
  for (int c = 0; c < plan().columns; ++c) v[at(plan().coordinate[at(c)])] = shape[at(c)];
  if (!find_both(omega2, v, w, nu)) return {};
  const std::optional<std::vector<double>> mu = holding_multipliers(omega2, v);
  if (!mu) return {};
  return slopes_of({v, *mu, w, nu}, omega2, 1);
}

// w^T (K - omega2 M) v + mu^T Phi_q w + nu^T Phi_q v.
DesignScalar SpectrumDerivatives::left_and_right(Group& group, const TwoVectors& of, double omega2) {
  DesignMechanism& mechanism = group.mechanism;
  std::vector<DesignScalar> along(of.v.size());
  const auto look_along = [&](double by_v, double by_w) {
    for (std::size_t c = 0; c < along.size(); ++c) along[c] = DesignScalar(by_v * of.v[c] + by_w * of.w[c]);
    mechanism.set_state(group.q, along);
    mechanism.rows(group.rows);
  };
  DesignScalar sum;
  for (const double sign : {1.0, -1.0}) {
    look_along(1, sign);
    for (std::size_t r = 0; r < of.mu.size(); ++r) sum += DesignScalar(sign / 4) * group.lambda[r] * group.rows[r].dd;
  }
  look_along(0, 1);
  for (std::size_t r = 0; r < of.mu.size(); ++r) sum += DesignScalar(of.mu[r]) * group.rows[r].d;
  look_along(1, 0);
  for (std::size_t r = 0; r < of.mu.size(); ++r) sum += DesignScalar(of.nu[r]) * group.rows[r].d;
  ForceSlopes(evaluator(), mechanism).along(group.loads);
  for (int c = 0; c < 3 * plan().moving; ++c) {
    sum -= DesignScalar(of.w[at(c)]) * group.loads[at(c)];
    sum -= DesignScalar(omega2 * of.v[at(c)] * of.w[at(c)]) * mechanism.mass(c);
  }
  return sum;
}

}  // namespace catena
