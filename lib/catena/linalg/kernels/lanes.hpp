// Four numbers that go through the same operations side by side: right-hand sides that share a matrix.
//
//   y += a x,  y -= a x,  y = x / a        x, y in lanes, a one number for all of them
//
// Kept as two pairs, which every 64-bit processor adds and multiplies at once; a lane rounds as a number by itself
// does.
#pragma once

#include <cstring>

namespace catena {

struct Lanes {
  static constexpr int count = 4;
  using Pair = double __attribute__((vector_size(16)));
  Pair low{}, high{};

  static Lanes load(const double* from) {
    Lanes x;
    std::memcpy(&x.low, from, sizeof(Pair));
    std::memcpy(&x.high, from + 2, sizeof(Pair));
    return x;
  }
  void store(double* to) const {
    std::memcpy(to, &low, sizeof(Pair));
    std::memcpy(to + 2, &high, sizeof(Pair));
  }
  double operator[](int lane) const { return lane < 2 ? low[lane] : high[lane - 2]; }

  void set(int lane, double x) { (lane < 2 ? low : high)[lane % 2] = x; }

  Lanes& operator+=(const Lanes& x) {
    low += x.low;
    high += x.high;
    return *this;
  }
  Lanes& operator-=(const Lanes& x) {
    low -= x.low;
    high -= x.high;
    return *this;
  }
};

inline Lanes operator+(Lanes x, const Lanes& y) { return x += y; }
inline Lanes operator-(Lanes x, const Lanes& y) { return x -= y; }
inline Lanes operator-(const Lanes& x) { return Lanes() - x; }
inline Lanes operator*(double a, const Lanes& x) {
  Lanes y;
  y.low = a * x.low;
  y.high = a * x.high;
  return y;
}
inline Lanes operator/(const Lanes& x, double a) {
  Lanes y;
  y.low = x.low / a;
  y.high = x.high / a;
  return y;
}

}  // namespace catena
