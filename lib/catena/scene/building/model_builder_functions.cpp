// ModelBuilder: functions of time, curves and tables.
#include <cmath>

#include "catena/scene/building/model_builder.hpp"

namespace catena {

template <class S>
TimeFunction<S> ModelBuilder<S>::function(const FunctionTemplate& source) {
  using Kind = FunctionTemplate::Kind;
  std::vector<S> n;
  for (const NumberValue& number : source.numbers) n.push_back(value(number));
  // A function that could not be read or has no value was reported: any function may replace it.
  for (const S& number : n) {
    if (std::isnan(value_of(number))) return S(1.0);
  }
  std::vector<TimeFunction<S>> parts;
  for (const FunctionTemplate& part : source.parts) parts.push_back(function(part));
  if (n.empty() && parts.empty()) return S(1.0);
  switch (source.kind) {
    case Kind::constant:
    case Kind::state:  // no function of time
      break;
    case Kind::polynomial:
      return TimeFunction<S>::polynomial(n);
    case Kind::harmonic:
      return TimeFunction<S>::harmonic(n[0], n[1], n[2], n[3]);
    case Kind::step:
      return TimeFunction<S>::step(n[0], n[1], n[2], n[3], source.order);
    case Kind::law:
      return TimeFunction<S>::law(source.law, n[0], n[1], n[2], n[3]);
    case Kind::spline:
      return TimeFunction<S>::spline(std::span(n).first(n.size() / 2), std::span(n).last(n.size() / 2), source.end,
                                     source.beyond);
    case Kind::sum:
      return TimeFunction<S>::sum(std::move(parts));
    case Kind::product:
      return TimeFunction<S>::product(std::move(parts));
  }
  return n[0];
}

template <class S>
Curve<S> ModelBuilder<S>::curve(const CurveTemplate& source) {
  using Kind = CurveTemplate::Kind;
  std::vector<S> n;
  for (const NumberValue& number : source.numbers) {
    n.push_back(value(number));
    if (std::isnan(value_of(n.back()))) n.clear();
  }
  // A curve that could not be read or has no value was reported: any curve may replace it.
  const auto any = [] { return Curve<S>::circle({}, S(1.0)); };
  if (n.size() != source.numbers.size() || n.empty()) return any();
  switch (source.kind) {
    case Kind::circle:
      return Curve<S>::circle(Vec2<S>{n[0], n[1]}, n[2]);
    case Kind::spline: {
      std::vector<Vec2<S>> points;
      for (std::size_t k = 0; k + 1 < n.size(); k += 2) points.push_back(Vec2<S>{n[k], n[k + 1]});
      return Curve<S>::spline(points, source.end, source.beyond);
    }
    case Kind::polar:
      return Curve<S>::polar(std::span(n).first(n.size() / 2), std::span(n).last(n.size() / 2));
    case Kind::line:
      return Curve<S>::line(Vec2<S>{n[0], n[1]}, {n[2], n[3]});
  }
  return any();
}

template <class S>
std::vector<Vec2<S>> ModelBuilder<S>::table(const TableTemplate& source) {
  std::vector<Vec2<S>> pairs;
  for (std::size_t k = 0; k + 1 < source.numbers.size(); k += 2)
    pairs.push_back({value(source.numbers[k]), value(source.numbers[k + 1])});
  return pairs;
}

// Instantiated member by member: the rest of the class is in other files.
template TimeFunction<double> ModelBuilder<double>::function(const FunctionTemplate&);
template Curve<double> ModelBuilder<double>::curve(const CurveTemplate&);
template std::vector<Vec2<double>> ModelBuilder<double>::table(const TableTemplate&);
template TimeFunction<Dual<double, 4>> ModelBuilder<Dual<double, 4>>::function(const FunctionTemplate&);
template Curve<Dual<double, 4>> ModelBuilder<Dual<double, 4>>::curve(const CurveTemplate&);
template std::vector<Vec2<Dual<double, 4>>> ModelBuilder<Dual<double, 4>>::table(const TableTemplate&);

}  // namespace catena
