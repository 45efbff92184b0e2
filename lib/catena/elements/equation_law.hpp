// A user-defined scalar equation between two bodies, behind one virtual call; see constraints/custom_constraint.hpp.
//
// A law is a struct with
//
//   template <class T> T measure(const Frame<T>& i, const Frame<T>& j) const       the quantity that is to equal c, m
//
// T is one of the scalars below: from these the library derives the equation's value, Phi_q, nu, gamma and second
// derivatives, exact to rounding. A law that searches for a place on a curve has what elements have that do
// (element.hpp):
//
//   CurvePlace place() const                                  where the search begins in the given configuration
//   void follow_contact(const Frame<double>& i, const Frame<double>& j, CurvePlace& place) const
//   template <class T> T measure(const Frame<T>& i, const Frame<T>& j, const CurvePlace& place) const
#pragma once

#include <memory>
#include <utility>

#include "catena/base/design_scalar.hpp"
#include "catena/base/frame.hpp"
#include "catena/base/taylor.hpp"
#include "catena/elements/element.hpp"

/// The scalars a law is evaluated in: numbers, time series, first and second derivatives by six coordinates; and, with
/// derivatives by design parameters, numbers, time series and first derivatives.
#define CATENA_LAW_SCALARS(X) \
  X(double)                   \
  X(Taylor<double>)           \
  X(Gradient)                 \
  X(Second)                   \
  X(DesignScalar)             \
  X(Taylor<DesignScalar>)     \
  X(DesignGradient)

namespace catena {

class EquationLaw {
 public:
  using Gradient = Dual<double, 6>;
  using Second = Dual<Gradient, 6>;
  using DesignGradient = Dual<DesignScalar, 6>;

  virtual ~EquationLaw() = default;
  virtual CurvePlace place() const = 0;
  virtual void follow_contact(const Frame<double>& i, const Frame<double>& j, CurvePlace& place) const = 0;
#define CATENA_DECLARE(T) virtual T measure(const Frame<T>& i, const Frame<T>& j, const CurvePlace& place) const = 0;
  CATENA_LAW_SCALARS(CATENA_DECLARE)
#undef CATENA_DECLARE
};

/// A law of the user's type.
template <class Law>
class EquationLawOf final : public EquationLaw {
 public:
  explicit EquationLawOf(Law law) : law_(std::move(law)) {}

  CurvePlace place() const override {
    if constexpr (SearchesCurve<Law>) {
      return law_.place();
    } else {
      return {.s_i = 0};
    }
  }
  void follow_contact([[maybe_unused]] const Frame<double>& i, [[maybe_unused]] const Frame<double>& j,
                      [[maybe_unused]] CurvePlace& place) const override {
    if constexpr (SearchesCurve<Law>) law_.follow_contact(i, j, place);
  }
#define CATENA_OVERRIDE(T)                                                                  \
  T measure(const Frame<T>& i, const Frame<T>& j, const CurvePlace& place) const override { \
    return measure_of(law_, i, j, place);                                                   \
  }
  CATENA_LAW_SCALARS(CATENA_OVERRIDE)
#undef CATENA_OVERRIDE

 private:
  Law law_;
};

}  // namespace catena

#undef CATENA_LAW_SCALARS
