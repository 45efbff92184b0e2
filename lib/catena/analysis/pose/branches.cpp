#include "catena/analysis/pose/branches.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/pose/quadratics.hpp"
#include "catena/assembly/systems/constraint_solver.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double vanishing = Quadratics::vanishing;

/// f_i(a) = w_i^T gamma(qd0 + rate sum a_j z_j) / rate^2, quadratic in a.
class Conditions {
 public:
  /// All must outlive this object.
  Conditions(Evaluator& evaluator, const NullSpaces& spaces, std::span<const double> qd0, double rate)
      : evaluator_(evaluator),
        spaces_(spaces),
        qd0_(qd0),
        rate_(rate),
        qd_(qd0.begin(), qd0.end()),
        gamma_(at(evaluator.plan().rows)),
        sizes_(at(spaces.rank.left_null_vectors.count()), 0.0) {}

  std::size_t count() const { return sizes_.size(); }
  std::vector<double> at_weights(std::span<const double> a) {
    for (std::size_t c = 0; c < qd_.size(); ++c) {
      qd_[c] = qd0_[c];
      for (std::size_t j = 0; j < a.size(); ++j) qd_[c] += rate_ * a[j] * spaces_.z[j][c];
    }
    evaluator_.gamma(qd_, gamma_);
    std::vector<double> f = of(gamma_);
    for (std::size_t i = 0; i < f.size(); ++i) {
      double terms = 0;
      visit(i, [&](double weight, std::size_t row) { terms += std::abs(weight * gamma_[row]) / (rate_ * rate_); });
      sizes_[i] = std::max(sizes_[i], terms);
    }
    return f;
  }
  /// w_i^T r / rate^2.
  std::vector<double> of(std::span<const double> r) const {
    std::vector<double> f(count(), 0.0);
    for (std::size_t i = 0; i < f.size(); ++i) {
      visit(i, [&](double weight, std::size_t row) { f[i] += weight * r[row] / (rate_ * rate_); });
    }
    return f;
  }
  /// The largest sum of terms that condition i was made of so far.
  double size(std::size_t i) const { return sizes_[i]; }

 private:
  template <class F>
  void visit(std::size_t i, F&& f) const {
    const auto rows = spaces_.rank.left_null_vectors.indices(static_cast<int>(i));
    const auto weights = spaces_.rank.left_null_vectors.values(static_cast<int>(i));
    for (std::size_t n = 0; n < rows.size(); ++n) f(weights[n], at(rows[n]));
  }

  Evaluator& evaluator_;
  const NullSpaces& spaces_;
  std::span<const double> qd0_;
  double rate_;
  std::vector<double> qd_, gamma_, sizes_;
};

/// w_i^T (gamma(qd0 + rate sum a_j z_j) - own) / rate^2, from values at points where one or two of the a_j are not
/// zero; `own`: what is no condition on the direction, empty: nothing.
Quadratics make_quadratics(Evaluator& evaluator, const NullSpaces& spaces, std::span<const double> qd0, double rate,
                           std::span<const double> own) {
  Conditions conditions(evaluator, spaces, qd0, rate);
  const std::size_t k = spaces.z.size(), count = conditions.count();
  std::vector<double> a(k, 0.0);
  const std::vector<double> centre = conditions.at_weights(a);
  std::vector<std::vector<double>> plus(k), minus(k);
  for (std::size_t j = 0; j < k; ++j) {
    a[j] = 1;
    plus[j] = conditions.at_weights(a);
    a[j] = -1;
    minus[j] = conditions.at_weights(a);
    a[j] = 0;
  }
  std::vector<std::vector<double>> mixed(count, std::vector<double>(k * k, 0.0));
  for (std::size_t j = 0; j < k; ++j) {
    for (std::size_t l = 0; l < j; ++l) {
      a[j] = a[l] = 1;
      const std::vector<double> both = conditions.at_weights(a);
      a[j] = a[l] = 0;
      for (std::size_t i = 0; i < count; ++i) {
        const double twice = both[i] - plus[j][i] - plus[l][i] + centre[i];
        mixed[i][j * k + l] = mixed[i][l * k + j] = twice / 2;
      }
    }
    for (std::size_t i = 0; i < count; ++i) mixed[i][j * k + j] = (plus[j][i] + minus[j][i]) / 2 - centre[i];
  }
  const std::vector<double> still = own.empty() ? std::vector<double>(count, 0.0) : conditions.of(own);
  Quadratics all;
  all.k = k;
  for (std::size_t i = 0; i < count; ++i) {
    std::vector<double> linear(k);
    double largest = 0;
    for (std::size_t j = 0; j < k; ++j) {
      linear[j] = (plus[j][i] - minus[j][i]) / 2;
      largest = std::max(largest, std::abs(linear[j]));
    }
    for (double value : mixed[i]) largest = std::max(largest, std::abs(value));
    // Redundant equations add no condition.
    if (!(largest > vanishing * conditions.size(i))) continue;
    all.constant.push_back((centre[i] - still[i]) / largest);
    for (double& value : linear) value /= largest;
    for (double& value : mixed[i]) value /= largest;
    all.linear.push_back(std::move(linear));
    all.quadratic.push_back(std::move(mixed[i]));
  }
  return all;
}

