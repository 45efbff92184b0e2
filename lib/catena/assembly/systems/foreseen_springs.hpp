// The stiffness of springs at the length to which a linearised step leads (the foreseen length), in place of the
// present length.
//
//   h = r_Pj - r_Pi    l = |h|    n = h / l    g = dl/dq    H = dh/dq    f(l) tension
//   K = f'(L) g g^T + f(L) / L H^T (I - n n^T) H + f(L) n . d2h/dq2          L = l0 + g0 . dq, l0 and g0 before the
//   step
//
// A step that turns a stiff spring also lengthens it by the square of the turn, and k times that length is larger than
// the tension that the spring will carry: Newton's method on chains of such springs takes steps by the hundred. With
// f(L) in the place of f(l), the step is that of the equations in which tensions are unknowns of their own, f - f(l(q))
// = 0, as multipliers of links are: a stiff spring converges like a link, a soft one as with its present length (L = l
// to second order), and K of a spring without free length does not change. Where K is to be convex a compressive f(L) <
// 0 counts as a tension of the same size: otherwise almost no stiffness would act across a chain of compressed springs,
// and steps would be hundreds of chain lengths long. m, N. Singular where l = 0 or L = 0: the present K then counts.
// Source: Benzi, Golub, Liesen, Acta Numerica 14 (2005), section 1 (saddle point form of stiff terms).
#pragma once

#include <span>
#include <utility>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/assembly/hessian_slots.hpp"
#include "catena/elements/force_curve.hpp"

namespace catena {

class ForeseenSprings {
 public:
  /// `slots`: of all elements.
  ForeseenSprings(const Evaluator& evaluator, const HessianSlots& slots);

  /// Whether there are springs at all.
  bool any() const { return !springs_.empty(); }
  /// Takes over parameter values of a model with the same structure.
  void take_over_model(const Evaluator& evaluator);

  /// Foreseen lengths for a change of q (all coordinates) from the evaluator's configuration; without a change: free
  /// lengths.
  void foresee(const Evaluator& evaluator, std::span<const double> change);
  /// Returns to present lengths.
  void forget() { active_ = false; }
  bool active() const { return active_; }

  /// Slots for everything else: springs have none.
  const HessianSlots& others() const { return others_; }
  /// Adds K of all springs; convex: |f(L)| / L across the line, and without negative contributions in the other parts.
  void add(const Evaluator& evaluator, Curvature curvature, std::span<double> values) const;

 private:
  struct Spring {
    int type, entry;  // place in the model's lists
    int i, j;         // plan bodies, -1: the ground
    int slot;         // the first of 21 in own_: the lower triangle over [q_i, q_j]
    Vec2<double> s_i{}, s_j{};
    Vec2<double> apart{};  // h without what bodies' relative frames add
    double k = 0, free_length = 0, force = 0;
    int function = -1;  // of time, that gives `force`
    const ForceCurve<double>* curve = nullptr;
    double length = 0;  // foreseen
  };
  struct Geometry {
    Vec2<double> h, arm_i, arm_j;
  };
  static Geometry geometry_of(const Evaluator& evaluator, const Spring& spring);
  /// f and f' at a length.
  static std::pair<double, double> law(const Spring& spring, double length);

  HessianSlots own_, others_;
  std::vector<Spring> springs_;
  bool active_ = false;
};

}  // namespace catena
