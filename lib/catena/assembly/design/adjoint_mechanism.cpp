#include "catena/assembly/design/adjoint_mechanism.hpp"

#include <type_traits>

#include "catena/assembly/curve_contacts.hpp"
#include "catena/assembly/design/element_motion.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

template <class E>
constexpr bool is_custom = std::is_same_v<E, CustomConstraint<double>> || std::is_same_v<E, CustomForce<double>>;

template <class E>
constexpr bool is_pin = std::is_same_v<E, Revolute<double>>;

/// Of body b of a pin, its arm A s' in the ground frame: h = r_j + A_j s_j - r_i - A_i s_i.
template <class Block>
Vec2<double> arm_of(const Block& block, const Revolute<double>& pin, int e, int b,
                    const std::vector<Frame<Taylor<double>>>& motion) {
  const Frame<Taylor<double>>& f = motion[at(b == 0 ? block.body_i[at(e)] : block.body_j[at(e)])];
  const Vec2<double>& s = b == 0 ? pin.s_i : pin.s_j;
  return {f.c.f * s.x - f.s.f * s.y, f.s.f * s.x + f.c.f * s.y};
}

}  // namespace

std::string AdjointMechanism::why_not(const Model& model, bool has_phases) {
  if (!model.laws.empty()) return "laws of state act";
  std::string why;
  const auto look = [&](const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    if (list.empty()) return;
    if constexpr (std::is_same_v<E, CustomForce<double>>) why = "elements made in C++ act";
    if constexpr (std::is_same_v<E, CustomConstraint<double>>) {
      if (!has_phases) why = "elements made in C++ act";
    }
    if constexpr (HasCurve<E>) {
      if (!has_phases) why = "contacts run on curves";
    }
    if constexpr (Joining<E>) why = "a rope runs over several pulleys";
  };
  for_each_list(model.constraints, look);
  for_each_list(model.forces, [&](const auto& list, int type) {
    look(list, type);
    if constexpr (Sharing<ElementOf<decltype(list)>>) {
      if (!list.empty()) why = "an elastic rope acts";
    }
  });
  return why;
}

AdjointMechanism::AdjointMechanism(const Evaluator& evaluator)
    : plan_(evaluator.shared_plan()), model_(&evaluator.model()) {
  for (int p = 0; p <= plan_->bodies; ++p) origin_.push_back(p < plan_->bodies ? evaluator.origin(p) : Vec2<double>{});
  scale_.assign(model_->elements.size(), 1.0);
  contacts_.resize(at(plan_->in_pose.contacts));
  for_each_list(plan_->blocks, model_->constraints, [&](const auto& block, const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    if constexpr (HasSquaredValue<E>) {
      for (int e = 0; e < block.size(); ++e) {
        const int id = list[at(block.entry[at(e)])].id;
        scale_[at(id)] = evaluator.element_jacobian(id).scale;
      }
    }
  });
  motion_.resize(at(plan_->bodies) + 1);
  values_.resize(model_->functions.size());
  rates_.assign(at(plan_->coordinates()), 0.0);
}

void AdjointMechanism::set_motion(const Evaluator& evaluator, std::span<const double> qd, std::span<const double> qdd,
                                  Side side) {
  for (std::size_t k = 0; k < values_.size(); ++k) {
    const TimeRange domain = model_->functions[k].domain();
    const double there = std::clamp(evaluator.time(), domain.first, domain.last);
    values_[k] = side == Side::after ? model_->functions[k].evaluate(there)
                                     : model_->functions[k].continue_from(there, side, there);
  }
  for (std::size_t c = 0; c < rates_.size(); ++c) rates_[c] = qd.empty() ? 0 : qd[c];
  for_each_contact(*plan_, model_->constraints, contacts_,
                   [&](const auto& entry, CurvePlace& contact) { contact = evaluator.contact(entry.id); });
  for (int p = 0; p <= plan_->bodies; ++p) {
    const Frame<double>& f = evaluator.frames()[at(p)];
    Frame<Series>& m = motion_[at(p)];
    if (p >= plan_->moving) {
      m = constant_frame<Series>(f);
      continue;
    }
    const std::size_t c = at(3 * p);
    m = moving(f, rates_[c], rates_[c + 1], rates_[c + 2]);
    if (qdd.empty()) continue;
    m.x.dd += qdd[c];
    m.y.dd += qdd[c + 1];
    m.phi.dd += qdd[c + 2];
    m.c.dd -= f.s * qdd[c + 2];
    m.s.dd += f.c * qdd[c + 2];
  }
}

