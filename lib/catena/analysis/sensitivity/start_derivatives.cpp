#include "catena/analysis/sensitivity/start_derivatives.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace catena {
namespace {

std::size_t at(int k) { return static_cast<std::size_t>(k); }

// As in initial_velocities.cpp.
constexpr double given_weight = 1e4;
constexpr int most_rounds = 12;
// Coordinates that assembly may not change: in weights of the others.
constexpr double held_weight = 1e8;

bool is_held(const BasicBody<double>& body, int k) {
  return k == 0 ? body.hold_x : k == 1 ? body.hold_y : body.hold_angle;
}

}  // namespace

StartDerivatives::StartDerivatives(Evaluator& evaluator, bool from_model)
    : evaluator_(evaluator),
      plan_(evaluator.plan()),
      from_model_(from_model),
      assembly_(evaluator.shared_plan(), SaddleBlock::elements),
      velocities_(evaluator.shared_plan(), SaddleBlock::diagonal),
      jacobian_(at(plan_.trash_slot()) + 1),
      weight_(at(plan_.coordinates()), 0.0),
      given_(at(plan_.coordinates()), 0) {
  evaluator_.start_jacobian(jacobian_);
}

bool StartDerivatives::find(DesignMechanism& mechanism, int count, std::span<DesignScalar> q,
                            std::span<DesignScalar> qd) {
  std::vector<double> values(q.size());
  for (std::size_t c = 0; c < q.size(); ++c) values[c] = q[c].v;
  evaluator_.set_configuration(values);
  evaluator_.jacobian(jacobian_);
  mechanism.set_time(evaluator_.time());
  return find_configuration(mechanism, count, q) && find_velocities(mechanism, count, q, qd);
}

bool StartDerivatives::find_configuration(DesignMechanism& mechanism, int count, std::span<DesignScalar> q) {
  const std::vector<double> radius = evaluator_.attachment_radii();
  const auto phi_q = std::span<const double>(jacobian_).first(at(plan_.trash_slot()));
  std::vector<double> apart(q.size(), 0.0), weight(q.size(), 0.0), f(q.size()), b(at(plan_.rows), 0.0);
  std::vector<DesignScalar> estimate(q.size());
  for (int c = 0; c < 3 * plan_.moving; ++c) {
    const auto& body = evaluator_.model().bodies[at(plan_.model_body[at(c / 3)])];
    const auto& design = mechanism.model().bodies[at(plan_.model_body[at(c / 3)])];
    const int k = c % 3;
    weight[at(c)] = (k == 2 ? radius[at(c / 3)] * radius[at(c / 3)] : 1) * (is_held(body, k) ? held_weight : 1);
    if (!from_model_) continue;
    estimate[at(c)] = k == 0 ? design.position.x : k == 1 ? design.position.y : design.angle;
    const double turn = 2 * std::numbers::pi;
    // Positions are relative to the given ones; whole turns were taken over before assembly.
    apart[at(c)] = k == 2 ? std::remainder(q[at(c)].v - estimate[at(c)].v, turn) : q[at(c)].v;
  }
  // The multipliers of assembly: W (q - e) + Phi_q^T mu = 0, here the least squares solution.
  if (!assembly_.begin(phi_q)) return false;
  for (int c = 0; c < 3 * plan_.moving; ++c) assembly_.add_diagonal(c, weight[at(c)]);
  if (!assembly_.factorize()) return false;
  for (std::size_t c = 0; c < f.size(); ++c) f[c] = -weight[c] * apart[c];
  if (!assembly_.solve(f, b)) return false;
  std::vector<DesignScalar> mu(b.begin(), b.end()), loads(q.size());
  assembly_.begin(phi_q);
  for (int c = 0; c < 3 * plan_.moving; ++c) assembly_.add_diagonal(c, weight[at(c)]);
  evaluator_.visit_constraint_hessians(
      b, [&](int i, int j, const ElementMatrix& matrix) { assembly_.add_element(i, j, matrix); });
  if (!assembly_.factorize()) return false;
  std::vector<Taylor<DesignScalar>> rows(b.size());
  mechanism.set_state(q);
  mechanism.rows(rows);
  mechanism.add_constraint_loads(mu, loads);
  for (std::size_t p = 0; p < at(count); ++p) {
    for (std::size_t c = 0; c < f.size(); ++c) f[c] = weight[c] * estimate[c].d[p] - loads[c].d[p];
    for (std::size_t r = 0; r < b.size(); ++r) b[r] = -rows[r].f.d[p];
    if (!assembly_.solve(f, b)) return false;
    for (const int c : plan_.coordinate) q[at(c)].d[p] = f[at(c)];
  }
  return true;
}

