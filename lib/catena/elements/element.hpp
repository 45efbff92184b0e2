// The contract of a constraint element, on one page.
//
// An element is a struct template over the scalar S of its own parameters, with
//
//   type           its name in scene files
//   rows, bodies   number of equations; 1 body (body-ground, absolute) or 2 (i, j; either may be the ground)
//   functions      0, or 1 if the equation contains a value c that may be a function of time: then it can be a driver
//   equation       the equation as text, for `explain`
//   fields()       what a scene file sets: see field.hpp
//   phi<T>(a, out) Phi as published (apps/manual/constraints.md); templated on the scalar T
//
// and from phi alone the library derives Phi_q (dual numbers), nu and gamma (Taylor series in time), second derivatives
// and parameter derivatives. Optional members, found by their presence:
//
//   pattern                structure of Phi_q: which entries are zero, +1, -1 or vary     (default: all vary)
//   jacobian(a, entries)   the varying entries, row by row                              (closed form of a hot type)
//   gamma(a, u, v, out)    the acceleration right-hand side, body rates u, v              (closed form of a hot type)
//   hessian_pattern        which second derivatives may differ from zero                  (default: all)
//   hessian(a, lambda, entries)   sum_r lambda_r d2Phi_r/dq2 at those places              (closed form of a hot type)
//   measure<T>(i, j)       the quantity that c prescribes (functions == 1)
//   value_unit             kind of c; `squared` = true if the row is measure^2 - c^2: it is then scaled by 1/(2c)
//   row_unit(row)          UnitKind::length (default) or UnitKind::angle: what the residual of the row is measured in
//   reaction_point(i, j)   the place in the ground where reactions on both bodies act  (default: each body's own P)
//   complete(i, j)         takes from the given configuration what the scene left out
//   check()                nullptr, or what is wrong with the parameters, as a phrase
//   trouble(a)             nullptr, or why the row means nothing at this configuration, as a phrase
//   can_leave_curve()      whether the element uses a curve or table that ends for good
//   place()                where curves touch in the given configuration (CurvePlace)
//   follow_contact(i, j, p)   moves the place p on to where they touch at these frames; all else finds it in a.contact
//   curve_use(a)           where on it the element stands, if it asks anything of it (CurveUse)
//   joins = true           it has no row of its own but adds to that of element `head`, of a type before it in the
//   list;
//                          head names the type as Part, and its elements by first_part and parts  (rope_part.hpp)
//   draw(pen)              how it looks in figures, by calls of drawing/pen.hpp  (default: a line between its points)
//
// Frames carry cosine and sine: no element calls trigonometry. One file an element, plus its lines in list.hpp.
#pragma once

#include <algorithm>
#include <array>
#include <concepts>
#include <cstddef>
#include <limits>
#include <optional>
#include <string_view>
#include <tuple>

#include "catena/base/frame.hpp"
#include "catena/base/unit_kind.hpp"
#include "catena/elements/field.hpp"

namespace catena {

/// Where curves of the bodies of an element touch: their parameters, m. The search for a contact begins where it was
/// found last, so that the place belongs to the state of a mechanism.
struct CurvePlace {
  int element = -1;  ///< its number in the model
  double s_i = std::numeric_limits<double>::quiet_NaN(), s_j = 0;
  bool is_regular = false;  ///< whether the search ended at a contact that has derivatives
};
inline constexpr CurvePlace no_contact{};

/// Arguments of an element: the frames of its bodies (the ground frame where there is no body) and the value c.
/// Frames may be given relative to any common origin; `ground` is where that origin lies, so that absolute elements
/// subtract it together with their constant: rounding then does not grow with the distance from the ground's origin.
template <class T>
struct Arguments {
  const Frame<T>& i;
  const Frame<T>& j;
  T c;                                      ///< value of the element's function of time
  Vec2<double> ground;                      ///< place of the frames' origin in the ground frame
  const CurvePlace* contact = &no_contact;  ///< at these frames, of elements that search for one
};

/// Velocities of a body: vx, vy in m/s, omega in rad/s.
struct Rates {
  double vx = 0, vy = 0, omega = 0;
};

/// The place in use on a curve or table that has ends: the parameter, m, within [first, last] unless the end is passed;
/// and the nearer end of a curve, in the frame of body i (`body` 0) or j (1).
struct CurveUse {
  double parameter = 0, first = 0, last = 0;
  std::optional<Vec2<double>> end = {};
  int body = 0;