// (Phi_q)'' and (Phi_q)' of every element, by series in time under dual numbers.
void AdjointMechanism::add_constraints_by_q(const AdjointWeights& weights, std::span<double> by_q,
                                            std::span<double> by_qd) const {
  detail::visit_constraints(*plan_, *model_, [&](const auto& block, const auto& list) {
    using E = ElementOf<decltype(list)>;
    if constexpr (is_pin<E>) {
      // Phi by an angle is R a, a the arm: (R a)' = -a omega, (R a)'' = -a alpha - R a omega^2.
      for (int e = 0; e < block.size(); ++e) {
        const std::size_t row = at(block.row(e));
        const auto weight = [&](std::span<const double> w) {
          return w.empty() ? Vec2<double>{} : Vec2<double>{w[row], w[row + 1]};
        };
        const Vec2<double> bend = weight(weights.bend), rate = weight(weights.rate);
        for (int b = 0; b < 2; ++b) {
          const int body = b == 0 ? block.body_i[at(e)] : block.body_j[at(e)];
          const Frame<Series>& f = motion_[at(body)];
          const Vec2<double> arm = arm_of(block, list[at(block.entry[at(e)])].element, e, b, motion_);
          const double sign = b == 0 ? -1 : 1, along = dot(bend, arm), across = cross(arm, bend);
          const std::size_t c = at(3 * body + 2);
          by_q[c] += sign * (along * f.phi.dd + across * f.phi.d * f.phi.d + dot(rate, arm) * f.phi.d);
          by_qd[c] += sign * 2 * along * f.phi.d;
        }
      }
    } else if constexpr (detail::has_adjoint<E>) {
      constexpr int columns = 3 * E::bodies;
      using D = Dual<Series, columns>;
      for (int e = 0; e < block.size(); ++e) {
        if (!detail::rows_weigh(weights.bend, block.row(e), E::rows) &&
            !detail::rows_weigh(weights.rate, block.row(e), E::rows))
          continue;
        const auto& entry = list[at(block.entry[at(e)])];
        const auto f = detail::design_frames<Series>(block, e, plan_->moving, origin_,
                                                     [&](int body) { return motion_[at(body)]; });
        const Frame<D> i = seed<Series, columns>(f.i, 0);
        Frame<D> j;
        if constexpr (E::bodies == 2) j = seed<Series, columns>(f.j, 3);
        D rows[E::rows];
        const CurvePlace& contact = contact_of(block, contacts_, block.entry[at(e)]);
        entry.element.phi(Arguments<D>{i, j, D(detail::value_of_entry(entry, values_)), f.ground, &contact}, rows);
        for (int r = 0; r < E::rows; ++r) {
          const std::size_t row = at(block.row(e) + r);
          const double bend = weights.bend.empty() ? 0 : scale_[at(entry.id)] * weights.bend[row];
          const double rate = weights.rate.empty() ? 0 : scale_[at(entry.id)] * weights.rate[row];
          for (int k = 0; k < columns; ++k) {
            const int body = k < 3 ? block.body_i[at(e)] : block.body_j[at(e)];
            const std::size_t c = at(3 * body + k % 3);
            const Series& slope = rows[r].d[at(k)];
            by_q[c] -= bend * slope.dd + rate * slope.d;
            by_qd[c] -= 2 * bend * slope.d;
          }
        }
      }
    }
  });
}

void AdjointMechanism::add_forces_by_state(const Evaluator& evaluator, std::span<const double> w,
                                           std::span<double> by_q, std::span<double> by_qd) const {
  using D = Dual<double, 12>;  // by the poses of both bodies, then by their rates
  const auto twist = [&](int body, int first) {
    const double* rate = rates_.data() + 3 * body;
    return Twist<D>{D::variable(rate[0], first), D::variable(rate[1], first + 1), D::variable(rate[2], first + 2)};
  };
  for_each_list(plan_->forces, model_->forces, [&](const auto& block, const auto& list, int) {
    using E = ElementOf<decltype(list)>;
    if constexpr (!is_custom<E> && !Sharing<E>) {
      for (int e = 0; e < block.size(); ++e) {
        const auto& entry = list[at(block.entry[at(e)])];
        const int body_i = block.body_i[at(e)], body_j = E::bodies == 2 ? block.body_j[at(e)] : plan_->bodies;
        const auto f = detail::design_frames<double>(block, e, plan_->moving, origin_,
                                                     [&](int body) { return evaluator.frames()[at(body)]; });
        const Frame<D> i = seed<double, 12>(f.i, 0);
        const Frame<D> j = seed<double, 12>(f.j, 3);
        std::array<D, E::functions + 1> values;
        for (std::size_t n = 0; n < entry.values.size(); ++n) {
          const auto& value = entry.values[n];
          values[n] = value.function < 0 ? D(value.constant) : D(values_[at(value.function)].f);
        }
        const Twist<D> u = twist(body_i, 6), v = twist(body_j, 9);
        Wrench<D> on_i, on_j;
        entry.element.force(ForceArguments<D>{i, j, u, v, values.data(), f.ground}, on_i, on_j);
        const double* wi = w.data() + 3 * body_i;
        const double* wj = w.data() + 3 * body_j;
        D power = D(wi[0]) * on_i.fx + D(wi[1]) * on_i.fy + D(wi[2]) * on_i.moment;
        if (E::bodies == 2) power += D(wj[0]) * on_j.fx + D(wj[1]) * on_j.fy + D(wj[2]) * on_j.moment;
        for (int k = 0; k < 3 * E::bodies; ++k) {
          const std::size_t c = at(3 * (k < 3 ? body_i : body_j) + k % 3);
          by_q[c] += power.d[at(k)];
          by_qd[c] += power.d[at(6 + k)];
        }
      }
    }
  });
}

