// elastic_rope: a spring over pulleys that pulls only; a scene writes it as a rope with a stiffness k.
//
//   s = sum_k f_k - L       N = k max(s, 0)       V = k max(s, 0)^2 / 2       f_k: rope_span.hpp
//   Q = -N sum_k (f_k)_q       V_qq = N sum_k (f_k)_qq + k g g^T,   g = sum_k (f_k)_q   (taut)
//
// s depends on all bodies of the rope at once, but an element has two: each stretch is one, and each pair of bodies
// that no stretch joins is one (a bridge), for its part of g g^T. What they share - s, and g on their bodies - is found
// once a configuration and part of its pose (SharedStretch). Symbols: k N/m, L > 0 m, N tension, N. The slope of N
// jumps where the rope becomes taut. Singular as rope_span.hpp. Source: rope_span.hpp; Haug, section 6.2.
#pragma once

#include "catena/elements/force_element.hpp"
#include "catena/elements/rope_span.hpp"

namespace catena {

template <class S = double>
struct ElasticRope : RopeSpan<S> {
  static constexpr std::string_view type = "rope";
  static constexpr std::string_view summary = "A rope over pulleys that pulls only, elastic when taut.";
  static constexpr std::string_view equation = "N = k max(straight stretches + arcs - L, 0)";
  static constexpr int bodies = 2;
  static constexpr int functions = 0;
  static constexpr bool shares = true;

  S length{-1.0}, k{};
  bool bridge = false;
  int pieces = 0;                                          // of the first one: how many the rope has, in a row
  bool owns_i = false, owns_j = false, owns_pair = false;  // which blocks of g g^T are this element's

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &ElasticRope::s_i, 0, "the centre of its first circle"},
                           PointField{"j", &ElasticRope::s_j, 1, "the centre of its second circle"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    if (pieces > 0) pen.rope(this->s_i, value_of(this->radius_i), this->s_j, value_of(this->radius_j));
  }
  /// f; zero for a bridge.
  template <class T>
  T way(const Frame<T>& i, const Frame<T>& j) const {
    return bridge ? T(0.0) : this->extent(i, j);
  }
  /// The forces of this stretch at a tension.
  template <class T>
  void pull(const T& tension, const Frame<T>& i, const Frame<T>& j, Wrench<T>& on_i, Wrench<T>& on_j) const {
    if (bridge) return;
    const Vec2<T> h = separation(i, j, this->s_i, this->s_j);
    const Vec2<T> force = (tension / squared_norm(h)) * this->line(h).along;
    add_force_at(i.axis(this->s_i), force, on_i);
    add_force_at(j.axis(this->s_j), -force, on_j);
    on_i.moment = on_i.moment - tension * T(this->turn_i);
    on_j.moment = on_j.moment - tension * T(this->turn_j);
  }
  template <class T>
  void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const {
    const double stretch = a.shared->stretch;
    if (stretch != 0) pull(T(k) * T(stretch), a.i, a.j, on_i, on_j);
  }
  template <class T>
  T potential(const ForceArguments<T>& a) const {
    const double stretch = a.shared->stretch;
    return pieces > 0 ? T(0.5) * T(k) * T(stretch) * T(stretch) : T(0.0);
  }
  void stiffness(const ForceArguments<double>& a, double* entries) const {
    constexpr auto pattern = full_lower_triangle<6>();
    using Inner = Dual<double, 6>;
    using Outer = Dual<Inner, 6>;
    Outer f;
    const auto& [stretch, g_i, g_j] = *a.shared;
    if (stretch != 0 && !bridge) {
      f = this->extent(seed<Inner, 6>(seed<double, 6>(a.i, 0), 0), seed<Inner, 6>(seed<double, 6>(a.j, 3), 3));
    }
    for (std::size_t n = 0; n < pattern.size(); ++n) {
      const auto r = static_cast<std::size_t>(pattern[n].row), c = static_cast<std::size_t>(pattern[n].column);
      entries[n] = 0;
      if (stretch == 0) continue;
      const bool own = r < 3 ? owns_i : c < 3 ? owns_pair : owns_j;
      const double g_r = r < 3 ? g_i[r] : g_j[r - 3], g_c = c < 3 ? g_i[c] : g_j[c - 3];
      entries[n] = k * stretch * f.d[r].d[c] + (own ? k * g_r * g_c : 0);
    }
  }
};

/// L - sum f of the rope whose first element is number `head` of the list; `frame_of` gives the frame of a body.
template <class T, class List, class FrameOf>
T rope_slack(const List& list, int head, FrameOf&& frame_of) {
  const auto& first = list[static_cast<std::size_t>(head)].element;
  T slack = T(first.length);
  for (int n = 0; n < first.pieces; ++n) {
    const auto& entry = list[static_cast<std::size_t>(head + n)];
    slack = slack - entry.element.way(frame_of(entry.i), frame_of(entry.j));
  }
  return slack;
}

}  // namespace catena
