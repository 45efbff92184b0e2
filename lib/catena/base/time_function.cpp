#include "catena/base/time_function.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <string>
#include <utility>
#include <variant>

#include "catena/base/number_text.hpp"
#include "catena/base/time_function_kinds.hpp"

namespace catena {

using namespace time_function_kinds;

namespace {

template <class S>
void require_finite(std::initializer_list<std::pair<const char*, S>> numbers, const char* what) {
  for (const auto& [name, number] : numbers) {
    if (!std::isfinite(value_of(number)))
      throw std::invalid_argument(std::string(what) + ": " + name + " is not finite");
  }
}

void require_common_instant(const TimeRange& domain, const char* what) {
  if (domain.first <= domain.last) return;
  throw std::invalid_argument(std::string(what) +
                              ": there is no instant at which all parts are defined: one begins at " +
                              number_text(domain.first) + " s, another ends at " + number_text(domain.last) + " s");
}

/// Zero whatever the design parameters are.
bool vanishes(double a) { return a == 0; }
template <class T, int N>
bool vanishes(const Dual<T, N>& a) {
  return vanishes(a.v) && std::all_of(a.d.begin(), a.d.end(), [](const T& d) { return vanishes(d); });
}

}  // namespace

OutsideTable::OutsideTable(double instant, double table_first, double table_last)
    : std::out_of_range("time " + number_text(instant) + " s lies outside the spline's table, which covers " +
                        number_text(table_first) + " s to " + number_text(table_last) +
                        " s; extend the table or make it periodic"),
      t(instant),
      first(table_first),
      last(table_last) {}

template <class S>
struct TimeFunction<S>::Node {
  std::variant<Polynomial<S>, Harmonic<S>, Law<S>, Table<S>, Combination<S>, Custom<S>> kind;
};

template <class S>
TimeFunction<S> TimeFunction<S>::polynomial(std::span<const S> coefficients) {
  std::vector<S> kept(coefficients.begin(), coefficients.end());
  for (std::size_t k = 0; k < kept.size(); ++k) {
    require_finite<S>({{("coefficient[" + std::to_string(k) + "]").c_str(), kept[k]}}, "polynomial");
  }
  while (!kept.empty() && vanishes(kept.back())) kept.pop_back();
  if (kept.empty()) return TimeFunction();
  if (kept.size() == 1) return TimeFunction(kept.front());
  return TimeFunction(std::make_shared<const Node>(Node{Polynomial<S>{std::move(kept)}}));
}

template <class S>
TimeFunction<S> TimeFunction<S>::harmonic(const S& amplitude, const S& omega, const S& phase, const S& offset) {
  require_finite<S>({{"amplitude", amplitude}, {"omega", omega}, {"phase", phase}, {"offset", offset}}, "harmonic");
  if (vanishes(amplitude)) return TimeFunction(offset);
  return TimeFunction(std::make_shared<const Node>(Node{Harmonic<S>{amplitude, omega, phase, offset}}));
}

template <class S>
TimeFunction<S> TimeFunction<S>::rise(const char* what, const MotionLawPieces& pieces, const S& t0, const S& t1,
                                      const S& from, const S& to) {
  require_finite<S>({{"t0", t0}, {"t1", t1}, {"from", from}, {"to", to}}, what);
  if (!(t1 > t0)) {
    throw std::invalid_argument(std::string(what) + ": t1 = " + number_text(value_of(t1)) +
                                " must be later than t0 = " + number_text(value_of(t0)));
  }
  if (vanishes(to - from)) return TimeFunction(from);
  return TimeFunction(std::make_shared<const Node>(Node{Law<S>{t0, t1, from, to, pieces}}));
}

template <class S>
TimeFunction<S> TimeFunction<S>::step(const S& t0, const S& t1, const S& from, const S& to, int order) {
  if (order != 3 && order != 5) throw std::invalid_argument("step: order must be 3 or 5, is " + std::to_string(order));
  return rise("step", order == 3 ? cubic_step() : motion_law_pieces(MotionLaw::poly345), t0, t1, from, to);
}

template <class S>
TimeFunction<S> TimeFunction<S>::law(MotionLaw law, const S& t0, const S& t1, const S& from, const S& to) {
  return rise("law", motion_law_pieces(law), t0, t1, from, to);
}

template <class S>
TimeFunction<S> TimeFunction<S>::spline(std::span<const S> t, std::span<const S> value, SplineEnd end, Beyond beyond) {
  return TimeFunction(std::make_shared<const Node>(Node{Table<S>{Spline<S>(t, value, end, beyond)}}));
}

template <class S>
TimeFunction<S> TimeFunction<S>::sum(std::vector<TimeFunction> terms) {
  if (terms.empty()) throw std::invalid_argument("sum: needs at least one term");
  Combination<S> combination{std::move(terms), false};
  require_common_instant(combination.domain(), "sum");
  const bool constant = std::ranges::all_of(combination.parts, &TimeFunction::is_constant);
  if (constant) return TimeFunction(combination.evaluate(0, Side::after).f);
  return TimeFunction(std::make_shared<const Node>(Node{std::move(combination)}));
}

template <class S>
TimeFunction<S> TimeFunction<S>::product(std::vector<TimeFunction> factors) {
  if (factors.empty()) throw std::invalid_argument("product: needs at least one factor");
  Combination<S> combination{std::move(factors), true};
  require_common_instant(combination.domain(), "product");
  const bool constant = std::ranges::all_of(combination.parts, &TimeFunction::is_constant);
  if (constant) return TimeFunction(combination.evaluate(0, Side::after).f);
  return TimeFunction(std::make_shared<const Node>(Node{std::move(combination)}));
}

template <class S>
TimeFunction<S> TimeFunction<S>::custom(Callback function, std::vector<double> breakpoints, TimeRange domain) {
  if (!function) throw std::invalid_argument("custom function of time: the callback is empty");
  if (std::ranges::any_of(breakpoints, [](double t) { return !std::isfinite(t); })) {
    throw std::invalid_argument("custom function of time: a breakpoint is not finite");
  }
  if (!(domain.first <= domain.last)) {
    throw std::invalid_argument("custom function of time: its domain ends before it begins");
  }
  if (!std::ranges::is_sorted(breakpoints)) {
    throw std::invalid_argument("custom function of time: breakpoints must increase");
  }
  return TimeFunction(
      std::make_shared<const Node>(Node{Custom<S>{std::move(function), std::move(breakpoints), domain}}));
}

template <class S>
Taylor<S> TimeFunction<S>::evaluate(double t, Side side) const {
  if (!node_) return Taylor<S>(constant_);
  return std::visit([&](const auto& kind) { return kind.evaluate(t, side); }, node_->kind);
}

template <class S>
Taylor<S> TimeFunction<S>::continue_from(double from, Side side, double t) const {
  if (!node_) return Taylor<S>(constant_);
  return std::visit([&](const auto& kind) { return kind.continue_from(from, side, t); }, node_->kind);
}

template <class S>
bool TimeFunction<S>::has_callback() const {
  if (!node_) return false;
  if (const auto* parts = std::get_if<Combination<S>>(&node_->kind))
    return std::ranges::any_of(parts->parts, &TimeFunction::has_callback);
  return std::holds_alternative<Custom<S>>(node_->kind);
}

template <class S>
TimeRange TimeFunction<S>::domain() const {
  if (!node_) return {};
  return std::visit([](const auto& kind) { return kind.domain(); }, node_->kind);
}

template <class S>
double TimeFunction<S>::next_breakpoint(double t) const {
  if (!node_) return never;
  return std::visit([&](const auto& kind) { return kind.next_breakpoint(t); }, node_->kind);
}

template <class S>
std::vector<double> TimeFunction<S>::breakpoints(double t0, double t1) const {
  std::vector<double> result;
  double latest = t0;
  for (double t = next_breakpoint(t0); t < t1 && !same_instant(t, t1); t = next_breakpoint(t)) {
    if (!same_instant(t, latest)) result.push_back(latest = t);
  }
  return result;
}

template class TimeFunction<double>;
template class TimeFunction<Dual<double, 4>>;

}  // namespace catena
