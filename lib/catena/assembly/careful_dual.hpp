// Dual numbers through formulas at places where parts of these have no derivative, though the whole may have one.
//
//   (a b)' = a' b       where a = 0 has a derivative and b is continuous, whether b has one or not
//   f(c)'  = 0          by a variable of which c does not depend, however steep f is there
//
// As v sqrt(v^2) at rest, whose derivative by v is zero, and by a coordinate as well, although that of the root is
// infinity times zero. What depends on which variable is followed beside the numbers: a derivative that happens to be
// zero, as that of v^2 by v at rest, is no independence, and sqrt(v^2) = |v| has none there: not a number. Source:
// difference quotients of a b, with a(0) = 0: (a(h)/h) b(h).
#pragma once

#include <array>
#include <cmath>

#include "catena/base/operation.hpp"

namespace catena {

template <class T>
struct CarefulDual;

template <int N>
struct CarefulDual<Dual<double, N>> {
  Dual<double, N> x{};
  std::array<bool, N> depends{};

  CarefulDual() = default;
  CarefulDual(double constant) : x(constant) {}
  /// Depends on what it has derivatives by.
  CarefulDual(const Dual<double, N>& number) : x(number) {
    for (std::size_t i = 0; i < N; ++i) depends[i] = number.d[i] != 0;
  }

  friend CarefulDual apply(Operation operation, const CarefulDual& a) {
    CarefulDual r = a;
    r.x = apply(operation, a.x);
    return r.mended();
  }
  friend CarefulDual apply(Operation operation, const CarefulDual& a, const CarefulDual& b) {
    CarefulDual r;
    r.x = apply(operation, a.x, b.x);
    for (std::size_t i = 0; i < N; ++i) {
      r.depends[i] = a.depends[i] || b.depends[i];
      if (operation != Operation::multiply || std::isfinite(r.x.d[i])) continue;
      if (a.x.v == 0 && std::isfinite(a.x.d[i])) r.x.d[i] = a.x.d[i] * b.x.v;
      if (b.x.v == 0 && std::isfinite(b.x.d[i])) r.x.d[i] = b.x.d[i] * a.x.v;
    }
    return r.mended();
  }
  /// Without derivatives by what it does not depend on.
  CarefulDual mended() const {
    CarefulDual r = *this;
    for (std::size_t i = 0; i < N; ++i) {
      if (!depends[i]) r.x.d[i] = 0;
    }
    return r;
  }
};

}  // namespace catena
