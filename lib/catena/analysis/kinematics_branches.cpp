#include "catena/analysis/kinematics_branches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <random>

#include "catena/analysis/scaling.hpp"
#include "catena/assembly/constraint_projector.hpp"
#include "catena/linalg/rank_revealing.hpp"

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

// Coefficients below this part of the terms they are made of are zero.
constexpr double vanishing = 1e-6;
// Roots closer than this, in units of the motion's own rates, are the same; double roots are found no sharper.
constexpr double same_root = 1e-3;
constexpr std::size_t most_branches = 64;
constexpr int starts_per_root = 40;
constexpr int most_iterations = 60;

/// Quadratic polynomials F_i(a) = c_i + L_i a + a^T Q_i a in k unknowns.
struct Quadratics {
  std::size_t k = 0;
  std::vector<double> constant;                // per polynomial
  std::vector<std::vector<double>> linear;     // k each
  std::vector<std::vector<double>> quadratic;  // k x k each, symmetric

  void evaluate(std::span<const double> a, std::vector<double>& f, std::vector<double>& jacobian) const {
    f.assign(constant.size(), 0);
    jacobian.assign(constant.size() * k, 0);
    for (std::size_t i = 0; i < constant.size(); ++i) {
      f[i] = constant[i];
      for (std::size_t j = 0; j < k; ++j) {
        double row = 0;
        for (std::size_t l = 0; l < k; ++l) row += quadratic[i][j * k + l] * a[l];
        f[i] += a[j] * (linear[i][j] + row);
        jacobian[i * k + j] = linear[i][j] + 2 * row;
      }
    }
  }
};

double square_sum(std::span<const double> x) {
  double sum = 0;
  for (double value : x) sum += value * value;
  return sum;
}

/// Solves (J^T J + damping I) x = -J^T f by elimination with pivots; J has k columns.
std::vector<double> damped_step(const std::vector<double>& jacobian, const std::vector<double>& f, std::size_t k,
                                double damping) {
  std::vector<double> m(k * (k + 1), 0.0);
  for (std::size_t r = 0; r < k; ++r) {
    for (std::size_t c = 0; c < k; ++c) {
      for (std::size_t i = 0; i < f.size(); ++i) m[r * (k + 1) + c] += jacobian[i * k + r] * jacobian[i * k + c];
    }
    m[r * (k + 1) + r] += damping;
    for (std::size_t i = 0; i < f.size(); ++i) m[r * (k + 1) + k] -= jacobian[i * k + r] * f[i];
  }
  for (std::size_t p = 0; p < k; ++p) {
    std::size_t best = p;
    for (std::size_t r = p + 1; r < k; ++r) {
      if (std::abs(m[r * (k + 1) + p]) > std::abs(m[best * (k + 1) + p])) best = r;
    }
    for (std::size_t c = 0; c <= k; ++c) std::swap(m[p * (k + 1) + c], m[best * (k + 1) + c]);
    for (std::size_t r = 0; r < k; ++r) {
      if (r == p) continue;
      const double factor = m[r * (k + 1) + p] / m[p * (k + 1) + p];
      for (std::size_t c = p; c <= k; ++c) m[r * (k + 1) + c] -= factor * m[p * (k + 1) + c];
    }
  }
  std::vector<double> x(k);
  for (std::size_t r = 0; r < k; ++r) x[r] = m[r * (k + 1) + k] / m[r * (k + 1) + r];
  return x;
}

/// Levenberg-Marquardt from `a`; true at a root.
bool solve_from(const Quadratics& system, std::vector<double>& a) {
  std::vector<double> f, jacobian, trial, trial_f, trial_jacobian;
  system.evaluate(a, f, jacobian);
  double now = square_sum(f), damping = 1e-6;
  for (int iteration = 0; iteration < most_iterations && now > 1e-30; ++iteration) {
    const std::vector<double> step = damped_step(jacobian, f, system.k, damping);
    trial = a;
    for (std::size_t j = 0; j < system.k; ++j) trial[j] += step[j];
    system.evaluate(trial, trial_f, trial_jacobian);
    const double then = square_sum(trial_f);
    if (!(then < now)) {
      damping = std::max(10 * damping, 1e-12);
      if (damping > 1e6) break;
      continue;
    }
    damping /= 10;
    a = trial;
    f = trial_f;
    jacobian = trial_jacobian;
    now = then;
  }
  return now < vanishing * vanishing;
}

