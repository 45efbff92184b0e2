// rope: an inextensible rope of length L over pulleys, or points, of any bodies: it pulls, and is slack otherwise. With
// a stiffness k it is an elastic_rope.hpp instead.
//
//   Psi = L - sum_k f_k >= 0       f_k: straight stretch k with its parts of the arcs, rope_span.hpp
//
// One row, one tension: the rope slides over its pulleys. This element holds L and the first stretch, from a point of
// body i to the first circle, on body j; the other stretches are elements of their own that add to its row
// (rope_part.hpp). A rope over pulleys that roll is several of these, one from pulley to pulley. p at Psi = 0: the
// tension at the end i, N; friction on pulleys changes it on the way, in motion (analysis/contact/rope_grips.hpp).
// Singular where one circle holds the next. Source: rope_span.hpp, gap_element.hpp.
#pragma once

#include "catena/elements/gap_element.hpp"
#include "catena/elements/rope_span.hpp"

namespace catena {

template <class S>
struct RopePart;

template <class S = double>
struct Rope : RopeSpan<S> {
  using Base = RopeSpan<S>;
  using Part = RopePart<S>;
  static constexpr std::string_view type = "rope";
  static constexpr std::string_view summary =
      "A rope over pulleys that pulls only: inextensible, or elastic where k is given.";
  static constexpr std::string_view equation =
      "L - (straight stretches + arcs on the pulleys) >= 0,  tension >= 0,  one of them zero";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 0;
  static constexpr bool one_sided = true;

  S length{-1.0};                     // negative: not given, taken from the given configuration
  S k{};                              // only the scene reader's: zero is inextensible
  S restitution{}, rest_speed{-1.0};  // negative: not given
  int first_part = 0, parts = 0;      // its other stretches, in the model's list of rope parts

  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"i", &Rope::s_i, 0, "the end P_i on body i"}, PulleysField{"over", "what it runs over, from i to j"},
        PointField{"j", &Rope::s_j, 1, "the end P_j on body j"},
        NumberField{"length", &Rope::length, UnitKind::length, Domain::positive, false,
                    "its length L without tension (default: that of the given way)"},
        NumberField{"k", &Rope::k, UnitKind::stiffness, Domain::positive, false,
                    "stiffness of the whole rope when taut, of its length without tension (default: inextensible)"},
        NumberField{"restitution", &Rope::restitution, UnitKind::none, Domain::not_negative, false,
                    "of the jerk when it becomes taut in motion, 0 ... 1 (default 0)"},
        NumberField{"rest_speed", &Rope::rest_speed, UnitKind::velocity, Domain::not_negative, false,
                    "a slower rebound is none (default: 1e-4 of the speed of the motion)"});
  }
  template <class Pen>
  void draw(Pen& pen) const {
    pen.rope(this->s_i, value_of(this->radius_i), this->s_j, value_of(this->radius_j));
  }

  const char* check() const { return check_impact_and_friction(value_of(restitution), 0, -1); }

  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j) const {
    return T(length) - this->extent(i, j);
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    out[0] = measure(a.i, a.j);
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    this->gradient(PairGeometry(a, this->s_i, this->s_j), entries);
    for (std::size_t n = 0; n < jacobian_size<Rope>; ++n) entries[n] = -entries[n];
  }
  void gamma(const Arguments<double>& a, const Rates& u, const Rates& v, double* out) const {
    out[0] = this->bend(PairMotion(a, this->s_i, this->s_j, u, v));
  }
};

}  // namespace catena
