// custom_constraint: a user-defined equation between body i and body j, in C++ only.
//
//   Phi = m(q_i, q_j) - c = 0         m: the law's measure, in m; c a function of time, hence it may be a driver
//
//   struct OnParabola {                                     // keeps the centroid of j on y' = a x'^2 of body i
//     double a;
//     template <class T> T measure(const Frame<T>& i, const Frame<T>& j) const {
//       const T x = j.x - i.x, y = j.y - i.y, along = i.c * x + i.s * y, across = i.c * y - i.s * x;
//       return across - T(a) * along * along;
//     }
//   };
//   model.add("rail", custom_constraint(OnParabola{0.5}), i, j, 0.0);
//
// A joint of several equations is several of these. Frames are those of the centroids relative to a common origin.
// Singular where the law's derivative vanishes. Costs one virtual call per element and evaluation.
#pragma once

#include "catena/elements/element.hpp"
#include "catena/elements/equation_law.hpp"

namespace catena {

template <class S = double>
struct CustomConstraint {
  static constexpr std::string_view type = "custom_constraint";
  static constexpr std::string_view summary = "A user-defined equation, in C++.";
  static constexpr std::string_view equation = "m(q_i, q_j) - c = 0";
  static constexpr int rows = 1;
  static constexpr int bodies = 2;
  static constexpr int functions = 1;
  static constexpr UnitKind value_unit = UnitKind::length;

  std::shared_ptr<const EquationLaw> law;
  Vec2<S> s_i, s_j;  // where reactions are reported

  static constexpr auto fields() {
    return std::make_tuple(
        PointField{"i", &CustomConstraint::s_i, 0, "the point P_i of body i for reactions"},
        PointField{"j", &CustomConstraint::s_j, 1, "the point P_j of body j for reactions"},
        FunctionField{"value", 0, UnitKind::length, Omitted::given, "c, the value of the law's measure"});
  }

  const char* check() const { return law ? nullptr : "needs a law"; }

  CurvePlace place() const { return law->place(); }
  void follow_contact(const Frame<double>& i, const Frame<double>& j, CurvePlace& place) const {
    law->follow_contact(i, j, place);
  }

  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j, const CurvePlace& place) const {
    return law->measure(i, j, place);
  }
  template <class T>
  void phi(const Arguments<T>& a, T* out) const {
    out[0] = measure(a.i, a.j, *a.contact) - a.c;
  }
};

/// The element for a law; see equation_law.hpp for the members of a law.
template <class Law>
CustomConstraint<double> custom_constraint(Law law) {
  return {std::make_shared<const EquationLawOf<Law>>(std::move(law)), {}, {}};
}

}  // namespace catena
