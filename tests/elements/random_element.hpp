// Elements of any type with random parameters, made from the descriptions of their fields.
//
// Parameters depend on four independent variables, along random directions: over Dual<double, 4> they carry these
// derivatives, over double they can be moved a step along one of them. Equal seeds make equal elements.
#pragma once

#include <numbers>
#include <random>
#include <vector>

#include "catena/elements/all.hpp"

namespace catena {

class Random {
 public:
  explicit Random(unsigned seed) : engine_(seed) {}
  /// Uniform in [low, high), the same numbers with every standard library.
  double between(double low, double high) { return low + (high - low) * (engine_() / 4294967296.0); }
  bool coin() { return between(0, 1) < 0.5; }
  Vec2<double> place(double size) {
    const double x = between(-size, size);
    return {x, between(-size, size)};
  }

 private:
  std::mt19937 engine_;
};

template <class S>
class ParameterSource {
 public:
  /// `step` along direction number `direction` (over double only); lengths are of the order of `size`.
  explicit ParameterSource(unsigned seed, double size = 1, int direction = 0, double step = 0)
      : random_(seed), size_(size), direction_(direction), step_(step) {}

  S number(double low, double high, double unit = 1) {
    const double value = random_.between(low, high);
    std::array<double, 4> slope;
    for (double& s : slope) s = unit * random_.between(-1, 1);
    if constexpr (std::is_same_v<S, double>) {
      return unit * value + step_ * slope[static_cast<std::size_t>(direction_)];
    } else {
      return S(unit * value, slope);
    }
  }
  S length(double low, double high) { return number(low, high, size_); }
  Vec2<S> place() {
    const S x = length(-1, 1);
    return {x, length(-1, 1)};
  }
  bool coin() { return random_.coin(); }
  int choice(int count) { return static_cast<int>(random_.between(0, count)); }

 private:
  Random random_;
  double size_;
  int direction_;
  double step_;
};

template <class E, class S, class M>
void fill(E& element, const PointField<M>& field, ParameterSource<S>& source) {
  element.*field.member = source.place();
}
template <class E, class S, class M>
void fill(E& element, const PlaceField<M>& field, ParameterSource<S>& source) {
  element.*field.member = source.place();
}
template <class E, class S, class M>
void fill(E& element, const AxisField<M>& field, ParameterSource<S>& source) {
  // Not too short, so that differences in its direction stay smooth; now and then one is left to complete().
  using std::cos, std::sin;
  const S angle = source.number(-3, 3), length = source.length(0.5, 1);
  const Vec2<S> axis{length * cos(angle), length * sin(angle)};
  if (field.required || source.coin()) element.*field.member = axis;
}
template <class E, class S, class M>
void fill(E& element, const NumberField<M>& field, ParameterSource<S>& source) {
  element.*field.member = field.unit == UnitKind::length ? source.length(0.3, 1) : source.number(0.3, 1);
}
template <class E, class S, class M>
void fill(E& element, const FlagField<M>& field, ParameterSource<S>& source) {
  element.*field.member = source.coin();
}
template <class E, class S, class M>
void fill(E& element, const SideField<M>& field, ParameterSource<S>& source) {
  element.*field.member = source.coin() ? 1 : -1;
}

/// Points r(angle) [cos, sin] at equal angles over `turns`, r varying by a tenth: a convex shape, or a part of one.
template <class S>
std::vector<Vec2<S>> rounded(ParameterSource<S>& source, std::size_t count, double turns) {
  using std::cos, std::sin;
  const S radius = source.length(0.4, 0.6), phase = source.number(-3, 3), height = source.number(0.05, 0.1);
  std::vector<Vec2<S>> points;
  for (std::size_t k = 0; k < count; ++k) {
    const double angle = 2 * std::numbers::pi * turns * static_cast<double>(k) / static_cast<double>(count);
    const S r = radius * (S(1.0) + height * cos(S(2 * angle) + phase));
    points.push_back({r * S(std::cos(angle)), r * S(std::sin(angle))});
  }
  return points;
}
template <class E, class S, class M>
void fill(E& element, const CurveField<M>& field, ParameterSource<S>& source) {
  using C = Curve<S>;
  const auto shape = [&]() -> C {
    switch (source.choice(5)) {
      case 0:
        return C::circle(source.place(), source.length(0.3, 0.6));
      case 1:
        return C::line(source.place(), source.place());
      case 2:
        return C::spline(rounded(source, 12, 1), SplineEnd::periodic);
      case 3:
        return C::spline(rounded(source, 9, 0.6), SplineEnd::natural);
      default:
        std::vector<S> angles, radii;
        for (const Vec2<S>& p : rounded(source, 12, 1)) {
          angles.push_back(S(2 * std::numbers::pi * static_cast<double>(angles.size()) / 12));
          radii.push_back(norm(p));
        }
        return C::polar(angles, radii);
    }
  };
  element.*field.member = shape();
}
template <class E, class S, class M>
void fill(E& element, const ChoiceField<M>& field, ParameterSource<S>& source) {
  element.*field.member = source.coin();
}
template <class E, class S, class M>
void fill(E& element, const TableField<M>& field, ParameterSource<S>& source) {
  // Rising pairs around zero; now and then none.
  if (source.coin()) return;
  std::vector<Vec2<S>> pairs;
  for (int k = -2; k <= 2; ++k) {
    const S x = S(0.7 * k) + source.number(-0.2, 0.2);
    pairs.push_back({x, S(1.5 * k) + source.number(-1, 1)});
  }
  element.*field.member = pairs;
}
template <class E, class S>
void fill(E&, const FunctionField&, ParameterSource<S>&) {}
template <class E, class S>
void fill(E&, const FunctionPairField&, ParameterSource<S>&) {}

/// Where curves of the element touch at these frames, searched for from the given configuration; of others no_contact.
template <class E>
CurvePlace found_contact(const E& element, const Frame<double>& i, const Frame<double>& j) {
  CurvePlace contact;
  if constexpr (SearchesCurve<E>) {
    contact = element.place();
    element.follow_contact(i, j, contact);
  }
  return contact;
}

/// An element that its own check() accepts, completed at the given frames.
template <class E, class S>
E random_element(ParameterSource<S>& source, const Frame<S>& i, const Frame<S>& j) {
  for (;;) {
    E element;
    std::apply([&](const auto&... field) { (fill(element, field, source), ...); }, E::fields());
    if constexpr (requires { element.complete(i, j); }) element.complete(i, j);
    if constexpr (requires { element.check(); }) {
      if (element.check()) continue;
    }
    return element;
  }
}

}  // namespace catena