bool StartDerivatives::given_velocity(const DesignMechanism& mechanism, int coordinate, DesignScalar& velocity) const {
  velocity = DesignScalar();
  if (!from_model_) return true;
  const auto& body = mechanism.model().bodies[at(plan_.model_body[at(coordinate / 3)])];
  const DesignScalar omega = body.angular_velocity_given ? body.angular_velocity : DesignScalar();
  if (coordinate % 3 == 2) {
    velocity = omega;
    return body.angular_velocity_given;
  }
  // From the author's origin to the centroid.
  const Vec2<DesignScalar> arm = mechanism.ground_frame(coordinate / 3).axis(body.origin);
  const Vec2<DesignScalar> v = body.velocity - omega * perpendicular(arm);
  velocity = coordinate % 3 == 0 ? v.x : v.y;
  return body.velocity_given;
}

bool StartDerivatives::solve_keeping(std::span<const double> wanted, std::span<const double> load,
                                     std::span<const double> rows, std::span<double> v, std::span<double> multipliers) {
  std::vector<double> asked(wanted.begin(), wanted.end());
  for (int round = 0; round < most_rounds; ++round) {
    for (std::size_t c = 0; c < v.size(); ++c) v[c] = given_[c] ? weight_[c] * asked[c] : load[c];
    std::copy(rows.begin(), rows.end(), multipliers.begin());
    if (!velocities_.solve(v, multipliers)) return false;
    double change = 0, size = 0;
    for (const int coordinate : plan_.coordinate) {
      const std::size_t c = at(coordinate);
      size = std::max(size, std::abs(v[c]));
      if (!given_[c]) continue;
      change = std::max(change, std::abs(wanted[c] - v[c]));
      asked[c] += wanted[c] - v[c];
    }
    if (change <= 1e-15 * size) break;
  }
  return true;
}

bool StartDerivatives::find_velocities(DesignMechanism& mechanism, int count, std::span<const DesignScalar> q,
                                       std::span<DesignScalar> qd) {
  const auto phi_q = std::span<const double>(jacobian_).first(at(plan_.trash_slot()));
  if (!velocities_.begin(phi_q)) return false;
  mechanism.set_state(q);
  std::vector<DesignScalar> wanted(qd.size());
  for (int c = 0; c < 3 * plan_.moving; ++c) {
    if (plan_.column[at(c)] < 0) continue;
    given_[at(c)] = given_velocity(mechanism, c, wanted[at(c)]);
    weight_[at(c)] = mechanism.mass(c).v * (given_[at(c)] ? given_weight : 1);
    velocities_.add_diagonal(c, weight_[at(c)]);
  }
  if (!velocities_.factorize()) return false;
  std::vector<double> goal(qd.size()), load(qd.size(), 0.0), v(qd.size()), b(at(plan_.rows)), multipliers(b);
  std::vector<Taylor<DesignScalar>> rows(b.size());
  mechanism.rows(rows);
  for (std::size_t c = 0; c < goal.size(); ++c) goal[c] = wanted[c].v;
  for (std::size_t r = 0; r < b.size(); ++r) b[r] = -rows[r].d.v;  // nu
  if (!solve_keeping(goal, load, b, v, multipliers)) return false;
  std::vector<DesignScalar> mu(multipliers.begin(), multipliers.end()), loads(qd.size());
  mechanism.set_state(q, qd);
  mechanism.rows(rows);
  mechanism.add_constraint_loads(mu, loads);
  for (std::size_t p = 0; p < at(count); ++p) {
    for (int c = 0; c < 3 * plan_.moving; ++c) {
      goal[at(c)] = wanted[at(c)].d[p];
      load[at(c)] = -mechanism.mass(c).d[p] * qd[at(c)].v - loads[at(c)].d[p];
    }
    for (std::size_t r = 0; r < b.size(); ++r) b[r] = -rows[r].d.d[p];
    if (!solve_keeping(goal, load, b, v, multipliers)) return false;
    for (const int c : plan_.coordinate) qd[at(c)].d[p] = v[at(c)];
  }
  return true;
}

}  // namespace catena
