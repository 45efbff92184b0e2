// A user-defined scalar equation between two bodies, behind one virtual call; see constraints/custom_constraint.hpp.
//
// A law is a struct with
//
//   template <class T> T measure(const Frame<T>& i, const Frame<T>& j) const       the quantity that is to equal c, m
//
// T is one of the scalars below: from these the library derives the equation's value, Phi_q, nu, gamma and second
// derivatives, exact to rounding.
#pragma once

#include <memory>
#include <utility>

#include "catena/base/design_scalar.hpp"
#include "catena/base/frame.hpp"
#include "catena/base/taylor.hpp"

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
#define CATENA_DECLARE(T) virtual T measure(const Frame<T>& i, const Frame<T>& j) const = 0;
  CATENA_LAW_SCALARS(CATENA_DECLARE)
#undef CATENA_DECLARE
};

/// A law of the user's type.
template <class Law>
class EquationLawOf final : public EquationLaw {
 public:
  explicit EquationLawOf(Law law) : law_(std::move(law)) {}

#define CATENA_OVERRIDE(T) \
  T measure(const Frame<T>& i, const Frame<T>& j) const override { return law_.measure(i, j); }
  CATENA_LAW_SCALARS(CATENA_OVERRIDE)
#undef CATENA_OVERRIDE

 private:
  Law law_;
};

}  // namespace catena

#undef CATENA_LAW_SCALARS