/// The speed of the fastest driver, m/s or rad/s; the accelerations of all of them go to their rows of `own`, of other
/// rows zero.
double largest_driver_speed(const Evaluator& evaluator, std::span<double> own) {
  const Plan& plan = evaluator.plan();
  double speed = 0;
  for (int r = 0; r < plan.rows; ++r) {
    const int element = plan.row_element[at(r)];
    own[at(r)] = 0;
    if (evaluator.model().elements[at(element)].kind != ElementKind::driver) continue;
    // In the solver's rows those of squared distances have the second derivative of c as others have.
    const Taylor<double> value = evaluator.element_value(element);
    own[at(r)] = value.dd;
    speed = std::max(speed, std::abs(value.d));
  }
  return speed;
}

/// The bodies whose velocities tell the branches apart, and what they are, per branch.
void put_into_words(const Evaluator& evaluator, SingularPoint& point) {
  const Plan& plan = evaluator.plan();
  const double length = evaluator.length_scale();
  std::vector<double> spread(at(plan.moving), 0.0);
  std::vector<char> turns(at(plan.moving), 0);
  const bool alone = point.tangents.size() == 1;  // nothing to be told apart from but rest
  for (int b = 0; b < plan.moving; ++b) {
    double low[3], high[3];
    for (int c = 0; c < 3; ++c) {
      low[c] = high[c] = alone ? 0 : point.tangents.front()[at(3 * b + c)];
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
    point.branches.push_back(!text.empty() ? text : alone ? "all bodies at rest" : "all bodies as before");
  }
}

/// Whether no null vector can be followed with the drivers at rest: w^T gamma, which is quadratic in velocities, does
/// not vanish for any of them. `own`: gamma at rest.
bool is_held(Evaluator& evaluator, const NullSpaces& spaces, std::span<const double> own) {
  std::vector<double> gamma(own.size());
  return std::all_of(spaces.z.begin(), spaces.z.end(), [&](const std::vector<double>& z) {
    evaluator.gamma(z, gamma);
    for (std::size_t r = 0; r < gamma.size(); ++r) gamma[r] -= own[r];
    return most_opposed(evaluator, spaces.rank, gamma).part > vanishing;
  });
}

/// The least velocity that nu allows.
std::vector<double> least_velocity_for(Evaluator& evaluator, const NullSpaces& spaces, std::span<const double> nu) {
  const Plan& plan = evaluator.plan();
  std::vector<double> qd(at(plan.coordinates()), 0.0), weights(at(3 * plan.moving), 1.0), lambda(at(plan.rows));
  if (plan.rows == 0) return qd;
  ConstraintSolver solver(evaluator.shared_plan());
  for (std::size_t c = 2; c < weights.size(); c += 3) weights[c] = evaluator.length_scale() * evaluator.length_scale();
  solver.set_metric(weights);
  if (solver.factorize(spaces.values, evaluator.counters))
    solver.solve(nu, std::span(qd).first(weights.size()), lambda, evaluator.counters);
  return qd;
}

/// The largest entry of rates of moving bodies, in length scales or rad.
double largest_of_rates(const Evaluator& evaluator, std::span<const double> qd) {
  double rate = 0;
  for (int c = 0; c < 3 * evaluator.plan().moving; ++c) {
    rate = std::max(rate, std::abs(qd[at(c)]) / (c % 3 == 2 ? 1 : evaluator.length_scale()));
  }
  return rate;
}

/// The rate at which drivers that rest for an instant leave a dead point: square root of the largest entry of gamma.
double rate_of_leaving(const Evaluator& evaluator, std::span<const double> own) {
  const Plan& plan = evaluator.plan();
  double gain = 0;
  for (int r = 0; r < plan.rows; ++r) {
    gain = std::max(gain, std::abs(own[at(r)]) / (plan.row_is_angle[at(r)] ? 1 : evaluator.length_scale()));
  }
  return std::sqrt(gain);
}

/// The velocities qd0 + rate sum a_j z_j with which the motion may go on, for drivers of this speed. `along`: qd0 is
/// that of the motion, and comes first.
void find_tangents(Evaluator& evaluator, const NullSpaces& spaces, std::span<const double> qd0, bool along, double rate,
                   std::span<const double> own, double speed, SingularPoint& point) {
  const Quadratics system = make_quadratics(evaluator, spaces, qd0, rate, own);
  std::vector<double> first;
  if (along) first.assign(system.k, 0.0);
  for (const auto& root : real_roots(system, first)) {
    std::vector<double> tangent(qd0.begin(), qd0.end());
    for (std::size_t c = 0; c < tangent.size(); ++c) {
      for (std::size_t j = 0; j < system.k; ++j) tangent[c] += rate * root[j] * spaces.z[j][c];
      tangent[c] /= speed;
    }
    point.tangents.push_back(std::move(tangent));
  }
  point.kind = point.tangents.empty()       ? SingularPoint::Kind::isolated
               : point.tangents.size() == 1 ? SingularPoint::Kind::tangency
                                            : SingularPoint::Kind::branch_point;
  if (!point.tangents.empty()) put_into_words(evaluator, point);
}

}  // namespace

