// Functions of time: the value prescribed by a driver, or the magnitude of an applied force.
//
//   f(t), f'(t), f''(t)   constant, polynomial, harmonic, smooth step, motion law, spline through a table, sums,
//   products, your own
//
// They are evaluated once per instant, all three derivatives together, and read by the elements. The scalar S is
// double, or Dual where derivatives with respect to design parameters (amplitudes, table values, step times) are
// wanted. Breakpoints are the instants where f, f', f'' or f''' jumps: integrators stop there. At the breakpoint itself
// a step of order 3 has two second derivatives, and `Side` selects one: a time step that ends there needs the one
// before, the step that starts there the one after. Instants closer than 1e-13 |t| are the same instant. Units: those
// of the driven quantity; times in s.
#pragma once

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <stdexcept>
#include <vector>

#include "catena/base/dual.hpp"
#include "catena/base/motion_law.hpp"
#include "catena/base/spline.hpp"
#include "catena/base/taylor.hpp"

namespace catena {

enum class Side { before, after };

/// Thrown by TimeFunction::evaluate outside of a table that ends. Analyses compare `domain()` with their
/// time span beforehand, so that it is never thrown inside a running loop.
struct OutsideTable : std::out_of_range {
  OutsideTable(double instant, double table_first, double table_last);
  double t, first, last;
};

/// A closed range of time.
struct TimeRange {
  double first = -std::numeric_limits<double>::infinity();
  double last = std::numeric_limits<double>::infinity();

  bool contains(double t) const { return t >= first && t <= last; }
};

/// An immutable value: copies are cheap and may be evaluated from several threads.
template <class S>
class TimeFunction {
 public:
  using Callback = std::function<Taylor<double>(double t)>;

  TimeFunction() = default;                                 ///< zero
  TimeFunction(const S& constant) : constant_(constant) {}  ///< converts silently, as numbers do

  // The factories throw std::invalid_argument, naming the wrong entry, for data that define no function.

  /// c[0] + c[1] t + c[2] t^2 + ...
  static TimeFunction polynomial(std::span<const S> coefficients);
  /// offset + amplitude sin(omega t + phase); omega in rad/s, phase in rad.
  static TimeFunction harmonic(const S& amplitude, const S& omega, const S& phase = S(0.0), const S& offset = S(0.0));
  /// From `from` at t0 to `to` at t1 > t0 and constant outside; with u = (t - t0) / (t1 - t0) along
  /// 3 u^2 - 2 u^3 (order 3: the velocity is continuous) or 10 u^3 - 15 u^4 + 6 u^5 (order 5: the acceleration too).
  static TimeFunction step(const S& t0, const S& t1, const S& from, const S& to, int order);
  /// From `from` at t0 to `to` at t1 > t0 by a motion law, and constant outside.
  static TimeFunction law(MotionLaw law, const S& t0, const S& t1, const S& from, const S& to);
  /// Cubic spline through (t[k], value[k]). Outside the table `beyond` holds, except that a periodic one repeats.
  static TimeFunction spline(std::span<const S> t, std::span<const S> value, SplineEnd end,
                             Beyond beyond = Beyond::error);
  /// There must be an instant at which all terms, or factors, are defined.
  static TimeFunction sum(std::vector<TimeFunction> terms);
  static TimeFunction product(std::vector<TimeFunction> factors);
  /// Your own function, which returns value, first and second derivative; `breakpoints` increase. It is never called
  /// outside `domain`.
  static TimeFunction custom(Callback function, std::vector<double> breakpoints = {}, TimeRange domain = {});

  /// (f, f', f'') at t. Throws OutsideTable outside `domain()`.
  Taylor<S> evaluate(double t, Side side = Side::after) const;

  /// (f, f', f'') at t, wherever it is, by the piece that holds at the instant `from`, on its `side`: the polynomial of
  /// a step or of a table goes on, and your own function by its Taylor polynomial of second degree. Differences at the
  /// ends of a run and next to breakpoints are thus one-sided.
  Taylor<S> continue_from(double from, Side side, double t) const;
  /// Whether it contains a user-defined function, of which only two derivatives are known beyond its domain.
  bool has_callback() const;

  /// Whether f' = f'' = 0 at all times by construction: such a driver is a plain constraint.
  bool is_constant() const { return node_ == nullptr; }

  /// Where the function is defined: everything but the outside of tables that end.
  TimeRange domain() const;

  /// The first breakpoint later than t; infinity if none.
  double next_breakpoint(double t) const;
  /// The breakpoints strictly between t0 and t1, increasing, each instant once.
  std::vector<double> breakpoints(double t0, double t1) const;

 private:
  struct Node;
  explicit TimeFunction(std::shared_ptr<const Node> node) : node_(std::move(node)) {}
  /// `from` until t0, `to` after t1, between them as the pieces say; `what` is named in errors.
  static TimeFunction rise(const char* what, const MotionLawPieces& pieces, const S& t0, const S& t1, const S& from,
                           const S& to);

  S constant_{};                      // the value if there is no node: constants need no memory of their own
  std::shared_ptr<const Node> node_;  // any other function
};

extern template class TimeFunction<double>;
extern template class TimeFunction<Dual<double, 4>>;

}  // namespace catena