/// The real roots; `first` is taken as one, unless empty. Sorted by their distance from the first.
std::vector<std::vector<double>> real_roots(const Quadratics& system, const std::vector<double>& first) {
  std::vector<std::vector<double>> roots;
  if (!first.empty()) roots.push_back(first);
  const auto distance = [](const std::vector<double>& a, const std::vector<double>& b) {
    double sum = 0;
    for (std::size_t j = 0; j < a.size(); ++j) sum += (a[j] - b[j]) * (a[j] - b[j]);
    return std::sqrt(sum);
  };
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const int starts = starts_per_root << system.k;
  for (int s = 0; s < starts && roots.size() < most_branches; ++s) {
    std::vector<double> a(system.k);
    const double reach = std::exp(1.5 * normal(random));
    for (double& value : a) value = reach * normal(random);
    if (!solve_from(system, a)) continue;
    const double size = 1 + std::sqrt(square_sum(a));
    const bool known =
        std::any_of(roots.begin(), roots.end(), [&](const auto& root) { return distance(root, a) < same_root * size; });
    if (!known && size < 1e6) roots.push_back(a);
  }
  if (roots.empty()) return roots;
  const std::vector<double> origin = first.empty() ? std::vector<double>(system.k, 0.0) : first;
  std::stable_sort(roots.begin(), roots.end(),
                   [&](const auto& a, const auto& b) { return distance(a, origin) < distance(b, origin); });
  return roots;
}

/// What the search works on: Phi_q at the singular configuration and its null spaces.
struct NullSpaces {
  RankReport rank;
  std::vector<double> values;
  std::vector<std::vector<double>> z;  // right null vectors by coordinate, largest entry (rad, length scales) one
};

NullSpaces find_null_spaces(Evaluator& evaluator, std::span<const double> q, double threshold) {
  const Plan& plan = evaluator.plan();
  NullSpaces spaces;
  spaces.values.resize(at(plan.trash_slot()) + 1);
  evaluator.start_jacobian(spaces.values);
  evaluator.set_configuration(q);
  evaluator.jacobian(spaces.values);
  RankOptions options;
  options.tolerance = threshold;
  spaces.rank =
      reveal_rank(plan.jacobian, std::span<const double>(spaces.values).first(at(plan.trash_slot())), options);
  const SparseVectors& vectors = spaces.rank.right_null_vectors;
  for (int k = 0; k < vectors.count(); ++k) {
    std::vector<double> z(at(plan.coordinates()), 0.0);
    double largest = 0;
    for (std::size_t n = 0; n < vectors.indices(k).size(); ++n) {
      const int coordinate = plan.coordinate[at(vectors.indices(k)[n])];
      const double value = vectors.values(k)[n];
      z[at(coordinate)] = value;
      largest = std::max(largest, std::abs(value) / (coordinate % 3 == 2 ? 1 : evaluator.length_scale()));
    }
    for (double& value : z) value /= largest;
    spaces.z.push_back(std::move(z));
  }
  return spaces;
}

/// w_i^T gamma(qd0 + rate sum a_j z_j) / rate^2; with `resting` less what it is for qd = 0.
Quadratics make_quadratics(Evaluator& evaluator, const NullSpaces& spaces, std::span<const double> qd0, double rate,
                           bool resting) {
  const Plan& plan = evaluator.plan();
  const std::size_t k = spaces.z.size();
  const auto count = at(spaces.rank.left_null_vectors.count());
  std::vector<double> gamma(at(plan.rows)), qd(qd0.begin(), qd0.end());
  std::vector<double> size(count, 0.0);  // of the terms
  const auto values_at = [&](std::span<const double> a) {
    for (std::size_t c = 0; c < qd.size(); ++c) {
      qd[c] = qd0[c];
      for (std::size_t j = 0; j < k; ++j) qd[c] += rate * a[j] * spaces.z[j][c];
    }
    evaluator.gamma(qd, gamma);
    std::vector<double> f(count, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
      const auto rows = spaces.rank.left_null_vectors.indices(static_cast<int>(i));
      const auto weights = spaces.rank.left_null_vectors.values(static_cast<int>(i));
      double terms = 0;
      for (std::size_t n = 0; n < rows.size(); ++n) {
        f[i] += weights[n] * gamma[at(rows[n])] / (rate * rate);
        terms += std::abs(weights[n] * gamma[at(rows[n])]) / (rate * rate);
      }
      size[i] = std::max(size[i], terms);
    }
    return f;
  };
  std::vector<double> a(k, 0.0);
  const std::vector<double> centre = values_at(a);
  std::vector<std::vector<double>> plus(k), minus(k);
  for (std::size_t j = 0; j < k; ++j) {
    a[j] = 1;
    plus[j] = values_at(a);
    a[j] = -1;
    minus[j] = values_at(a);
    a[j] = 0;
  }
  Quadratics all;
  all.k = k;
  std::vector<std::vector<double>> mixed(count, std::vector<double>(k * k, 0.0));
  for (std::size_t j = 0; j < k; ++j) {
    for (std::size_t l = 0; l < j; ++l) {
      a[j] = a[l] = 1;
      const std::vector<double> both = values_at(a);
      a[j] = a[l] = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const double twice = both[i] - plus[j][i] - plus[l][i] + centre[i];
        mixed[i][j * k + l] = mixed[i][l * k + j] = twice / 2;
      }
    }
    for (std::size_t i = 0; i < count; ++i) mixed[i][j * k + j] = (plus[j][i] + minus[j][i]) / 2 - centre[i];
  }
  std::vector<double> still(count, 0.0);
  if (resting) {
    // What the drivers' own accelerations add is no condition on the direction.
    const std::vector<double> nothing(qd.size(), 0.0);
    evaluator.gamma(nothing, gamma);
    for (std::size_t i = 0; i < count; ++i) {
      const auto rows = spaces.rank.left_null_vectors.indices(static_cast<int>(i));
      const auto weights = spaces.rank.left_null_vectors.values(static_cast<int>(i));
      for (std::size_t n = 0; n < rows.size(); ++n) still[i] += weights[n] * gamma[at(rows[n])] / (rate * rate);
    }
  }
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> linear(k);
    double largest = 0;
    for (std::size_t j = 0; j < k; ++j) {
      linear[j] = (plus[j][i] - minus[j][i]) / 2;
      largest = std::max(largest, std::abs(linear[j]));
    }
    for (double value : mixed[i]) largest = std::max(largest, std::abs(value));
    // Rows that repeat others ask for nothing.
    if (!(largest > vanishing * size[i])) continue;
    all.constant.push_back((centre[i] - still[i]) / largest);
    for (double& value : linear) value /= largest;
    for (double& value : mixed[i]) value /= largest;
    all.linear.push_back(std::move(linear));
    all.quadratic.push_back(std::move(mixed[i]));
  }
  return all;
}

