// How fast laws of state change with time alone, so that no step passes over what one of them does for a short time.
//
//   F(t) = f(columns(q, qd), t) at a q and qd that stand still:  in a stretch of length l the polynomial through five
//   samples of it foretells four others to 0.1 % of the range of all (event_samples.hpp)
//
// A mechanism at rest tells an integrator nothing of a pulse that is to come: its error is zero, and the next step may
// end behind it. Steps that reach into a stretch are therefore not longer than 4 l: the polynomials of integrators are
// of that order or higher, and some of their stages lie in each stretch. A steady oscillation has stretches of a
// radian or more, which ordinary tolerances resolve anyway. A pulse shorter than one part in 250 of the run may be
// missed, as may be one that depends on places alone. Units: s.
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/events/event_samples.hpp"
#include "catena/assembly/evaluate.hpp"

namespace catena {

class LawStretches {
 public:
  /// Whether some law reads t: else there is nothing to look at.
  static bool any(const Evaluator& evaluator);
  /// In [from, to], where the evaluator and qd are; leaves the evaluator at another time.
  LawStretches(Evaluator& evaluator, std::span<const double> qd, double from, double to);

  bool covers(double from, double to) const { return from >= from_ && to <= to_; }
  /// A step from t may go on to this instant.
  double limit(double t) const;

 private:
  struct Stretch {
    double begin, length;
    double reach;  // of steps that begin before this stretch
  };
  void divide(Evaluator& evaluator, std::span<const double> qd, double from, double to, int halvings);
  bool is_foretold(Evaluator& evaluator, std::span<const double> qd, double from, double to);
  void sample(Evaluator& evaluator, std::span<const double> qd, double t, std::span<double> values) const;

  double from_, to_;
  std::vector<int> laws_;       // those that read t
  std::vector<double> ranges_;  // of these
  std::vector<Stretch> stretches_;
  EventSamples taken_;
};

}  // namespace catena
