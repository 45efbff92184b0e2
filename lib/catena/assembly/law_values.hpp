// Values of laws of state with any scalar: what state_laws.hpp says in equations.
//
// Source files alone include it: this is where laws meet every force element.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "catena/assembly/careful_dual.hpp"
#include "catena/assembly/state_laws.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/attachment.hpp"

namespace catena {

/// Values of laws at the state that `View` shows: time(), frame(plan body) in the ground frame, twist(plan body), and
/// function(number), the model's functions of time, all in the scalar T.
template <class T, class S, class View>
class LawValues {
 public:
  /// All must outlive this object.
  LawValues(const BasicModel<S>& model, std::span<const CompiledLaw<S>> laws, const View& view)
      : model_(model), laws_(laws), view_(view) {}

  T value(int law) const {
    const CompiledLaw<S>& compiled = laws_[static_cast<std::size_t>(law)];
    const T plain = compiled.formula.evaluate_beyond([&](std::uint32_t k) { return input(compiled.inputs[k]); });
    // Over numbers with derivatives of their own there is no such second look: it is not a number then.
    if constexpr (requires { std::isfinite(plain.d[0]); }) {
      const auto is_number = [](double derivative) { return std::isfinite(derivative); };
      if (std::isfinite(plain.v) && !std::all_of(plain.d.begin(), plain.d.end(), is_number)) return carefully(compiled);
    }
    return plain;
  }

  T input(const LawInput<S>& input) const {
    switch (input.kind) {
      case ColumnKind::time:
        return view_.time();
      case ColumnKind::x:
        return place(input).x;
      case ColumnKind::y:
        return place(input).y;
      case ColumnKind::angle:
        return view_.frame(input.i).phi;
      case ColumnKind::vx:
        return velocity(input).x;
      case ColumnKind::vy:
        return velocity(input).y;
      case ColumnKind::omega:
        return view_.twist(input.i).omega;
      case ColumnKind::joint_angle:
      case ColumnKind::turn:
        return view_.frame(input.j).phi - view_.frame(input.i).phi;
      case ColumnKind::joint_omega:
        return view_.twist(input.j).omega - view_.twist(input.i).omega;
      case ColumnKind::slide:
        return slide(input).f;
      case ColumnKind::slide_rate:
        return slide(input).d;
      case ColumnKind::length:
        return length(input).f;
      case ColumnKind::length_rate:
        return length(input).d;
      case ColumnKind::tension:
      case ColumnKind::spring_torque:
        return spring(input);
      default:
        return T(0.0);  // bind_state_laws() lets no other kind in
    }
  }

 private:
  /// Where a part of the formula has no derivative.
  T carefully(const CompiledLaw<S>& compiled) const {
    using C = CarefulDual<T>;
    const auto depending = [&](std::uint32_t k) {
      C number(input(compiled.inputs[k]));
      // Rates depend on places only where they are not zero; what else is read may bend beside its derivative.
      if (!is_rate(compiled.inputs[k].kind) && compiled.inputs[k].kind != ColumnKind::time) number.depends.fill(true);
      return number;
    };
    return compiled.formula
        .evaluate_with(depending,
                       [](const NamedTable<S>& table, const C& place) {
                         C number = place;
                         number.x = table.curve.evaluate(place.x).f;
                         return number.mended();
                       })
        .x;
  }
  static bool is_rate(ColumnKind kind) {
    return kind == ColumnKind::vx || kind == ColumnKind::vy || kind == ColumnKind::omega ||
           kind == ColumnKind::joint_omega || kind == ColumnKind::slide_rate || kind == ColumnKind::length_rate;
  }
  static Vec2<T> lifted(const Vec2<S>& v) { return {T(v.x), T(v.y)}; }
  Vec2<T> place(const LawInput<S>& input) const { return view_.frame(input.i).point(lifted(input.point_i)); }
  Vec2<T> velocity(const LawInput<S>& input) const {
    const Twist<T> v = view_.twist(input.i);
    return Vec2<T>{v.vx, v.vy} + v.omega * perpendicular(view_.frame(input.i).axis(lifted(input.point_i)));
  }
  Frame<Taylor<T>> motion(int body) const {
    const Twist<T> v = view_.twist(body);
    return moving(view_.frame(body), v.vx, v.vy, v.omega);
  }
  static Vec2<Taylor<T>> still(const Vec2<S>& v) { return {Taylor<T>(T(v.x)), Taylor<T>(T(v.y))}; }
  Vec2<Taylor<T>> apart(const LawInput<S>& input) const {
    return motion(input.j).point(still(input.point_j)) - motion(input.i).point(still(input.point_i));
  }
  Taylor<T> slide(const LawInput<S>& input) const { return dot(motion(input.i).axis(still(input.axis)), apart(input)); }
  Taylor<T> length(const LawInput<S>& input) const {
    const Vec2<Taylor<T>> h = apart(input);
    // Where the points meet the length has no derivative.
    return value_of(squared_norm(h)) > 0 ? norm(h) : Taylor<T>(T(0.0));
  }

  /// Tension, or torque on body i, of a spring: the columns of columns/spring_of.hpp.
  T spring(const LawInput<S>& input) const {
    const ElementRecord& record = model_.elements[static_cast<std::size_t>(input.element)];
    T result(0.0);
    with_list(model_.forces, record.type, [&](const auto& list) {
      using E = ElementOf<decltype(list)>;
      constexpr bool known = std::is_same_v<E, SpringDamper<S>> || std::is_same_v<E, TorsionSpring<S>> ||
                             std::is_same_v<E, ElasticCable<S>> || std::is_same_v<E, Torque<S>>;
      if constexpr (known) {
        const auto& entry = list[static_cast<std::size_t>(record.index)];
        std::array<T, static_cast<std::size_t>(E::functions) + 1> f{};
        for (std::size_t k = 0; k < entry.values.size(); ++k) {
          const FunctionValue<S>& value = entry.values[k];
          f[k] = value.law >= 0        ? this->value(value.law)
                 : value.function >= 0 ? view_.function(value.function)
                                       : T(value.constant);
        }
        const Frame<T> i = view_.frame(input.i), j = view_.frame(input.j);
        const Twist<T> u = view_.twist(input.i), v = view_.twist(input.j);
        Wrench<T> on_i, on_j;
        entry.element.force(ForceArguments<T>{i, j, u, v, f.data(), {}}, on_i, on_j);
        if (input.kind == ColumnKind::spring_torque) {
          result = on_i.moment;
        } else {
          const Vec2<T> h = j.point(lifted(input.point_j)) - i.point(lifted(input.point_i));
          if (value_of(squared_norm(h)) > 0) result = dot(Vec2<T>{on_i.fx, on_i.fy}, h) / norm(h);
        }
      }
    });
    return result;
  }

  const BasicModel<S>& model_;
  std::span<const CompiledLaw<S>> laws_;
  const View& view_;
};

}  // namespace catena