/// Bodies ordered by `share`, those with less than a thousandth of the largest left out.
std::vector<int> most_concerned(std::span<const double> share, std::size_t most) {
  std::vector<int> bodies(share.size());
  double largest = 0;
  for (std::size_t b = 0; b < share.size(); ++b) bodies[b] = static_cast<int>(b), largest = std::max(largest, share[b]);
  std::stable_sort(bodies.begin(), bodies.end(), [&](int a, int b) { return share[at(a)] > share[at(b)]; });
  std::size_t kept = 0;
  while (kept < bodies.size() && kept < most && share[at(bodies[kept])] > 1e-3 * largest && largest > 0) ++kept;
  bodies.resize(kept);
  return bodies;
}

/// The bodies whose velocities tell the branches apart, and what they are, per branch.
void put_into_words(const Evaluator& evaluator, SingularPoint& point) {
  const Plan& plan = evaluator.plan();
  const double length = evaluator.length_scale();
  std::vector<double> spread(at(plan.moving), 0.0);
  std::vector<char> turns(at(plan.moving), 0);
  for (int b = 0; b < plan.moving; ++b) {
    double low[3], high[3];
    for (int c = 0; c < 3; ++c) {
      low[c] = high[c] = point.tangents.front()[at(3 * b + c)];
      for (const auto& tangent : point.tangents) {
        low[c] = std::min(low[c], tangent[at(3 * b + c)]);
        high[c] = std::max(high[c], tangent[at(3 * b + c)]);
      }
    }
    const double along = std::max(high[0] - low[0], high[1] - low[1]) / length, angular = high[2] - low[2];
    turns[at(b)] = angular >= 1e-3 * along;
    spread[at(b)] = std::max(along, angular);
  }
  const std::vector<int> bodies = most_concerned(spread, 3);
  double largest = 0;
  for (int b : bodies) largest = std::max(largest, spread[at(b)]);
  const auto clean = [&](double value) { return std::abs(value) < 1e-9 * largest ? 0.0 : value; };
  for (const auto& tangent : point.tangents) {
    std::string text;
    for (int b : bodies) {
      const double* v = &tangent[at(3 * b)];
      const std::string name(evaluator.model().body_name(plan.model_body[at(b)]));
      text += text.empty() ? "" : ", ";
      text += turns[at(b)] ? fmt::format("\"{}\" turns at {:.4g} rad/s", name, clean(v[2]))
                           : fmt::format("\"{}\" moves at ({:.4g}, {:.4g}) m/s", name, clean(v[0]), clean(v[1]));
    }
    point.branches.push_back(text.empty() ? "all bodies as before" : text);
  }
}

}  // namespace

std::string_view SingularPoint::kind_name() const {
  switch (kind) {
    case Kind::branch_point:
      return "branch_point";
    case Kind::tangency:
      return "tangency";
    case Kind::rest:
      return "rest";
    case Kind::isolated:
      return "isolated";
    case Kind::lock_up:
      return "lock_up";
  }
  return {};
}