void AdjointMechanism::add_by_state(const Evaluator& evaluator, const AdjointWeights& weights, std::span<double> by_q,
                                    std::span<double> by_qd) {
  if (!weights.bend.empty() || !weights.rate.empty()) {
    add_constraints_by_q(weights, by_q, by_qd);
    add_slides_by_q(weights, by_q, by_qd);
  }
  if (weights.w.empty()) return;
  if (weights.forces) add_forces_by_state(evaluator, weights.w, by_q, by_qd);
  if (weights.lambda.empty()) return;
  add_curvature(weights, by_q);
  add_slides_curvature(weights, by_q);
}

// sum lambda Phi_qq w: the change of Phi_q^T lambda along w.
void AdjointMechanism::add_curvature(const AdjointWeights& weights, std::span<double> by_q) const {
  detail::visit_constraints(*plan_, *model_, [&](const auto& block, const auto& list) {
    using E = ElementOf<decltype(list)>;
    if constexpr (is_pin<E>) {
      for (int e = 0; e < block.size(); ++e) {
        const std::size_t row = at(block.row(e));
        const Vec2<double> lambda{weights.lambda[row], weights.lambda[row + 1]};
        for (int b = 0; b < 2; ++b) {
          const std::size_t c = at(3 * (b == 0 ? block.body_i[at(e)] : block.body_j[at(e)]) + 2);
          const double turning = dot(lambda, arm_of(block, list[at(block.entry[at(e)])].element, e, b, motion_));
          by_q[c] += (b == 0 ? -1 : 1) * turning * weights.w[c];
        }
      }
    } else if constexpr (detail::has_adjoint<E>) {
      constexpr int columns = 3 * E::bodies;
      using Along = Dual<double, 1>;
      using D = Dual<Along, columns>;
      const auto frame = [&](int body) {
        const Frame<Series>& f = motion_[at(body)];
        const double* w = weights.w.data() + 3 * body;
        return Frame<Along>{
            {f.x.f, {w[0]}}, {f.y.f, {w[1]}}, {f.phi.f, {w[2]}}, {f.c.f, {-f.s.f * w[2]}}, {f.s.f, {f.c.f * w[2]}}};
      };
      for (int e = 0; e < block.size(); ++e) {
        if (!detail::rows_weigh(weights.lambda, block.row(e), E::rows)) continue;
        const auto& entry = list[at(block.entry[at(e)])];
        const auto f = detail::design_frames<Along>(block, e, plan_->moving, origin_, frame);
        const Frame<D> i = seed<Along, columns>(f.i, 0);
        Frame<D> j;
        if constexpr (E::bodies == 2) j = seed<Along, columns>(f.j, 3);
        D rows[E::rows];
        const D value(Along(detail::value_of_entry(entry, values_).f));
        const CurvePlace& contact = contact_of(block, contacts_, block.entry[at(e)]);
        entry.element.phi(Arguments<D>{i, j, value, f.ground, &contact}, rows);
        for (int r = 0; r < E::rows; ++r) {
          const double lambda = scale_[at(entry.id)] * weights.lambda[at(block.row(e) + r)];
          for (int k = 0; k < columns; ++k) {
            const int body = k < 3 ? block.body_i[at(e)] : block.body_j[at(e)];
            by_q[at(3 * body + k % 3)] -= lambda * rows[r].d[at(k)].d[0];
          }
        }
      }
    }
  });
}

}  // namespace catena
