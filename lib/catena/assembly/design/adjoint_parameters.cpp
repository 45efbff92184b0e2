// AdjointMechanism: derivatives by design parameters, of what these reach (adjoint_reached.cpp).
#include <algorithm>
#include <type_traits>

#include "catena/assembly/curve_contacts.hpp"
#include "catena/assembly/design/adjoint_mechanism.hpp"
#include "catena/assembly/design/element_motion.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

using detail::DesignSeries;

}  // namespace

// With the arms a = A s: h_p = A s_p, h'_p = R A s_p omega, h''_p = R A s_p alpha - A s_p omega^2, (h_q w)_p = R A s_p
// w_phi.
void AdjointMechanism::add_pins(const Reached& reached, const AdjointWeights& weights,
                                std::array<double, parameters_at_once>& sum) const {
  const auto turned_back = [](const Vec2<double>& v) { return Vec2<double>{v.y, -v.x}; };  // R^T v
  const bool of_places = weights.rate.empty() && weights.bend.empty() && weights.lambda.empty();
  for (const Reached::PinEnd& end : reached.pins_) {
    const auto weight = [row = at(end.row)](std::span<const double> w) {
      return w.empty() ? Vec2<double>{} : Vec2<double>{w[row], w[row + 1]};
    };
    const Frame<Series>& f = motion_[at(end.body)];
    const double omega = f.phi.d, w = weights.w.empty() ? 0 : weights.w[at(3 * end.body + 2)];
    Vec2<double> all = weight(weights.phi);
    if (!of_places) {
      const Vec2<double> bend = weight(weights.bend);
      all = all - (omega * omega) * bend +
            turned_back(omega * weight(weights.rate) + f.phi.dd * bend + w * weight(weights.lambda));
    }
    const double x = f.c.f * all.x + f.s.f * all.y, y = f.c.f * all.y - f.s.f * all.x;
    for (std::size_t p = 0; p < sum.size(); ++p) sum[p] -= x * end.x[p] + y * end.y[p];
  }
}

Frame<DesignSeries> AdjointMechanism::turned_by_parameters(const DesignModel& model, Frame<DesignSeries> frame,
                                                           int body) const {
  if (body >= plan_->moving || plan_->column[at(3 * body + 2)] >= 0) return frame;
  const DesignScalar& angle = model.bodies[at(plan_->model_body[at(body)])].angle;
  frame.phi.f.d = angle.d;
  for (std::size_t p = 0; p < angle.d.size(); ++p) {
    frame.c.f.d[p] = -frame.s.f.v * angle.d[p];
    frame.s.f.d[p] = frame.c.f.v * angle.d[p];
  }
  return frame;
}

Frame<DesignSeries> AdjointMechanism::frame_of(const DesignMechanism& mechanism, int body) const {
  if (is_immobile(body)) return mechanism.motion(body);
  return turned_by_parameters(mechanism.model(), detail::lifted(motion_[at(body)]), body);
}

void AdjointMechanism::add_constraints(const DesignMechanism& mechanism, const Reached& reached,
                                       const AdjointWeights& weights, DesignScalar& sum) const {
  const DesignModel& model = mechanism.model();
  const auto frame = [&](int body) { return frame_of(mechanism, body); };
  // The same bodies moving along w.
  const auto frame_along = [&](int body) {
    if (is_immobile(body)) return mechanism.motion(body);
    Frame<Taylor<double>> m = motion_[at(body)];
    const double* w = weights.w.data() + 3 * body;
    if (body < plan_->moving) m = moving(Frame<double>{m.x.f, m.y.f, m.phi.f, m.c.f, m.s.f}, w[0], w[1], w[2]);
    return turned_by_parameters(model, detail::lifted(m), body);
  };
  std::size_t type_number = 0;
  for_each_list(plan_->blocks, model.constraints, [&](const auto& block, const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    using Plain = typename std::remove_cvref_t<decltype(block)>::Element;
    const std::vector<int>& places = reached.constraints_[type_number++];
    if (places.empty()) return;
    if constexpr (detail::has_adjoint<Plain> || detail::is_slide<Plain>) {
      for (const int e : places) {
        const auto weigh = [&](std::span<const double> of) { return detail::rows_weigh(of, block.row(e), E::rows); };
        const bool weighs = weigh(weights.phi) || weigh(weights.rate) || weigh(weights.bend);
        const bool pulls = weigh(weights.lambda);
        if (!weighs && !pulls) continue;
        const auto& entry = list[at(block.entry[at(e)])];
        DesignSeries c;
        if constexpr (E::functions > 0) c = mechanism.element_value(entry.id);
        const double scale = scale_[at(entry.id)];
        DesignSeries rows[E::rows];
        const CurvePlace& contact = contact_of(block, contacts_, block.entry[at(e)]);
        if (weighs) {
          const auto f = detail::design_frames<DesignSeries>(block, e, plan_->moving, origin_, frame);
          entry.element.phi(Arguments<DesignSeries>{f.i, f.j, c, f.ground, &contact}, rows);
        }
        for (int r = 0; weighs && r < E::rows; ++r) {
          const std::size_t row = at(block.row(e) + r);
          if (!weights.phi.empty()) sum -= DesignScalar(scale * weights.phi[row]) * rows[r].f;
          if (!weights.rate.empty()) sum -= DesignScalar(scale * weights.rate[row]) * rows[r].d;
          if (!weights.bend.empty()) sum -= DesignScalar(scale * weights.bend[row]) * rows[r].dd;
        }
        if (!pulls) continue;
        // lambda^T Phi_q w: without what the function of time itself changes by.
        const auto g = detail::design_frames<DesignSeries>(block, e, plan_->moving, origin_, frame_along);
        entry.element.phi(Arguments<DesignSeries>{g.i, g.j, DesignSeries(c.f), g.ground, &contact}, rows);
        for (int r = 0; r < E::rows; ++r) sum -= DesignScalar(scale * weights.lambda[at(block.row(e) + r)]) * rows[r].d;
      }
    }
  });
}

