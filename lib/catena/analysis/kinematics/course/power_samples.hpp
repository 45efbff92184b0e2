// Whether four points of a stretch show what dampers and loads do in it (work_sum.hpp).
//
// What a law that bends or jumps does wrong in a sum, drivers give wrongly as well, so that energies balance all the
// same: these integrals must be judged by themselves. Their powers at both ends of the stretch and at the four points
// are a sum of the polynomials p0 ... p5 that are orthonormal over these six places, with coefficients c_k:
//
//   top = hypot(c4, c5), low = hypot(c2, c3), r = top / low        error <= span top min(1, (r / 0.05)^2)
//
// Coefficients of a smooth power fall like those of its Taylor series, and with r the error of the rule falls beyond
// top. Those of a power that bends or jumps do not. Over stretches of 0.2 and less this estimate was 290 times the
// error for powers of two periods a turn; 0.04 % of 40,000 kinks had ten times more, none above 2e-9 of the power.
//
// Friction is mu N, and N = |n| bends where a guide's force n, or its moment, turns: what it takes, drivers give, and
// the gap of energies stays. So it does where a pin's force comes through zero, though not where that turns round the
// pin. Each of them, times the slip, is a power p as a vector, |p| of which is lost; where p comes through zero along
// its direction at the start of a stretch of length h, the sum misses up to h max |p|, a part that falls with h^2. At
// the ends of a stretch p is not known where functions of time jump, or a joint rests.
//
// A pulse between two places is not seen at all. Where a law compares what changes its sign in the stretch, or comes
// near to zero in between, the stretch counts as not smooth: run/law_switches.hpp.
//
// Source: J. Berntsen, T. Espelid, Error estimation in automatic quadrature routines, ACM TOMS 17 (1991) 233.
#pragma once

#include <array>
#include <cstddef>
#include <span>
#include <vector>

#include "catena/analysis/run/law_switches.hpp"
#include "catena/assembly/evaluate.hpp"

namespace catena {

class PowerSamples {
 public:
  /// Of a stretch, in its order: the end where it begins, the four points, the end where it ends.
  using Samples = std::array<double, 6>;
  static constexpr std::size_t places = std::tuple_size_v<Samples>;
  /// Of the lower coefficients, or of the power: higher ones above this part are not known to fall; see above.
  static constexpr double unresolved = 0.05;

  void begin(const Evaluator& evaluator);
  /// At the evaluator's configuration and time, W.
  void take(std::size_t place, double dissipated, double supplied, std::span<const double> qd);
  /// Vectors there whose lengths are powers of friction, W, to be filled in; empty: not known.
  std::vector<Vec2<double>>& pressing(std::size_t place) { return pressing_[place]; }
  bool rubs() const { return !pressing_[1].empty(); }
  /// The largest power of those that come through zero, or near to it, in all, W.
  double turning_power() const;
  /// The next stretch begins where this one ends.
  void go_on() { pressing_.front() = pressing_.back(); }
  /// Estimate of the error, J, of the two integrals over a stretch of this length, s.
  double error(double span) const;
  /// Whether a law may switch from one branch to another between two places.
  bool may_switch() const;

 private:
  LawSwitches laws_;
  std::array<Samples, 2> power_{};
  std::array<std::vector<double>, places> differences_;  // of all comparisons of these laws
  std::array<std::vector<Vec2<double>>, places> pressing_;
};

}  // namespace catena
