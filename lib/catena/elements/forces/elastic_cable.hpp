// elastic_cable: a spring that pulls only; a scene writes it as a cable with a stiffness k.
//
//   h = r_Pj - r_Pi    l = |h|    f = k max(l - L, 0)        on i +f h/l at P_i, on j -f h/l at P_j
//   V = k max(l - L, 0)^2 / 2        gap L - l
//
// Symbols: k N/m, L > 0 m, f N (tension positive). f is continuous, its slope jumps where the cable becomes taut. Never
// singular: the direction h/l counts only where l > L > 0. Source: Haug, section 6.2.
#pragma once

#include "catena/elements/force_element.hpp"
#include "catena/elements/pair_motion.hpp"

namespace catena {

template <class S = double>
struct ElasticCable {
  static constexpr std::string_view type = "cable";
  static constexpr std::string_view summary = "A cable between two points that pulls only, elastic when taut.";
  static constexpr std::string_view equation = "f = k max(|h| - L, 0),  +f h/|h| on i, -f h/|h| on j";
  static constexpr int bodies = 2;
  static constexpr int functions = 0;

  Vec2<S> s_i{}, s_j{};
  S length{-1.0}, k{};  // a negative length: not given, taken from the given configuration

  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"i", &ElasticCable::s_i, 0, "the end P_i on body i"},
        PointField{"j", &ElasticCable::s_j, 1, "the end P_j on body j"},
        NumberField{"length", &ElasticCable::length, UnitKind::length, Domain::positive, false,
                    "its length L without tension (default: the given distance)"},
        NumberField{"k", &ElasticCable::k, UnitKind::stiffness, Domain::positive, true, "stiffness when taut"});
  }

  void complete(const Frame<S>& i, const Frame<S>& j) {
    if (value_of(length) < 0) length = norm(separation(i, j, s_i, s_j));
  }
  const char* check() const { return value_of(length) > 0 ? nullptr : "a cable needs a length above zero"; }

  /// L - l, m.
  template <class T>
  T slack(const Frame<T>& i, const Frame<T>& j) const {
    const Vec2<T> h = separation(i, j, s_i, s_j);
    return value_of(squared_norm(h)) > 0 ? T(length) - norm(h) : T(length);
  }
  template <class T>
  void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const {
    const T stretch = -slack(a.i, a.j);
    if (!(value_of(stretch) > 0)) return;
    const Vec2<T> h = separation(a.i, a.j, s_i, s_j);
    const Vec2<T> pull = (T(k) * stretch / (stretch + T(length))) * h;
    add_force_at(a.i.axis(s_i), pull, on_i);
    add_force_at(a.j.axis(s_j), -pull, on_j);
  }
  template <class T>
  T potential(const ForceArguments<T>& a) const {
    const T stretch = -slack(a.i, a.j);
    return value_of(stretch) > 0 ? T(0.5) * T(k) * stretch * stretch : T(0.0);
  }
};

}  // namespace catena