SingularPoint find_branches(Evaluator& evaluator, std::span<const double> q, std::span<const double> along,
                            double threshold, Drivers drivers) {
  const Plan& plan = evaluator.plan();
  SingularPoint point;
  point.t = evaluator.time();
  point.q.assign(q.begin(), q.end());
  const NullSpaces spaces = find_null_spaces(evaluator, q, threshold);
  point.nullity = plan.columns - spaces.rank.rank;
  point.name_bodies(evaluator, spaces.z);
  std::vector<double> nu(at(plan.rows)), own(at(plan.rows));
  evaluator.nu(nu);
  const Opposed opposed = most_opposed(evaluator, spaces.rank, nu);
  point.find_driver(evaluator, opposed.w, nu);
  evaluator.gamma(std::vector<double>(at(plan.coordinates()), 0.0), own);
  point.held_to_second_order = !spaces.z.empty() && is_held(evaluator, spaces, own);
  if (along.empty() && opposed.part > clear_disagreement) {
    point.kind = SingularPoint::Kind::lock_up;
    return point;
  }
  // A particular velocity: the least one if none is known.
  const std::vector<double> qd0 =
      along.empty() ? least_velocity_for(evaluator, spaces, nu) : std::vector<double>(along.begin(), along.end());
  double rate = largest_of_rates(evaluator, qd0);
  if (spaces.z.empty() || point.nullity > most_nullity || !std::isfinite(rate)) {
    if (!along.empty()) point.tangents.push_back(qd0);
    return point;
  }
  double largest_nu = 0;
  for (double value : nu) largest_nu = std::max(largest_nu, std::abs(value));
  // Drivers that rest only for an instant may leave a dead point at once: w^T gamma = 0 then requires a velocity.
  const bool starts = along.empty() && largest_nu == 0 && drivers == Drivers::moving &&
                      most_opposed(evaluator, spaces.rank, own).part > clear_disagreement;
  if (starts) {
    rate = rate_of_leaving(evaluator, own);
  } else if (!(rate > 0) || largest_nu == 0) {
    point.kind = SingularPoint::Kind::rest;
    point.tangents.push_back(qd0);
    return point;
  }
  double speed = 1;
  if (drivers == Drivers::about_to_move) {
    speed = largest_driver_speed(evaluator, own);
  } else {
    own.clear();
  }
  find_tangents(evaluator, spaces, qd0, !along.empty(), rate, own, speed, point);
  return point;
}

}  // namespace catena
