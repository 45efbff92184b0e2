// MechanismTangents: derivatives by design parameters, of what these reach.
#include <algorithm>
#include <type_traits>

#include "catena/assembly/design/element_motion.hpp"
#include "catena/assembly/design/mechanism_tangents.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

using detail::DesignSeries;

template <class E>
constexpr bool is_differentiated = !std::is_same_v<E, CustomConstraint<double>> &&
                                   !std::is_same_v<E, CustomForce<double>> && !Joining<E> && !Sharing<E>;

DesignSeries lift_series(const Taylor<double>& x) { return {DesignScalar(x.f), DesignScalar(x.d), DesignScalar(x.dd)}; }

/// A function at t, where its derivatives by parameters may have two sides; see DesignMechanism::set_time().
DesignSeries value_at(const TimeFunction<DesignScalar>& function, double t, Side side) {
  const TimeRange domain = function.domain();
  const double there = std::clamp(t, domain.first, domain.last);
  return side == Side::after ? function.evaluate(there) : function.continue_from(there, side, there);
}

/// Derivatives by the parameters of a group into a row of directions.
void add_derivatives(double factor, const DesignScalar& x, double* out) {
  for (std::size_t p = 0; p < x.d.size(); ++p) out[p] += factor * x.d[p];
}

}  // namespace

// With the arm a = A s and its derivative A s_p: h_p = A s_p, h'_p = R A s_p omega, h''_p = R A s_p alpha - A s_p
// omega^2, and of the load's moment lambda . R A s_p. False where a body's own place moves with the parameters.
template <class Block>
bool MechanismTangents::add_pin_parameters(const Block& block, int e, const Revolute<DesignScalar>& pin,
                                           std::span<const double> lambda, std::size_t first, std::size_t width,
                                           const TangentSums& sums) const {
  const int bodies[2] = {block.body_i[at(e)], block.body_j[at(e)]};
  for (const int body : bodies) {
    const bool immobile = body >= plan_->moving && body < plan_->bodies;
    if (immobile || (body < plan_->moving && plan_->column[at(3 * body + 2)] < 0)) return false;
  }
  const std::size_t row = at(block.row(e));
  const auto target = [&](std::span<double> all, std::size_t r) { return all.data() + r * width + first; };
  for (int b = 0; b < 2; ++b) {
    const Frame<Series>& f = motion_[at(bodies[b])];
    const Vec2<DesignScalar>& s = b == 0 ? pin.s_i : pin.s_j;
    const double sign = b == 0 ? -1 : 1, omega = f.phi.d, alpha = f.phi.dd;
    for (std::size_t p = 0; p < s.x.d.size(); ++p) {
      const Vec2<double> a{sign * (f.c.f * s.x.d[p] - f.s.f * s.y.d[p]), sign * (f.s.f * s.x.d[p] + f.c.f * s.y.d[p])};
      if (!sums.phi.empty()) {
        target(sums.phi, row)[p] += a.x;
        target(sums.phi, row + 1)[p] += a.y;
      }
      if (!sums.rates.empty()) {
        target(sums.rates, row)[p] -= omega * a.y;
        target(sums.rates, row + 1)[p] += omega * a.x;
      }
      if (!sums.bends.empty()) {
        target(sums.bends, row)[p] -= alpha * a.y + omega * omega * a.x;
        target(sums.bends, row + 1)[p] += alpha * a.x - omega * omega * a.y;
      }
      if (!sums.loads.empty() && bodies[b] < plan_->moving)
        target(sums.loads, at(3 * bodies[b] + 2))[p] -= lambda[row + 1] * a.x - lambda[row] * a.y;
    }
  }
  return true;
}

