// AdjointMechanism: derivatives by design parameters, of what these reach.
#include <algorithm>
#include <iterator>
#include <limits>
#include <type_traits>

#include "catena/assembly/curve_contacts.hpp"
#include "catena/assembly/design/adjoint_mechanism.hpp"
#include "catena/assembly/design/element_motion.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

using detail::DesignSeries;

bool moves(const DesignScalar& x) {
  return std::any_of(x.d.begin(), x.d.end(), [](double d) { return d != 0; });
}
bool moves(const Vec2<DesignScalar>& v) { return moves(v.x) || moves(v.y); }
bool moves(const DesignSeries& x) { return moves(x.f) || moves(x.d) || moves(x.dd); }
/// A frame of an immobile body.
bool moves(const Frame<DesignSeries>& f) { return moves(f.x) || moves(f.y) || moves(f.phi); }

/// Whether a parameter may be in a member that a scene sets. Of curves and tables nothing is known: it may.
template <class Member>
bool member_moves(const Member& member) {
  if constexpr (std::is_same_v<Member, DesignScalar> || std::is_same_v<Member, Vec2<DesignScalar>>) {
    return moves(member);
  } else {
    return !std::is_arithmetic_v<Member> && !std::is_enum_v<Member>;
  }
}
template <class E>
bool fields_move(const E& element) {
  return std::apply(
      [&](const auto&... field) {
        const auto look = [&](const auto& f) {
          if constexpr (requires { element.*f.member; })
            return member_moves(element.*f.member);
          else
            return false;
        };
        return (look(field) || ...);
      },
      E::fields());
}

/// Poses and rates of no special kind, at which what completes an element shows as well.
constexpr double places[2][6] = {{0.31, -0.72, 0.53, 1.27, 0.44, -0.86}, {-1.13, 0.37, 2.21, 0.29, 1.58, 0.67}};
template <class T>
Frame<T> some_frame(const double* place) {
  return make_frame(T(place[0]), T(place[1]), T(place[2]));
}

/// Instants of no special kind, s.
constexpr double instants[] = {0.37, -1.61, 2.93};

/// Whether a parameter may be in a function of time. Those without breakpoints are analytic: what moves them shows at
/// any instant but single ones. Of pieces and tables, which parameters move here and there, nothing is known: it may.
bool function_moves(const TimeFunction<DesignScalar>& function) {
  constexpr double never = std::numeric_limits<double>::infinity();
  const bool analytic = !function.has_callback() && function.next_breakpoint(-never) == never &&
                        function.next_breakpoint(0) == never;  // of periodic ones, which have no first breakpoint
  return !analytic ||
         std::any_of(std::begin(instants), std::end(instants), [&](double t) { return moves(function.evaluate(t)); });
}

template <class Entry>
bool entry_moves(const Entry& entry, const DesignModel& model) {
  return std::any_of(entry.values.begin(), entry.values.end(), [&](const auto& value) {
    return value.function >= 0 ? function_moves(model.functions[at(value.function)])
                               : moves(DesignScalar(value.constant));
  });
}

template <class E>
bool phi_moves(const E& element) {
  for (const auto& place : places) {
    const auto i = some_frame<DesignScalar>(place), j = some_frame<DesignScalar>(place + 3);
    DesignScalar rows[E::rows];
    element.phi(Arguments<DesignScalar>{i, j, DesignScalar(0.4), {}}, rows);
    for (const DesignScalar& row : rows) {
      if (moves(row)) return true;
    }
  }
  return false;
}

template <class E>
bool force_moves(const E& element) {
  std::array<DesignScalar, E::functions + 1> values;
  values.fill(DesignScalar(1.3));
  for (const auto& place : places) {
    const auto i = some_frame<DesignScalar>(place), j = some_frame<DesignScalar>(place + 3);
    const Twist<DesignScalar> u{0.3, -0.5, 0.7}, v{-0.2, 0.9, 0.4};
    Wrench<DesignScalar> on_i, on_j;
    element.force(ForceArguments<DesignScalar>{i, j, u, v, values.data(), {}}, on_i, on_j);
    for (const DesignScalar& part : {on_i.fx, on_i.fy, on_i.moment, on_j.fx, on_j.fy, on_j.moment}) {
      if (moves(part)) return true;
    }
  }
  return false;
}

}  // namespace

