// Interpolating cubic splines: pieces of cubics through a table, with continuous second derivative.
//
//   h[k-1] M[k-1] + 2 (h[k-1] + h[k]) M[k] + h[k] M[k+1] = 6 ((y[k+1] - y[k]) / h[k] - (y[k] - y[k-1]) / h[k-1])
//
// with M the second derivatives at the knots and h the distances between them. Ends: natural M = 0; clamped: slope 0;
// periodic: value, slope and M agree. Beyond the knots a periodic spline repeats. The others hold the value at their
// end, or go on as straight lines, which for natural ends is smooth to second order; splines that end there
// (Beyond::error) also continue as lines, so that iterations that stray outside come back; `covers` tells whether x is
// inside. The scalar S (double or Dual) runs through knots and values, hence derivatives with respect to the table are
// exact. Source: de Boor, A Practical Guide to Splines, ch. IV.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <vector>

#include "catena/base/dual.hpp"
#include "catena/base/taylor.hpp"

namespace catena {

enum class SplineEnd { natural, clamped, periodic };

/// How a table or curve that does not repeat continues beyond its ends: not at all (leaving it is an error); with the
/// value at the end; along the straight line with the slope at the end.
enum class Beyond { error, hold, line };

/// Value and first three derivatives.
template <class T>
struct SplineValue {
  T f{}, d1{}, d2{}, d3{};
};

template <class S>
class Spline {
 public:
  /// Through (knots[k], values[k]). Throws std::invalid_argument, saying which entry is wrong: fewer than 2 points,
  /// lengths that differ, knots that do not increase, a number that is not finite, periodic ends that differ by more
  /// than 1e-12 of the largest value.
  Spline(std::span<const S> knots, std::span<const S> values, SplineEnd end, Beyond beyond = Beyond::error);

  /// At x of any scalar that S converts to; logarithmic in the number of knots. At a knot: of the piece that follows,
  /// at the last one of the piece before it.
  template <class T>
  SplineValue<T> evaluate(const T& x) const;

  /// At x, wherever it is, by the polynomial that holds just after `place`, or just before it.
  template <class T>
  SplineValue<T> continue_from(double place, bool after, const T& x) const;

  /// The area under the spline from the first knot to x, which may lie before it or beyond the last.
  template <class T>
  T integral(const T& x) const;

  double first() const { return positions_.front(); }
  double last() const { return positions_.back(); }
  bool periodic() const { return periodic_; }
  Beyond beyond() const { return beyond_; }
  /// Whether there is a value at x: within the table, or everywhere if the spline repeats, holds or continues.
  bool covers(double x) const { return periodic_ || beyond_ != Beyond::error || (x >= first() && x <= last()); }
  /// The places where the third derivative jumps, increasing.
  std::span<const double> knots() const { return positions_; }

 private:
  /// c0 + c1 u + c2 u^2 + c3 u^3, u = x - start, with the area under the spline up to `start`.
  struct Piece {
    S start{}, c0{}, c1{}, c2{}, c3{}, area{};
  };
  /// The piece at x, and x moved by whole periods into the table.
  template <class T>
  struct Place {
    const Piece* piece;
    T u;
    double cycles;
  };
  template <class T>
  Place<T> locate(const T& x) const;

  template <class T>
  static SplineValue<T> value_at(const Place<T>& place);

  bool periodic_ = false;
  Beyond beyond_ = Beyond::error;
  S period_{};
  std::vector<double> positions_;  // plain numbers to search in
  std::vector<Piece> pieces_;      // the line before the first knot, the cubics, the line beyond the last knot
};

template <class S>
template <class T>
typename Spline<S>::template Place<T> Spline<S>::locate(const T& x) const {
  double position = value_of(x), cycles = 0;
  if (periodic_) {
    cycles = std::floor((position - first()) / (last() - first()));
    position -= cycles * (last() - first());
  }
  // Rounding may leave a periodic position just outside the table: then the nearest cubic serves.
  const auto after = std::upper_bound(positions_.begin(), positions_.end(), position);
  auto index = static_cast<std::size_t>(after - positions_.begin());
  if (periodic_) index = std::max<std::size_t>(index, 1);
  if (index == positions_.size() && (periodic_ || position == last())) --index;
  const Piece& piece = pieces_[index];
  return {&piece, x - T(S(cycles) * period_ + piece.start), cycles};
}

template <class S>
template <class T>
SplineValue<T> Spline<S>::evaluate(const T& x) const {
  return value_at(locate(x));
}

template <class S>
template <class T>
SplineValue<T> Spline<S>::continue_from(double place, bool after, const T& x) const {
  // x is a sum of steps: a value that rounding puts on the other side of a knot still belongs to the knot.
  const double rounding = 1e-13 * std::max({std::abs(place), std::abs(first()), std::abs(last())});
  double position = after ? place + rounding : place - rounding, cycles = 0;
  if (periodic_) {
    cycles = std::floor((position - first()) / (last() - first()));
    position = std::clamp(position - cycles * (last() - first()), first(), std::nextafter(last(), first()));
  }
  const auto next = std::upper_bound(positions_.begin(), positions_.end(), position);
  const Piece& piece = pieces_[static_cast<std::size_t>(next - positions_.begin())];
  return value_at(Place<T>{&piece, x - T(S(cycles) * period_ + piece.start), cycles});
}

template <class S>
template <class T>
SplineValue<T> Spline<S>::value_at(const Place<T>& place) {
  const T& u = place.u;
  const T c0(place.piece->c0), c1(place.piece->c1), c2(place.piece->c2), c3(place.piece->c3);
  return {c0 + u * (c1 + u * (c2 + u * c3)), c1 + u * (T(2.0) * c2 + T(3.0) * u * c3), T(2.0) * c2 + T(6.0) * u * c3,
          T(6.0) * c3};
}

template <class S>
template <class T>
T Spline<S>::integral(const T& x) const {
  const Place<T> place = locate(x);
  const Piece& p = *place.piece;
  const T& u = place.u;
  const T whole_periods(S(place.cycles) * pieces_.back().area);
  return whole_periods + T(p.area) +
         u * (T(p.c0) + u * (T(p.c1 / S(2.0)) + u * (T(p.c2 / S(3.0)) + u * T(p.c3 / S(4.0)))));
}

extern template class Spline<double>;
extern template class Spline<Dual<double, 4>>;

}  // namespace catena
