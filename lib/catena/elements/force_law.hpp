// A user-defined force, behind one virtual call; see forces/custom_force.hpp for its use.
//
// A law is a struct with
//
//   template <class T> void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const   adds Q, N, N m
//   template <class T> T potential(const ForceArguments<T>& a) const            V, J, if there is one: Q = -V_q at rest
//
// T is one of the scalars below: from these the library derives stiffness, damping and power, exact to rounding.
#pragma once

#include <memory>
#include <utility>

#include "catena/base/design_scalar.hpp"
#include "catena/base/taylor.hpp"
#include "catena/elements/force_element.hpp"

/// The scalars a law is evaluated in: numbers, rates along a motion, derivatives with respect to six coordinates; and,
/// with derivatives by design parameters, numbers and series along a line.
#define CATENA_LAW_SCALARS(X) \
  X(double)                   \
  X(Rate)                     \
  X(Gradient)                 \
  X(DesignScalar)             \
  X(Taylor<DesignScalar>)

namespace catena {

class ForceLaw {
 public:
  using Rate = Dual<double, 1>;
  using Gradient = Dual<double, 6>;

  virtual ~ForceLaw() = default;
  virtual bool conservative() const = 0;
#define CATENA_DECLARE(T)                                                               \
  virtual void force(const ForceArguments<T>& a, Wrench<T>& i, Wrench<T>& j) const = 0; \
  virtual T potential(const ForceArguments<T>& a) const = 0;
  CATENA_LAW_SCALARS(CATENA_DECLARE)
#undef CATENA_DECLARE
};

/// A law of the user's type.
template <class Law>
class ForceLawOf final : public ForceLaw {
 public:
  explicit ForceLawOf(Law law) : law_(std::move(law)) {}

  static constexpr bool has_potential = requires(const Law& law, const ForceArguments<double>& a) { law.potential(a); };
  bool conservative() const override { return has_potential; }
#define CATENA_OVERRIDE(T)                                                                  \
  void force(const ForceArguments<T>& a, Wrench<T>& on_i, Wrench<T>& on_j) const override { \
    law_.force(a, on_i, on_j);                                                              \
  }                                                                                         \
  T potential(const ForceArguments<T>& a) const override {                                  \
    if constexpr (has_potential) {                                                          \
      return law_.potential(a);                                                             \
    } else {                                                                                \
      static_cast<void>(a);                                                                 \
      return T(0.0);                                                                        \
    }                                                                                       \
  }
  CATENA_LAW_SCALARS(CATENA_OVERRIDE)
#undef CATENA_OVERRIDE

 private:
  Law law_;
};

}  // namespace catena

#undef CATENA_LAW_SCALARS