void MechanismTangents::add_parameters(const DesignMechanism& mechanism, Side side, const Reached& reached,
                                       std::span<const double> lambda, std::span<const double> qdd, std::size_t first,
                                       std::size_t width, const TangentSums& sums) const {
  const DesignModel& model = mechanism.model();
  const auto target = [&](std::span<double> all, std::size_t row) { return all.data() + row * width + first; };
  // Immobile bodies move with the parameters; so do the angles of particles, which are no unknowns.
  const auto frame = [&](int body) {
    if (body >= plan_->moving && body < plan_->bodies) return mechanism.motion(body);
    const Frame<Series>& m = motion_[at(body)];
    Frame<DesignSeries> f{lift_series(m.x), lift_series(m.y), lift_series(m.phi), lift_series(m.c), lift_series(m.s)};
    if (body < plan_->moving && plan_->column[at(3 * body + 2)] < 0) {
      const DesignScalar& angle = model.bodies[at(plan_->model_body[at(body)])].angle;
      f.phi.f.d = angle.d;
      for (std::size_t p = 0; p < angle.d.size(); ++p) {
        f.c.f.d[p] = -f.s.f.v * angle.d[p];
        f.s.f.d[p] = f.c.f.v * angle.d[p];
      }
    }
    return f;
  };
  std::size_t type = 0;
  if (reached.any_constraint_)
    for_each_list(plan_->blocks, model.constraints, [&](const auto& block, const auto& list, int) {
      using E = ElementOf<decltype(list)>;
      using Plain = typename std::remove_cvref_t<decltype(block)>::Element;
      const std::vector<int>& places = reached.constraints_[type++];
      if constexpr (is_differentiated<Plain>) {
        for (const int e : places) {
          const auto& entry = list[at(block.entry[at(e)])];
          if constexpr (std::is_same_v<Plain, Revolute<double>>) {
            if (add_pin_parameters(block, e, entry.element, lambda, first, width, sums)) continue;
          }
          const double scale = scale_[at(entry.id)];
          DesignSeries c;
          if constexpr (E::functions > 0) c = mechanism.element_value(entry.id);
          const auto f = detail::design_frames<DesignSeries>(block, e, plan_->moving, origin_, frame);
          DesignSeries rows[E::rows];
          entry.element.phi(Arguments<DesignSeries>{f.i, f.j, c, f.ground}, rows);
          for (int r = 0; r < E::rows; ++r) {
            const std::size_t row = at(block.row(e) + r);
            if (!sums.phi.empty()) add_derivatives(scale, rows[r].f, target(sums.phi, row));
            if (!sums.rates.empty()) add_derivatives(scale, rows[r].d, target(sums.rates, row));
            if (!sums.bends.empty()) add_derivatives(scale, rows[r].dd, target(sums.bends, row));
          }
          if (sums.loads.empty()) continue;
          constexpr int columns = 3 * E::bodies;
          using D = Dual<DesignScalar, columns>;
          Frame<D> j;
          if constexpr (E::bodies == 2) j = seed<DesignScalar, columns>(detail::present(f.j), 3);
          D slopes[E::rows];
          entry.element.phi(Arguments<D>{seed<DesignScalar, columns>(detail::present(f.i), 0), j, D(c.f), f.ground},
                            slopes);
          for (int r = 0; r < E::rows; ++r) {
            const double weight = -scale * lambda[at(block.row(e) + r)];
            for (int k = 0; k < columns; ++k) {
              const int body = k < 3 ? block.body_i[at(e)] : block.body_j[at(e)];
              add_derivatives(weight, slopes[r].d[at(k)], target(sums.loads, at(3 * body + k % 3)));
            }
          }
        }
      }
    });
  if (sums.loads.empty()) return;
  type = 0;
  if (reached.any_force_)
    for_each_list(plan_->forces, model.forces, [&](const auto& block, const auto& list, int) {
      using E = ElementOf<decltype(list)>;
      using Plain = typename std::remove_cvref_t<decltype(block)>::Element;
      const std::vector<int>& places = reached.forces_[type++];
      if constexpr (is_differentiated<Plain>) {
        for (const int e : places) {
          const auto& entry = list[at(block.entry[at(e)])];
          const auto f = detail::design_frames<DesignScalar>(block, e, plan_->moving, origin_,
                                                             [&](int body) { return detail::present(frame(body)); });
          std::array<DesignScalar, E::functions + 1> values;
          for (std::size_t n = 0; n < entry.values.size(); ++n) {
            const auto& own = entry.values[n];
            values[n] = own.function < 0 ? DesignScalar(own.constant)
                                         : value_at(model.functions[at(own.function)], mechanism.time(), side).f;
          }
          const int bodies[2] = {block.body_i[at(e)], E::bodies == 2 ? block.body_j[at(e)] : plan_->bodies};
          const auto twist = [&](int body) {
            const double* rate = rates_.data() + 3 * body;
            return Twist<DesignScalar>{rate[0], rate[1], rate[2]};
          };
          const Twist<DesignScalar> u = twist(bodies[0]), v = twist(bodies[1]);
          Wrench<DesignScalar> on[2];
          entry.element.force(ForceArguments<DesignScalar>{f.i, f.j, u, v, values.data(), f.ground}, on[0], on[1]);
          for (int b = 0; b < E::bodies; ++b) {
            const std::size_t c = at(3 * bodies[b]);
            add_derivatives(1, on[b].fx, target(sums.loads, c));
            add_derivatives(1, on[b].fy, target(sums.loads, c + 1));
            add_derivatives(1, on[b].moment, target(sums.loads, c + 2));
          }
        }
      }
    });
  const auto weigh = [&](int b) {
    for (int k = 0; k < 3; ++k) {
      const std::size_t c = at(3 * b + k);
      const DesignScalar& m = mechanism.mass(3 * b + k);
      const DesignScalar field = k == 0 ? model.gravity.x : k == 1 ? model.gravity.y : DesignScalar();
      add_derivatives(field.v - (qdd.empty() ? 0 : qdd[c]), m, target(sums.loads, c));
      add_derivatives(m.v, field, target(sums.loads, c));
    }
  };
  if (reached.gravity_) {
    for (int b = 0; b < plan_->moving; ++b) weigh(b);
  } else {
    for (const int b : reached.bodies_) weigh(b);
  }
}

}  // namespace catena
