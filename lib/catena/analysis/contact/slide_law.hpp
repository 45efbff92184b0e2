// The slide of a contact: how far the point of body j has moved along the curve of body i, as touching material sees
// it.
//
//   w = int_s0^s |p'| ds + R b (phi_j - phi_i - int_s0^s kappa |p'| ds)        s: foot of x,  x = A_i^T (r_Pj - r_i)
//
// R: radius of the disc around P_j, m; b = 1 where it is on the left of the curve, else -1; kappa: curvature. At
// contact x = p + R b n, so that w' is the velocity of the disc's material against the curve's along the tangent p': a
// wheel that rolls has w' = 0. The foot is that of point_on_curve.hpp; Newton steps in the scalar of the
// derivatives carry its derivatives exactly, as many as there are orders. On a closed curve s goes on beyond a period:
// as a place of the state it tells the whole turns, which no frame does. Singular as point_on_curve.hpp. S: the scalar
// of curve, point and R; that of the frames holds it. Units: m, rad. Source: Haug, section 3.4; rolling without slip.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "catena/base/design_scalar.hpp"
#include "catena/elements/curve_search.hpp"

namespace catena {

template <class S>
class SlideOnCurve {
 public:
  /// `arm`: R b; `start`: the foot in the given configuration, where w is zero.
  SlideOnCurve(BodyCurve<S> curve, const Vec2<S>& point, const S& arm, double start)
      : curve_(std::move(curve)), point_(point), arm_(arm), given_foot_(start) {
    if (!curve_.is_line()) lay_pieces();
    start_ = travel(S(start), start);
  }

  CurvePlace place() const { return {.s_i = given_foot_}; }
  /// On a closed curve by less than half a period.
  void follow_contact(const Frame<double>& i, const Frame<double>& j, CurvePlace& place) const {
    double s = place.s_i;
    place.is_regular = follow_foot(curve_, i.to_local(j.point(plain(point_)) - i.origin()), s);
    place.s_i = curve_.is_closed() ? place.s_i + std::remainder(s - place.s_i, curve_.range()) : s;
  }

  template <class T>
  T measure(const Frame<T>& i, const Frame<T>& j, const CurvePlace& place) const {
    const Vec2<T> x = i.to_local(j.point(point_) - i.origin());
    T s(place.s_i);
    if constexpr (!std::is_same_v<T, double>) {
      const double bend = foot_descent(curve_.plain(place.s_i), plain(x)).bend;
      // Each step is exact to one order more: two, and three where a series in time is one by parameters as well.
      constexpr int steps = std::is_same_v<T, Taylor<DesignScalar>> ? 3 : 2;
      for (int step = 0; step < steps; ++step) {
        const CurvePoint<T> c = curve_.evaluate(s);
        s = s - dot(c.p - x, c.d1) / T(bend);
      }
    }
    const auto [length, turn] = travel(s, place.s_i);
    return length - T(start_[0]) + T(arm_) * (j.phi - i.phi - turn + T(start_[1]));
  }

 private:
  /// Pieces end at the knots of the curve, where its third derivative jumps, and between them: every second of its
  /// samples is such a place. The rule is exact on circles, and to rounding on a quarter of a piece of a spline.
  void lay_pieces() {
    const std::vector<double> samples = curve_.samples();
    for (std::size_t k = 0; k < samples.size(); k += 2) ends_.push_back(samples[k]);
    until_.push_back({S(0.0), S(0.0)});
    for (std::size_t k = 0; k + 1 < ends_.size(); ++k) {
      const std::array<S, 2> way = gauss(S(ends_[k]), S(ends_[k + 1]));
      until_.push_back({until_.back()[0] + way[0], until_.back()[1] + way[1]});
    }
  }
  /// Length and turn of the curve from the start of its range to s, of which `foot` is the value.
  template <class T>
  std::array<T, 2> travel(const T& s, double foot) const {
    if (curve_.is_line()) return {norm(curve_.evaluate(s).d1) * s, T(0.0)};
    const double turns = curve_.is_closed() ? std::floor((foot - ends_.front()) / curve_.range()) : 0;
    const double there = foot - turns * curve_.range();
    const auto next = std::upper_bound(ends_.begin() + 1, ends_.end(), there);
    const auto piece = static_cast<std::size_t>(next - ends_.begin()) - 1;
    std::array<T, 2> way = gauss(T(ends_[piece]), s - T(turns * curve_.range()));
    for (std::size_t k = 0; k < 2; ++k) way[k] = way[k] + T(until_[piece][k] + S(turns) * until_.back()[k]);
    return way;
  }
  /// The same between two places of a piece, by Gauss's rule of five points.
  template <class T>
  std::array<T, 2> gauss(const T& from, const T& to) const {
    constexpr std::array<double, 5> place{-0.9061798459386640, -0.5384693101056831, 0, 0.5384693101056831,
                                          0.9061798459386640};
    constexpr std::array<double, 5> weight{0.2369268850561891, 0.4786286704993665, 0.5688888888888889,
                                           0.4786286704993665, 0.2369268850561891};
    const T h = (to - from) * T(0.5), middle = (to + from) * T(0.5);
    std::array<T, 2> way{T(0.0), T(0.0)};
    for (std::size_t k = 0; k < place.size(); ++k) {
      const CurvePoint<T> c = curve_.evaluate(middle + T(place[k]) * h);
      way[0] = way[0] + T(weight[k]) * norm(c.d1) * h;
      way[1] = way[1] + T(weight[k]) * cross(c.d1, c.d2) / squared_norm(c.d1) * h;
    }
    return way;
  }

  BodyCurve<S> curve_;
  Vec2<S> point_;
  S arm_;
  std::vector<double> ends_;             // of pieces of the curve
  std::vector<std::array<S, 2>> until_;  // length and turn of the curve up to each of them
  std::array<S, 2> start_{};             // and up to the place where w is zero
  double given_foot_;
};

}  // namespace catena