std::string SingularPoint::describe_branches() const {
  constexpr std::size_t most = 8;
  std::string text;
  for (std::size_t k = 0; k < branches.size() && k < most; ++k) {
    text += fmt::format("{}branch {}: {}", text.empty() ? "" : "; ", k + 1, branches[k]);
  }
  if (branches.size() > most) text += fmt::format("; and {} more", branches.size() - most);
  return text;
}

SingularPoint find_branches(Evaluator& evaluator, std::span<const double> q, std::span<const double> along,
                            double threshold) {
  const Plan& plan = evaluator.plan();
  SingularPoint point;
  point.t = evaluator.time();
  point.q.assign(q.begin(), q.end());
  const NullSpaces spaces = find_null_spaces(evaluator, q, threshold);
  point.nullity = plan.columns - spaces.rank.rank;
  std::vector<double> share(at(plan.moving), 0.0);
  for (const auto& z : spaces.z) {
    for (int b = 0; b < plan.moving; ++b) {
      const double shift = std::max(std::abs(z[at(3 * b)]), std::abs(z[at(3 * b + 1)])) / evaluator.length_scale();
      share[at(b)] = std::max({share[at(b)], shift, std::abs(z[at(3 * b + 2)])});
    }
  }
  for (int b : most_concerned(share, 10)) {
    point.bodies.emplace_back(evaluator.model().body_name(plan.model_body[at(b)]));
  }
  // A particular velocity, the least, if none is known.
  std::vector<double> nu(at(plan.rows)), qd0(at(plan.coordinates()), 0.0);
  evaluator.nu(nu);
  if (!along.empty()) {
    qd0.assign(along.begin(), along.end());
  } else if (plan.rows > 0) {
    ConstraintProjector projector(evaluator.shared_plan());
    std::vector<double> inverse(at(plan.columns)), x(at(plan.columns)), lambda(at(plan.rows));
    const double square = evaluator.length_scale() * evaluator.length_scale();
    for (int c = 0; c < plan.columns; ++c) inverse[at(c)] = plan.coordinate[at(c)] % 3 == 2 ? 1 / square : 1;
    projector.set_inverse_weights(inverse);
    if (projector.factorize(spaces.values, evaluator.counters).ok()) projector.solve(nu, x, lambda, evaluator.counters);
    for (int c = 0; c < plan.columns; ++c) qd0[at(plan.coordinate[at(c)])] = x[at(c)];
  }
  double rate = 0;
  for (int c = 0; c < 3 * plan.moving; ++c) {
    rate = std::max(rate, std::abs(qd0[at(c)]) / (c % 3 == 2 ? 1 : evaluator.length_scale()));
  }
  const bool searchable = !spaces.z.empty() && point.nullity <= most_nullity && std::isfinite(rate);
  if (!searchable) {
    if (!along.empty()) point.tangents.push_back(qd0);
    return point;
  }
  // Whether a null vector can be followed with the drivers at rest: w^T gamma is then zero for it.
  const std::vector<double> nothing(qd0.size(), 0.0);
  const Quadratics still = make_quadratics(evaluator, spaces, nothing, 1, true);
  point.held_to_second_order = true;
  for (std::size_t j = 0; j < still.k; ++j) {
    bool held = false;
    for (const auto& quadratic : still.quadratic) held = held || std::abs(quadratic[j * still.k + j]) > vanishing;
    point.held_to_second_order = point.held_to_second_order && held;
  }
  double largest_nu = 0;
  for (double value : nu) largest_nu = std::max(largest_nu, std::abs(value));
  if (!(rate > 0) || largest_nu == 0) {
    point.kind = SingularPoint::Kind::rest;
    point.tangents.push_back(qd0);
    return point;
  }
  const Quadratics system = make_quadratics(evaluator, spaces, qd0, rate, false);
  std::vector<double> first;
  if (!along.empty()) first.assign(system.k, 0.0);
  for (const auto& root : real_roots(system, first)) {
    std::vector<double> tangent = qd0;
    for (std::size_t c = 0; c < tangent.size(); ++c) {
      for (std::size_t j = 0; j < system.k; ++j) tangent[c] += rate * root[j] * spaces.z[j][c];
    }
    point.tangents.push_back(std::move(tangent));
  }
  point.kind = point.tangents.empty()       ? SingularPoint::Kind::isolated
               : point.tangents.size() == 1 ? SingularPoint::Kind::tangency
                                            : SingularPoint::Kind::branch_point;
  if (point.tangents.size() > 1) put_into_words(evaluator, point);
  return point;
}

}  // namespace catena