  /// Distance beyond an end, relative to the length of the whole; negative inside.
  double excess() const { return std::max(first - parameter, parameter - last) / (last - first); }
};

/// Structure of an entry of Phi_q, known before its value.
enum class Entry : signed char { zero, plus_one, minus_one, varying };

template <class E>
inline constexpr std::size_t jacobian_size = static_cast<std::size_t>(E::rows* E::bodies * 3);

template <class E>
consteval std::array<Entry, jacobian_size<E>> jacobian_pattern() {
  if constexpr (requires { E::pattern; }) {
    return E::pattern;
  } else {
    std::array<Entry, jacobian_size<E>> all{};
    all.fill(Entry::varying);
    return all;
  }
}

template <class E>
consteval int varying_entries() {
  int n = 0;
  for (Entry e : jacobian_pattern<E>()) n += e == Entry::varying;
  return n;
}

/// Place of a second derivative among an element's coordinates [x_i y_i phi_i x_j y_j phi_j], column <= row.
struct HessianEntry {
  signed char row, column;
};

/// Every place of the lower triangle of a size x size matrix.
template <std::size_t size>
consteval auto full_lower_triangle() {
  std::array<HessianEntry, size*(size + 1) / 2> all{};
  std::size_t k = 0;
  for (std::size_t r = 0; r < size; ++r) {
    for (std::size_t c = 0; c <= r; ++c) all[k++] = {static_cast<signed char>(r), static_cast<signed char>(c)};
  }
  return all;
}

template <class E>
consteval auto hessian_pattern() {
  if constexpr (requires { E::hessian_pattern; }) {
    return E::hessian_pattern;
  } else {
    return full_lower_triangle<static_cast<std::size_t>(3 * E::bodies)>();
  }
}

/// Whether a pattern holds nothing but second derivatives with respect to one body's own angle. Where coordinates enter
/// through A s' alone, as in pins, these form the stiffness lambda^T A s' against turning, and all other second
/// derivatives vanish.
template <std::size_t n>
constexpr bool only_turning(const std::array<HessianEntry, n>& pattern) {
  for (const HessianEntry& e : pattern) {
    if (e.row != e.column || e.row % 3 != 2) return false;
  }
  return true;
}

template <class E>
concept HasClosedHessian = requires(const E& e, const Arguments<double>& a, const double* lambda, double* out) {
  e.hessian(a, lambda, out);
};

template <class E>
concept HasClosedJacobian = requires(const E& e, const Arguments<double>& a, double* out) {
  e.jacobian(a, out);
};

template <class E>
concept HasClosedGamma = requires(const E& e, const Arguments<double>& a, const Rates& u, double* out) {
  e.gamma(a, u, u, out);
};

template <class E>
concept HasTrouble = requires(const E& e, const Arguments<double>& a) {
  e.trouble(a);
};

template <class E>
concept HasCurveUse = requires(const E& e) {
  e.can_leave_curve();
};

/// Has a point of contact that is searched for, from the place where it was found last.
template <class E>
concept SearchesCurve = requires(const E& e, const Frame<double>& f, CurvePlace& place) {
  { e.place() } -> std::same_as<CurvePlace>;
  e.follow_contact(f, f, place);
};

/// Has the curve that it searches along among its fields, which tell all of it.
template <class E>
concept HasCurve = SearchesCurve<E> && !requires(const E& e) {
  e.law;
};

/// Says what its row is compared with: measure(i, j), of those that search with the place of the contact.
template <class E>
concept Measuring = requires(const E& e, const Frame<double>& f) {
  e.measure(f, f);
}
|| requires(const E& e, const Frame<double>& f, const CurvePlace& contact) { e.measure(f, f, contact); };

template <class E, class T>
T measure_of(const E& element, const Frame<T>& i, const Frame<T>& j, const CurvePlace& contact) {
  if constexpr (SearchesCurve<E>) {
    return element.measure(i, j, contact);
  } else {
    return element.measure(i, j);
  }
}

template <class E>
concept HasSquaredValue = requires {
  requires E::squared;
};

/// Adds to the row of another element.
template <class E>
concept Joining = requires {
  requires E::joins;
};

/// Whose row others add to.
template <class E>
concept HasParts = requires(const E& e) {
  e.first_part;
};

/// The default of the value c of a scalar constraint.
template <class E>
consteval Omitted when_omitted() {
  return std::apply(
      [](const auto&... field) {
        Omitted result = Omitted::refused;
        const auto look = [&](const auto& f) {
          if constexpr (requires { f.omitted; }) result = f.omitted;
        };
        (look(field), ...);
        return result;
      },
      E::fields());
}

template <class E>
constexpr UnitKind row_unit([[maybe_unused]] int row) {
  if constexpr (requires { E::row_unit(0); }) {
    return E::row_unit(row);
  } else {
    return UnitKind::length;
  }
}

}  // namespace catena