// With the arms a = A s: h_p = A s_p, h'_p = R A s_p omega, h''_p = R A s_p alpha - A s_p omega^2, (h_q w)_p = R A s_p
// w_phi.
void AdjointMechanism::add_pins(const Reached& reached, const AdjointWeights& weights,
                                std::array<double, parameters_at_once>& sum) const {
  const auto turned_back = [](const Vec2<double>& v) { return Vec2<double>{v.y, -v.x}; };  // R^T v
  for (const Reached::PinEnd& end : reached.pins_) {
    const auto weight = [row = at(end.row)](std::span<const double> w) {
      return w.empty() ? Vec2<double>{} : Vec2<double>{w[row], w[row + 1]};
    };
    const Frame<Series>& f = motion_[at(end.body)];
    const double omega = f.phi.d, w = weights.w.empty() ? 0 : weights.w[at(3 * end.body + 2)];
    const Vec2<double> bend = weight(weights.bend);
    const Vec2<double> all = weight(weights.phi) - (omega * omega) * bend +
                             turned_back(omega * weight(weights.rate) + f.phi.dd * bend + w * weight(weights.lambda));
    const double x = f.c.f * all.x + f.s.f * all.y, y = f.c.f * all.y - f.s.f * all.x;
    for (std::size_t p = 0; p < sum.size(); ++p) sum[p] -= x * end.x[p] + y * end.y[p];
  }
}

// False where a body that does not move, or an angle that is no unknown, may be moved by parameters itself.
bool AdjointMechanism::Reached::take_pin(const AdjointMechanism& adjoint, int row, const std::array<int, 2>& bodies,
                                         const Revolute<DesignScalar>& pin) {
  const Plan& plan = adjoint.plan();
  for (const int body : bodies) {
    if (adjoint.is_immobile(body) || (body < plan.moving && plan.column[at(3 * body + 2)] < 0)) return false;
  }
  for (const bool second : {false, true}) {
    const Vec2<DesignScalar>& s = second ? pin.s_j : pin.s_i;
    if (!moves(s)) continue;
    PinEnd end{row, bodies[second ? 1 : 0], s.x.d, s.y.d};
    for (std::size_t p = 0; p < end.x.size() && !second; ++p) {
      end.x[p] = -end.x[p];
      end.y[p] = -end.y[p];
    }
    pins_.push_back(end);
  }
  return true;
}

void AdjointMechanism::Reached::take_masses(const Plan& plan, const DesignMechanism& mechanism) {
  const Vec2<DesignScalar>& gravity = mechanism.model().gravity;
  for (int c = 0; c < 3 * plan.moving; ++c) {
    if (!moves(mechanism.mass(c))) continue;
    masses_.push_back(Mass{c, c % 3 == 0 ? gravity.x.v : c % 3 == 1 ? gravity.y.v : 0, mechanism.mass(c).d});
  }
}

AdjointMechanism::Reached::Reached(const AdjointMechanism& adjoint, const DesignMechanism& mechanism) {
  const Plan& plan = adjoint.plan();
  const DesignModel& model = mechanism.model();
  const auto body_moves = [&](int body) {
    return (body >= plan.moving && body < plan.bodies && moves(mechanism.motion(body))) ||
           (body < plan.moving && plan.column[at(3 * body + 2)] < 0 &&
            moves(model.bodies[at(plan.model_body[at(body)])].angle));
  };
  const auto collect = [&](const auto& block, const auto& list, std::vector<std::vector<int>>& all, auto&& own) {
    using E = ElementOf<decltype(list)>;
    std::vector<int>& reached = all.emplace_back();
    for (int e = 0; e < block.size(); ++e) {
      const auto& entry = list[at(block.entry[at(e)])];
      const bool by_body = body_moves(block.body_i[at(e)]) || (E::bodies == 2 && body_moves(block.body_j[at(e)]));
      if (!(by_body || entry_moves(entry, model) || fields_move(entry.element) || own(entry.element))) continue;
      ++elements_;
      if constexpr (std::is_same_v<E, Revolute<DesignScalar>>) {
        if (take_pin(adjoint, block.row(e), {block.body_i[at(e)], block.body_j[at(e)]}, entry.element)) continue;
      }
      reached.push_back(e);
    }
  };
  for_each_list(plan.blocks, model.constraints, [&](const auto& block, const auto& list, int) {
    using Plain = typename std::remove_cvref_t<decltype(block)>::Element;
    // Of slides, which search along curves from where they are, nothing is tried: a parameter may be in them.
    if constexpr (detail::has_adjoint<Plain>)
      collect(block, list, constraints_, [](const auto& element) { return phi_moves(element); });
    else if constexpr (detail::is_slide<Plain>)
      collect(block, list, constraints_, [](const auto&) { return true; });
    else
      constraints_.emplace_back();
  });
  for_each_list(plan.forces, model.forces, [&](const auto& block, const auto& list, int) {
    using Plain = typename std::remove_cvref_t<decltype(block)>::Element;
    if constexpr (detail::is_differentiated<Plain>)
      collect(block, list, forces_, [](const auto& element) { return force_moves(element); });
    else
      forces_.emplace_back();
  });
  const auto any = [](const auto& lists) {
    return std::any_of(lists.begin(), lists.end(), [](const auto& list) { return !list.empty(); });
  };
  any_constraint_ = any(constraints_);
  any_force_ = any(forces_);
  take_masses(plan, mechanism);
  gravity_ = moves(model.gravity);
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
