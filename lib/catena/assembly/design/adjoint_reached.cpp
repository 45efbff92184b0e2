// AdjointMechanism::Reached: what design parameters reach.
#include <algorithm>
#include <iterator>
#include <limits>
#include <string_view>
#include <type_traits>

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

/// Pieces of curves are cubic in their parameter, and samples are more than a cubic has zeros.
bool curve_moves(const BodyCurve<DesignScalar>& curve) {
  if (!curve) return false;
  const auto moves_at = [&](double s) {
    const CurvePoint<DesignScalar> there = curve.evaluate(DesignScalar(s));
    return moves(there.p) || moves(there.d1);
  };
  if (curve.is_line()) return moves_at(0);
  const std::vector<double> samples = curve.samples();
  return std::any_of(samples.begin(), samples.end(), moves_at);
}

/// Whether a parameter may be in a member that a scene sets. Of tables nothing is known: it may.
template <class Member>
bool member_moves(const Member& member) {
  if constexpr (std::is_same_v<Member, DesignScalar> || std::is_same_v<Member, Vec2<DesignScalar>>) {
    return moves(member);
  } else if constexpr (std::is_same_v<Member, BodyCurve<DesignScalar>>) {
    return curve_moves(member);
  } else {
    return !std::is_arithmetic_v<Member> && !std::is_enum_v<Member>;
  }
}
/// What a place of contact presses and rubs with: its equation does not read it.
constexpr std::string_view pressing[] = {"k", "c", "exponent", "restitution", "rest_speed", "mu", "mu_static", "vs"};

/// Of one-sided elements what their equations read alone.
template <class E>
bool fields_move(const E& element) {
  return std::apply(
      [&](const auto&... field) {
        const auto look = [&](const auto& f) {
          if (OneSided<E> && std::find(std::begin(pressing), std::end(pressing), f.key) != std::end(pressing))
            return false;
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

bool contact_moves(const DesignModel& model, int element) {
  const ElementRecord& record = model.elements[at(element)];
  bool found = true;
  with_list(model.constraints, record.type,
            [&](const auto& list) { found = fields_move(list[at(record.index)].element); });
  return found;
}

}  // namespace

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

AdjointMechanism::Reached::Reached(const AdjointMechanism& adjoint, const DesignMechanism& mechanism,
                                   std::span<const SlideOfContact> slides) {
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
      if (!(by_body || entry_moves(entry, model) || fields_move(entry.element) || own(entry))) continue;
      ++elements_;
      if constexpr (std::is_same_v<E, Revolute<DesignScalar>>) {
        if (take_pin(adjoint, block.row(e), {block.body_i[at(e)], block.body_j[at(e)]}, entry.element)) continue;
      }
      reached.push_back(e);
    }
  };
  for_each_list(plan.blocks, model.constraints, [&](const auto& block, const auto& list, int) {
    using Plain = typename std::remove_cvref_t<decltype(block)>::Element;
    // Those that search along curves have nothing beside their fields; slides are made of what their contacts are. Of
    // others that show scalars alone nothing is known: a parameter may be in them.
    if constexpr (HasCurve<Plain>)
      collect(block, list, constraints_, [](const auto&) { return false; });
    else if constexpr (detail::has_adjoint<Plain>)
      collect(block, list, constraints_, [](const auto& entry) { return phi_moves(entry.element); });
    else if constexpr (detail::is_slide<Plain>)
      collect(block, list, constraints_, [&](const auto& entry) {
        const auto known = std::find_if(slides.begin(), slides.end(),
                                        [&](const SlideOfContact& slide) { return slide.slide == entry.id; });
        return known == slides.end() || contact_moves(model, known->contact);
      });
    else
      constraints_.emplace_back();
  });
  for_each_list(plan.forces, model.forces, [&](const auto& block, const auto& list, int) {
    using Plain = typename std::remove_cvref_t<decltype(block)>::Element;
    if constexpr (detail::is_differentiated<Plain>)
      collect(block, list, forces_, [](const auto& entry) { return force_moves(entry.element); });
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

}  // namespace catena