void AdjointMechanism::add_forces(const DesignMechanism& mechanism, const Reached& reached, std::span<const double> w,
                                  DesignScalar& sum) const {
  const DesignModel& model = mechanism.model();
  const auto pose = [&](int body) { return detail::present(frame_of(mechanism, body)); };
  const auto twist = [&](int body) {
    const double* rate = rates_.data() + 3 * body;
    return Twist<DesignScalar>{rate[0], rate[1], rate[2]};
  };
  const auto add = [&](int body, const Wrench<DesignScalar>& wrench) {
    const double* of_body = w.data() + 3 * body;
    sum += DesignScalar(of_body[0]) * wrench.fx + DesignScalar(of_body[1]) * wrench.fy +
           DesignScalar(of_body[2]) * wrench.moment;
  };
  std::size_t type_number = 0;
  for_each_list(plan_->forces, model.forces, [&](const auto& block, const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    using Plain = typename std::remove_cvref_t<decltype(block)>::Element;
    const std::vector<int>& places = reached.forces_[type_number++];
    if (places.empty()) return;
    if constexpr (detail::is_differentiated<Plain>) {
      for (const int e : places) {
        const auto& entry = list[at(block.entry[at(e)])];
        const auto f = detail::design_frames<DesignScalar>(block, e, plan_->moving, origin_, pose);
        const auto values = detail::function_values<DesignScalar>(entry, mechanism.functions(), detail::no_law);
        const int body_i = block.body_i[at(e)], body_j = E::bodies == 2 ? block.body_j[at(e)] : plan_->bodies;
        const Twist<DesignScalar> u = twist(body_i), v = twist(body_j);
        Wrench<DesignScalar> on_i, on_j;
        entry.element.force(ForceArguments<DesignScalar>{f.i, f.j, u, v, values.data(), f.ground}, on_i, on_j);
        add(body_i, on_i);
        if constexpr (E::bodies == 2) add(body_j, on_j);
      }
    }
  });
}

std::array<double, parameters_at_once> AdjointMechanism::by_parameters(const DesignMechanism& mechanism,
                                                                       const Reached& reached,
                                                                       const AdjointWeights& weights,
                                                                       std::span<const double> qdd) {
  DesignScalar sum;
  add_pins(reached, weights, sum.d);
  if (!weights.w.empty()) {
    for (const Reached::Mass& mass : reached.masses_) {
      const std::size_t c = at(mass.coordinate);
      const double force = weights.w[c] * ((weights.forces ? mass.pull : 0) - (qdd.empty() ? 0 : qdd[c]));
      for (std::size_t p = 0; p < sum.d.size(); ++p) sum.d[p] += force * mass.by[p];
    }
  }
  if (!reached.asks_mechanism()) return sum.d;
  if (reached.any_constraint_) add_constraints(mechanism, reached, weights, sum);
  if (weights.w.empty() || !weights.forces) return sum.d;
  if (reached.any_force_) add_forces(mechanism, reached, weights.w, sum);
  const Vec2<DesignScalar>& gravity = mechanism.model().gravity;
  for (int c = 0; c < 3 * plan_->moving && reached.gravity_; ++c) {
    if (c % 3 == 2) continue;
    const DesignScalar& field = c % 3 == 0 ? gravity.x : gravity.y;
    for (std::size_t p = 0; p < sum.d.size(); ++p) sum.d[p] += weights.w[at(c)] * mechanism.mass(c).v * field.d[p];
  }
  return sum.d;
}

}  // namespace catena
