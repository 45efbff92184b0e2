// A force against an elongation, through given pairs: the law of a spring that is not linear.
//
//   f(e): natural cubic spline through (e_k, f_k)        V(e) = integral of f from 0 to e
//
// Beyond its ends the force keeps its value (hold) or continues along a straight line; a table that ends (error) also
// continues straight, so that iterations come back, and use_at() reports the place.
// Two pairs make a straight line. Smooth to second order, hence integrators keep their order. e in m, f in N (tension
// positive), V in J. Copies share the table, which never changes.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include "catena/base/spline.hpp"
#include "catena/base/vec2.hpp"
#include "catena/elements/element.hpp"

namespace catena {

template <class S>
class ForceCurve {
 public:
  ForceCurve() = default;  ///< no curve: no force
  /// Throws std::invalid_argument, naming the pair that is wrong: fewer than two, elongations that do not increase.
  ForceCurve(std::span<const Vec2<S>> pairs, Beyond beyond = Beyond::error) {
    std::vector<S> elongations, forces;
    for (const Vec2<S>& pair : pairs) {
      elongations.push_back(pair.x);
      forces.push_back(pair.y);
    }
    spline_ = std::make_shared<const Spline<S>>(elongations, forces, SplineEnd::natural, beyond);
    start_ = spline_->integral(S(0.0));
  }
  ForceCurve(const std::vector<Vec2<S>>& pairs, Beyond beyond = Beyond::error)
      : ForceCurve(std::span<const Vec2<S>>(pairs), beyond) {}

  explicit operator bool() const { return spline_ != nullptr; }
  /// Whether the table has ends beyond which it is not defined, and where in it an elongation lies.
  bool ends() const { return spline_ && spline_->beyond() == Beyond::error; }
  CurveUse use_at(double elongation) const { return {elongation, spline_->first(), spline_->last()}; }

  template <class T>
  T force(const T& elongation) const {
    return spline_ ? spline_->evaluate(elongation).f : T(0.0);
  }
  template <class T>
  T energy(const T& elongation) const {
    return spline_ ? spline_->integral(elongation) - T(start_) : T(0.0);
  }

 private:
  std::shared_ptr<const Spline<S>> spline_;
  S start_{};
};

}  // namespace catena
