// Ropes in a model: from the way of a rope to its elements.
//
//   way: end on body i, pulleys, end on body j      =>      straight stretches between neighbours (rope_span.hpp)
//
// A pulley that rolls is the end of one rope and the beginning of another, both of which wind on it: its stretches have
// tensions of their own. Of an elastic rope of length L and stiffness k each is a spring of the length that it has in
// the given configuration, also while some winds on or off:
//
//   L_n = L way_n / way      k_n = k L / L_n      way: of all stretches, arcs on pulleys between included
//
//  What lies between two places of one body, or of bodies that stand still, is no element: it
// adds to the length, or to what the body's turning winds. A pulley beside which the rope lies is passed over; which
// these are may change in motion (rope_routes.hpp). Units: m. Errors: ModelError, as a phrase about the rope.
#pragma once

#include <string_view>
#include <vector>

#include "catena/elements/rope_span.hpp"
#include "catena/model/model.hpp"

namespace catena {

/// A circle, or with radius zero a point, that a rope runs over.
template <class S>
struct RopePulley {
  int body = ground;
  Vec2<S> centre{};  ///< in the centroidal frame of the body
  S radius{};
  int side = 0;  ///< 1: on the left of the rope as it runs from i to j; 0: the side to which its way bends
  bool rolls = false;
  double mu = 0;  ///< of the friction while the rope slides over it
};

template <class S>
struct RopeWay {
  RopePulley<S> i, j;  ///< the ends, with radius zero
  std::vector<RopePulley<S>> over;
};

template <class S>
struct RopeValues {
  S length{-1.0}, k{};                // negative: that of the given way; zero: inextensible
  S restitution{}, rest_speed{-1.0};  // as of a cable
};

/// The straight stretches of a rope of one tension, in order, and the length of its way in the given configuration.
template <class S>
struct RopeStretch {
  struct Straight {
    int i = ground, j = ground;
    RopeSpan<S> span;
  };
  std::vector<Straight> straight;
  std::vector<Straight> skeleton{};  ///< bodies of its straight lines on all of its pulleys, also those it lies beside
  S way{};
  S part{1.0};                         ///< of the length of all, with what lies on pulleys between
  std::vector<RopePulley<S>> nodes{};  ///< its ends and what is between, for figures
  bool leads_on = false;               ///< the last of them belongs to the next stretch (rope_path.hpp)
};

template <class S>
std::vector<RopeStretch<S>> rope_stretches(const BasicModel<S>& model, const RopeWay<S>& way);

/// Adds the elements of a rope; the number of the first is returned. Of several ropes from pulley to pulley the second
/// is called name:2, and so on.
template <class S>
int add_rope(BasicModel<S>& model, std::string_view name, const std::vector<RopeStretch<S>>& stretches,
             const RopeValues<S>& values);

extern template std::vector<RopeStretch<double>> rope_stretches(const BasicModel<double>&, const RopeWay<double>&);
extern template std::vector<RopeStretch<Dual<double, 4>>> rope_stretches(const BasicModel<Dual<double, 4>>&,
                                                                         const RopeWay<Dual<double, 4>>&);
extern template int add_rope(BasicModel<double>&, std::string_view, const std::vector<RopeStretch<double>>&,
                             const RopeValues<double>&);
extern template int add_rope(BasicModel<Dual<double, 4>>&, std::string_view,
                             const std::vector<RopeStretch<Dual<double, 4>>>&, const RopeValues<Dual<double, 4>>&);

}  // namespace catena
