// custom_force: a user-defined force between body i and body j, in C++ only.
//
//   struct Magnet {                                        // pulls two bodies together with strength / distance^2
//     double strength;
//     template <class T> void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const {
//       const Vec2<T> h{a.j.x - a.i.x, a.j.y - a.i.y};
//       const Vec2<T> pull = (T(strength) / (squared_norm(h) * norm(h))) * h;
//       add_force_at(Vec2<T>{}, pull, on_i);
//       add_force_at(Vec2<T>{}, -pull, on_j);
//     }
//   };
//   model.add_force("magnet", custom_force(Magnet{0.5}), i, j);
//
// Frames are those of the centroids relative to a common origin: where j is the ground, positions in the ground are
// differences to a.j. a.f[0] is a function of time handed to add_force (default 0). Units: N, N m, J. Singular where
// the law is. Costs one virtual call per element and evaluation.
#pragma once

#include "catena/elements/force_law.hpp"

namespace catena {

template <class S = double>
struct CustomForce {
  static constexpr std::string_view type = "custom_force";
  static constexpr std::string_view summary = "A user-defined force, in C++.";
  static constexpr std::string_view equation = "Q given by the law";
  static constexpr int bodies = 2;
  static constexpr int functions = 1;

  std::shared_ptr<const ForceLaw> law;
  Vec2<S> s_i, s_j;  // where it acts, for reports

  static constexpr auto fields() {
    return std::make_tuple(PointField{"i", &CustomForce::s_i, 0, "body i"},
                           PointField{"j", &CustomForce::s_j, 1, "body j"},
                           FunctionField{"value", 0, UnitKind::none, Omitted::zero, "a function of time for the law"});
  }

  const char* check() const { return law ? nullptr : "needs a law"; }
  bool conservative() const { return law->conservative(); }

  template <class T>
  void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const {
    law->force(a, on_i, on_j);
  }
  template <class T>
  T potential(const ForceArguments<T>& a) const {
    return law->potential(a);
  }
};

/// The element for a law; see force_law.hpp for the members of a law.
template <class Law>
CustomForce<double> custom_force(Law law) {
  return {std::make_shared<const ForceLawOf<Law>>(std::move(law)), {}, {}};
}

}  // namespace catena
