#include "catena/analysis/sensitivity/start_derivatives.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "catena/analysis/motion/initial_velocities.hpp"
#include "catena/analysis/pose/whole_turns.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/elastic_gaps.hpp"

namespace catena {
namespace {

// Velocities whose last round changed them by more than this part are not settled: derivatives are good to it.
constexpr double settled = 1e-9;
// Coordinates that assembly may not change: in weights of the others, so many that what is left of a change is
// rounding.
constexpr double held_weight = 1e16;

/// The points at which one body is attached: by constraints, or by forces where these have none.
struct AttachedPoints {
  DesignScalar held, forced;
  int holding = 0, forcing = 0;
};

/// Calls f(local point, body) for every attachment point of an element with derivatives; see attachment_points.hpp.
template <class E, class F>
void visit_design_points(const ElementEntry<E, DesignScalar>& entry, F&& f) {
  const auto visit = [&](const auto& field) {
    if constexpr (requires { field.body; }) {
      if constexpr (
          requires { entry.element.*field.member + Vec2<DesignScalar>{}; } && !requires { field.required; }) {
        f(entry.element.*field.member, field.body == 0 ? entry.i : entry.j);
      }
    }
  };
  std::apply([&](const auto&... field) { (visit(field), ...); }, E::fields());
}

/// rho^2 of every plan body with derivatives, as Evaluator::attachment_radii() has it; a constant where no point of the
/// body lies off its origin.
std::vector<DesignScalar> squared_radii(const DesignModel& model, const Plan& plan, std::span<const double> radius) {
  std::vector<AttachedPoints> points(at(plan.bodies));
  for_each_list(model.constraints, [&](const auto& list, int) {
    for (const auto& entry : list) {
      const bool pulls = is_elastic_gap(model, entry);
      visit_design_points(entry, [&](const Vec2<DesignScalar>& local, int body) {
        if (body < 0) return;
        AttachedPoints& of = points[at(plan.plan_body[at(body)])];
        (pulls ? of.forced : of.held) += squared_norm(local);
        ++(pulls ? of.forcing : of.holding);
      });
    }
  });
  for_each_list(model.forces, [&](const auto& list, int) {
    for (const auto& entry : list) {
      visit_design_points(entry, [&](const Vec2<DesignScalar>& local, int body) {
        if (body < 0) return;
        points[at(plan.plan_body[at(body)])].forced += squared_norm(local);
        ++points[at(plan.plan_body[at(body)])].forcing;
      });
    }
  });
  std::vector<DesignScalar> squares(points.size());
  for (std::size_t b = 0; b < points.size(); ++b) {
    const AttachedPoints& of = points[b];
    squares[b] = of.held.v > 0     ? of.held / DesignScalar(of.holding)
                 : of.forced.v > 0 ? of.forced / DesignScalar(of.forcing)
                                   : DesignScalar(radius[b] * radius[b]);
  }
  return squares;
}

bool is_zero(const std::vector<double>& side) {
  return std::all_of(side.begin(), side.end(), [](double x) { return x == 0; });
}

bool is_held(const BasicBody<double>& body, int k) {
  return k == 0 ? body.hold_x : k == 1 ? body.hold_y : body.hold_angle;
}

}  // namespace

StartDerivatives::StartDerivatives(Evaluator& evaluator, GivenByModel given)
    : evaluator_(evaluator),
      plan_(evaluator.plan()),
      by_model_(given),
      assembly_(evaluator.shared_plan(), SaddleBlock::elements),
      velocities_(evaluator.shared_plan(), SaddleBlock::diagonal),
      jacobian_(at(plan_.trash_slot()) + 1),
      weight_(at(plan_.coordinates()), 0.0),
      wanted_(weight_),
      given_(at(plan_.coordinates()), 0),
      follows_(given_) {
  evaluator_.start_jacobian(jacobian_);
}

bool StartDerivatives::find(DesignMechanism& mechanism, int count, std::span<DesignScalar> q,
                            std::span<DesignScalar> qd) {
  return find_places(mechanism, count, q) && find_velocities(mechanism, count, q, qd);
}

bool StartDerivatives::prepare_places(std::span<const double> q) {
  if (!prepared_q_.empty() && std::equal(q.begin(), q.end(), prepared_q_.begin(), prepared_q_.end())) return true;
  prepared_q_.clear();
  prepared_qd_.clear();
  evaluator_.set_configuration(q);
  evaluator_.jacobian(jacobian_);
  radius_ = evaluator_.attachment_radii();
  const auto phi_q = std::span<const double>(jacobian_).first(at(plan_.trash_slot()));
  apart_.assign(q.size(), 0.0);
  place_weight_.assign(q.size(), 0.0);
  place_multipliers_.assign(at(plan_.rows), 0.0);
  std::vector<double> f(q.size()), given = evaluator_.given_configuration();
  move_whole_turns(evaluator_, given);
  double extent[2] = {evaluator_.length_scale(), 1};  // of positions, of angles
  for (int c = 0; c < 3 * plan_.moving; ++c)
    extent[c % 3 == 2 ? 1 : 0] = std::max(extent[c % 3 == 2 ? 1 : 0], std::abs(q[at(c)]));
  for (int c = 0; c < 3 * plan_.moving; ++c) {
    const auto& body = evaluator_.model().bodies[at(plan_.model_body[at(c / 3)])];
    const double radius = radius_[at(c / 3)];
    place_weight_[at(c)] = (c % 3 == 2 ? radius * radius : 1) * (is_held(body, c % 3) ? held_weight : 1);
    if (!by_model_.places) continue;
    const double apart = q[at(c)] - given[at(c)];
    // Else the place is where it was given.
    if (std::abs(apart) > thresholds::sum_rounding * extent[c % 3 == 2 ? 1 : 0]) apart_[at(c)] = apart;
  }
  const auto weigh = [&] {
    for (int c = 0; c < 3 * plan_.moving; ++c) assembly_.add_diagonal(c, place_weight_[at(c)]);
  };
  // The multipliers of assembly: W (q - e) + Phi_q^T mu = 0, here the least squares solution.
  if (!assembly_.begin(phi_q)) return false;
  weigh();
  for (std::size_t c = 0; c < f.size(); ++c) f[c] = -place_weight_[c] * apart_[c];
  if (!assembly_.factorize() || !assembly_.solve(f, place_multipliers_)) return false;
  // Without multipliers constraints add no curvature: these are the factors.
  if (!is_zero(place_multipliers_)) {
    assembly_.begin(phi_q);
    weigh();
    assembly_.tangent().add_curvature(evaluator_, place_multipliers_);
    if (!assembly_.factorize()) return false;
  }
  prepared_q_.assign(q.begin(), q.end());
  return true;
}

bool StartDerivatives::find_places(DesignMechanism& mechanism, int count, std::span<DesignScalar> q) {
  std::vector<double> values(q.size());
  for (std::size_t c = 0; c < q.size(); ++c) values[c] = q[c].v;
  const auto singular = [&] { return fail("constraints are singular where it was assembled"); };
  mechanism.set_time(evaluator_.time());
  if (!prepare_places(values)) return singular();
  const std::vector<DesignScalar> square = squared_radii(mechanism.model(), plan_, radius_);
  std::vector<double> f(q.size()), b(at(plan_.rows), 0.0);
  const std::vector<DesignScalar> mu(place_multipliers_.begin(), place_multipliers_.end());
  std::vector<DesignScalar> loads(q.size()), estimate(q.size());
  for (int c = 0; c < 3 * plan_.moving && by_model_.places; ++c) estimate[at(c)] = given_place(mechanism, c);
  std::vector<Taylor<DesignScalar>> rows(b.size());
  mechanism.set_state(q);
  mechanism.rows(rows);
  if (!is_zero(place_multipliers_)) mechanism.add_constraint_loads(mu, loads);
  for (std::size_t p = 0; p < at(count); ++p) {
    for (std::size_t c = 0; c < f.size(); ++c) {
      f[c] = place_weight_[c] * estimate[c].d[p] - loads[c].d[p];
      // Angles weigh more or less where attachments move.
      if (c % 3 == 2 && c / 3 < square.size() && place_weight_[c] > 0)
        f[c] -= place_weight_[c] / square[c / 3].v * square[c / 3].d[p] * apart_[c];
    }
    for (std::size_t r = 0; r < b.size(); ++r) b[r] = -rows[r].f.d[p];
    // Masses, and what acts later, move no place.
    if (is_zero(f) && is_zero(b)) {
      for (const int c : plan_.coordinate) q[at(c)].d[p] = 0;
      continue;
    }
    if (!assembly_.solve(f, b)) return singular();
    for (const int c : plan_.coordinate) q[at(c)].d[p] = f[at(c)];
    if (const int row = assembly_.contradicted_row(); row >= 0) {
      lack_ = describe_contradiction(evaluator_.model(), plan_, row);
      for (DesignScalar& place : q) place.d[p] = std::numeric_limits<double>::quiet_NaN();
    }
  }
  return true;
}

bool StartDerivatives::weigh(std::span<const double> q, std::span<const double> qd) {
  EquationsOfMotion equations(evaluator_);
  if (const Report masses = equations.use_masses(); !masses.ok()) return fail(masses.message);
  equations.weigh_massless(q);
  evaluator_.set_configuration(q);
  const std::span<const double> none;
  const WantedVelocities wanted = wanted_velocities(evaluator_, equations.masses(), by_model_.velocities ? none : qd);
  std::copy(wanted.weight.begin(), wanted.weight.end(), weight_.begin());
  std::copy(wanted.velocity.begin(), wanted.velocity.end(), wanted_.begin());
  std::copy(wanted.given.begin(), wanted.given.end(), given_.begin());
  std::copy(wanted.follows.begin(), wanted.follows.end(), follows_.begin());
  return true;
}

DesignScalar StartDerivatives::given_place(const DesignMechanism& mechanism, int coordinate) const {
  const auto& body = mechanism.model().bodies[at(plan_.model_body[at(coordinate / 3)])];
  return coordinate % 3 == 0 ? body.position.x : coordinate % 3 == 1 ? body.position.y : body.angle;
}

DesignScalar StartDerivatives::given_velocity(const DesignMechanism& mechanism, int coordinate) const {
  if (!by_model_.velocities) return {};
  const auto& body = mechanism.model().bodies[at(plan_.model_body[at(coordinate / 3)])];
  const DesignScalar omega = body.angular_velocity_given ? body.angular_velocity : DesignScalar();
  if (coordinate % 3 == 2) return omega;
  // From the author's origin to the centroid.
  const Vec2<DesignScalar> arm = mechanism.ground_frame(coordinate / 3).axis(body.origin);
  const Vec2<DesignScalar> v = body.velocity - omega * perpendicular(arm);
  return coordinate % 3 == 0 ? v.x : v.y;
}

bool StartDerivatives::solve_keeping(std::span<const double> goal, std::span<const double> load,
                                     std::span<const double> rows, std::span<double> v, std::span<double> multipliers) {
  std::vector<double> asked(v.size(), 0.0), before(v.size(), 0.0);
  for (std::size_t c = 0; c < v.size(); ++c) {
    if (given_[c]) asked[c] = goal[c];
  }
  // Without given ones, and without massless ones that follow, the first solution is the last.
  const auto counts = [](char is) { return is != 0; };
  const bool keeps =
      std::any_of(given_.begin(), given_.end(), counts) || std::any_of(follows_.begin(), follows_.end(), counts);
  double change = 0, size = 0;
  for (int round = 0; round < rounds_of_velocities; ++round) {
    for (std::size_t c = 0; c < v.size(); ++c) v[c] = weight_[c] * asked[c] + (given_[c] ? 0 : load[c]);
    std::copy(rows.begin(), rows.end(), multipliers.begin());
    if (!velocities_.solve(v, multipliers)) return fail("the equations of its velocities are singular");
    // Of all rounds: where the derivative is zero what is left of it is noise.
    change = 0;
    for (const int coordinate : plan_.coordinate) {
      const std::size_t c = at(coordinate);
      size = std::max(size, std::abs(v[c]));
      change = std::max(change, std::abs(v[c] - before[c]));
      before[c] = v[c];
      if (given_[c]) asked[c] += goal[c] - v[c];
      if (follows_[c]) asked[c] = v[c];
    }
    if (!keeps || (round > 0 && change <= 1e-15 * size)) return true;
  }
  if (change <= settled * size) return true;
  return fail(
      fmt::format("velocities that keep what is given do not settle: after {} rounds they change by {:.2g} of their "
                  "size; likely cause: masses that differ by more than ten orders of magnitude",
                  rounds_of_velocities, change / size));
}

bool StartDerivatives::prepare_velocities(DesignMechanism& mechanism, std::span<const DesignScalar> q,
                                          std::span<const double> qd) {
  if (!prepared_qd_.empty() && std::equal(qd.begin(), qd.end(), prepared_qd_.begin(), prepared_qd_.end())) return true;
  prepared_qd_.clear();
  if (!weigh(prepared_q_, qd)) return false;
  const auto singular = [&] { return fail("the equations of its velocities are singular"); };
  velocities_.use_rows_of(assembly_);
  if (!velocities_.begin(std::span<const double>(jacobian_).first(at(plan_.trash_slot())))) return singular();
  for (const int coordinate : plan_.coordinate) velocities_.add_diagonal(coordinate, weight_[at(coordinate)]);
  if (!velocities_.factorize()) return singular();
  std::vector<double> b(at(plan_.rows)), v(qd.size());
  const std::vector<double> load(qd.size(), 0.0);
  rate_multipliers_.assign(b.size(), 0.0);
  std::vector<Taylor<DesignScalar>> rows(b.size());
  mechanism.set_state(q);
  mechanism.rows(rows);
  for (std::size_t r = 0; r < b.size(); ++r) b[r] = -rows[r].d.v;  // nu
  if (!solve_keeping(wanted_, load, b, v, rate_multipliers_)) return false;
  rests_ = is_zero(v) && is_zero(rate_multipliers_);
  double largest = 0, off = 0;
  for (const int coordinate : plan_.coordinate) {
    const std::size_t c = at(coordinate);
    largest = std::max({largest, std::abs(v[c]), given_[c] ? std::abs(wanted_[c]) : 0.0});
    if (given_[c]) off = std::max(off, std::abs(v[c] - wanted_[c]));
  }
  // What derivatives lack is of that size, below which "verify" does not see it.
  if (off > thresholds::same_value * largest) {
    return fail(fmt::format(
        "the given velocities do not meet the constraints, which change them by {:.3g}: give such as meet them", off));
  }
  prepared_qd_.assign(qd.begin(), qd.end());
  return true;
}

bool StartDerivatives::find_velocities(DesignMechanism& mechanism, int count, std::span<const DesignScalar> q,
                                       std::span<DesignScalar> qd) {
  std::vector<double> goal(qd.size()), load(qd.size(), 0.0), v(qd.size()), b(at(plan_.rows)), multipliers(b);
  for (std::size_t c = 0; c < qd.size(); ++c) goal[c] = qd[c].v;
  if (!prepare_velocities(mechanism, q, goal)) return false;
  std::fill(goal.begin(), goal.end(), 0.0);
  const std::vector<DesignScalar> mu(rate_multipliers_.begin(), rate_multipliers_.end());
  std::vector<DesignScalar> loads(qd.size());
  std::vector<Taylor<DesignScalar>> rows(b.size());
  // Velocities that are nothing but rounding would ask for solutions that are nothing else either.
  std::vector<DesignScalar> rates(qd.begin(), qd.end());
  if (rests_) std::fill(rates.begin(), rates.end(), DesignScalar());
  mechanism.set_state(q, rates);
  mechanism.rows(rows);
  if (!is_zero(rate_multipliers_)) mechanism.add_constraint_loads(mu, loads);
  for (std::size_t p = 0; p < at(count); ++p) {
    for (const int coordinate : plan_.coordinate) {
      const std::size_t c = at(coordinate);
      goal[c] = given_[c] ? given_velocity(mechanism, coordinate).d[p] : 0;
      load[c] = -mechanism.mass(coordinate).d[p] * rates[c].v - loads[c].d[p];
    }
    for (std::size_t r = 0; r < b.size(); ++r) b[r] = -rows[r].d.d[p];
    // From rest no parameter moves them.
    const bool moves = !is_zero(goal) || !is_zero(load) || !is_zero(b);
    if (moves && !solve_keeping(goal, load, b, v, multipliers)) return false;
    for (const int c : plan_.coordinate) qd[at(c)].d[p] = moves ? v[at(c)] : 0;
  }
  return true;
}

}  // namespace catena
