// rope_part: a further stretch of an inextensible rope (rope.hpp), whose row it adds to.
//
//   Psi += -f       f: rope_span.hpp
//
// A bridge adds nothing: it stands between two bodies that the rope ties across others that stand still, so that they
// count as tied. Singular as rope_span.hpp. Source: rope.hpp.
#pragma once

#include "catena/elements/rope_span.hpp"

namespace catena {

template <class S = double>
struct RopePart : RopeSpan<S> {
  static constexpr std::string_view type = "rope_part";
  static constexpr std::string_view equation = "a stretch of a rope";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 0;
  static constexpr bool joins = true;

  bool bridge = false;
  int head = -1;  // number of the rope among the model's elements

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &RopePart::s_i, 0, "the centre of its first circle"},
                           PointField{"j", &RopePart::s_j, 1, "the centre of its second circle"});
  }
  /// Its rope draws it.
  template <class Pen>
  void draw(Pen&) const {}

  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j) const {
    return bridge ? T(0.0) : -this->extent(i, j);
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    out[0] = measure(a.i, a.j);
  }
  void jacobian(const Arguments<double>& a, double* entries) const {
    if (bridge) {
      for (std::size_t n = 0; n < jacobian_size<RopePart>; ++n) entries[n] = 0;
      return;
    }
    this->gradient(PairGeometry(a, this->s_i, this->s_j), entries);
    for (std::size_t n = 0; n < jacobian_size<RopePart>; ++n) entries[n] = -entries[n];
  }
  void gamma(const Arguments<double>& a, const Rates& u, const Rates& v, double* out) const {
    out[0] = bridge ? 0 : this->bend(PairMotion(a, this->s_i, this->s_j, u, v));
  }
};

}  // namespace catena
