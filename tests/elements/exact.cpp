#if __has_include(<boost/multiprecision/cpp_dec_float.hpp>)

#include "elements/exact.hpp"

#include <ostream>

namespace catena {

Exact::Exact(double value) : number_(value) {}
Exact Exact::of(const Number& number) {
  Exact result;
  result.number_ = number;
  return result;
}

Exact Exact::operator-() const { return of(-number_); }
Exact operator+(const Exact& a, const Exact& b) { return Exact::of(a.number_ + b.number_); }
Exact operator-(const Exact& a, const Exact& b) { return Exact::of(a.number_ - b.number_); }
Exact operator*(const Exact& a, const Exact& b) { return Exact::of(a.number_ * b.number_); }
Exact operator/(const Exact& a, const Exact& b) { return Exact::of(a.number_ / b.number_); }
Exact sqrt(const Exact& a) { return Exact::of(sqrt(a.number_)); }
Exact cos(const Exact& a) { return Exact::of(cos(a.number_)); }
Exact sin(const Exact& a) { return Exact::of(sin(a.number_)); }
Exact atan2(const Exact& y, const Exact& x) { return Exact::of(atan2(y.number_, x.number_)); }
double value_of(const Exact& a) { return static_cast<double>(a.number_); }
std::ostream& operator<<(std::ostream& out, const Exact& a) { return out << a.number_; }

}  // namespace catena

#endif
