// The gradient of one measure of an equilibrium by any number of a model's own numbers: one solve for all of them.
//
//   F = V_q + Phi_q^T lambda = 0,  Phi = 0     m(q, lambda, p)      K = F_q, symmetric
//   [ K      Phi_q^T ] [ w  ]   [ m_q      ]
//   [ Phi_q  0       ] [ mu ] = [ m_lambda ]        dm/dp = m_p - w^T F_p - mu^T Phi_p
//
// w^T F_p = (V_q w)_p + lambda^T (Phi_q w)_p: derivatives along w. Every element has its own part, evaluated in dual
// numbers by up to four of its numbers. Factors are those that the equilibrium was certified with, refined against the
// true matrix; only where these do not lead to the solution is it factored anew (counted). Singular where the
// equilibrium is neutral. Not for equilibria without an energy (follower forces, laws of state), whose K is not
// symmetric. Units of m over those of the numbers. Source: apps/manual/sensitivity.md.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "catena/analysis/statics/equilibrium.hpp"
#include "catena/base/at.hpp"
#include "catena/base/design_scalar.hpp"

namespace catena {

class EquilibriumGradient {
 public:
  using Derivatives = std::array<double, parameters_at_once>;

  /// At the last solution of `rest`, which must outlive this object and stay there; std::invalid_argument if there is
  /// none, or none with an energy.
  explicit EquilibriumGradient(Equilibrium& rest);

  /// Takes a measure by its derivatives at fixed numbers: `by_q` over three coordinates a body in the model's order,
  /// `by_lambda` over the solver's rows, as Equilibrium::lambda() has them. Either may be empty: zero. False where the
  /// equilibrium is neutral: there is no gradient.
  bool measure(std::span<const double> by_q, std::span<const double> by_lambda);
  /// The measure that is the force or the torque which an element exerts, row `row` of it.
  bool measure_multiplier(int element, int row);

  /// dm/dx of four numbers x at most of every constraint of a type, in the order of the model's list of this type;
  /// zero for welds that were eliminated. `lift(k, element)`: element number k with its numbers as variables 0 ... 3.
  /// Numbers of a pin: Revolute<DesignScalar>{{DesignScalar::variable(pin.s_i.x, 0), ...
  template <template <class> class E, class Lift>
  std::vector<Derivatives> by_constraints(Lift&& lift) const;
  /// The same of the forces of a type, all of which must have a potential.
  template <template <class> class E, class Lift>
  std::vector<Derivatives> by_forces(Lift&& lift) const;
  /// dm/dm_b by the masses of the bodies, model order; zero for those that do not move.
  std::vector<double> by_masses() const;

 private:
  using Along = Dual<DesignScalar, 1>;  // of a derivative along w, by four numbers

  bool solve();
  bool refine();
  const Evaluator& evaluator() const { return system_.evaluator(); }
  const Plan& plan() const { return system_.plan(); }
  Frame<Along> frame(int plan_body) const;
  /// Of a block's element: frames relative to a common origin, and where that lies in the ground.
  struct Pair {
    Frame<Along> i, j;
    Vec2<double> ground{};
  };
  Pair frames(int body_i, int body_j, int bodies) const;

  StaticSystem& system_;
  std::span<const double> q_, lambda_;
  bool neutral_;                                // by the certificate: rounding may leave the matrix regular
  std::vector<double> right_, x_, correction_;  // columns, then rows
  std::vector<double> w_;                       // all coordinates
};

template <template <class> class E, class Lift>
std::vector<EquilibriumGradient::Derivatives> EquilibriumGradient::by_constraints(Lift&& lift) const {
  using Plain = E<double>;
  const auto& list = std::get<std::vector<ElementEntry<Plain, double>>>(evaluator().model().constraints);
  const auto& block = std::get<ConstraintBlock<Plain>>(plan().blocks);
  const std::span<const double> mu = std::span<const double>(x_).subspan(at(plan().columns));
  std::vector<Derivatives> gradient(list.size());
  for (int e = 0; e < block.size(); ++e) {
    const int k = block.entry[at(e)];
    const auto& entry = list[at(k)];
    const E<DesignScalar> element = lift(k, entry.element);
    const Pair f = frames(block.body_i[at(e)], Plain::bodies == 2 ? block.body_j[at(e)] : -1, Plain::bodies);
    Along c{}, rows[Plain::rows];
    if constexpr (Plain::functions > 0) c = Along(DesignScalar(evaluator().element_value(entry.id).f));
    const CurvePlace contact = evaluator().contact(entry.id);
    element.phi(Arguments<Along>{f.i, f.j, c, f.ground, &contact}, rows);
    double scale = 1;
    if constexpr (HasSquaredValue<Plain>) scale = evaluator().element_jacobian(entry.id).scale;
    for (int r = 0; r < Plain::rows; ++r) {
      const std::size_t row = at(block.row(e) + r);
      for (std::size_t p = 0; p < gradient[at(k)].size(); ++p)
        gradient[at(k)][p] -= scale * (lambda_[row] * rows[r].d[0].d[p] + mu[row] * rows[r].v.d[p]);
    }
  }
  return gradient;
}

template <template <class> class E, class Lift>
std::vector<EquilibriumGradient::Derivatives> EquilibriumGradient::by_forces(Lift&& lift) const {
  using Plain = E<double>;
  const auto& list = std::get<std::vector<ElementEntry<Plain, double>>>(evaluator().model().forces);
  const auto& block = std::get<ForceBlock<Plain>>(plan().forces);
  const Twist<Along> rest;
  std::vector<Derivatives> gradient(list.size());
  for (int e = 0; e < block.size(); ++e) {
    const int k = block.entry[at(e)];
    const auto& entry = list[at(k)];
    const E<DesignScalar> element = lift(k, entry.element);
    const Pair f = frames(block.body_i[at(e)], Plain::bodies == 2 ? block.body_j[at(e)] : -1, Plain::bodies);
    std::array<Along, Plain::functions + 1> values;
    for (std::size_t n = 0; n < entry.values.size(); ++n) {
      const auto& value = entry.values[n];
      values[n] = Along(DesignScalar(
          value.function < 0 ? value.constant
                             : evaluator().model().functions[at(value.function)].evaluate(evaluator().time()).f));
    }
    const Along energy = element.potential(ForceArguments<Along>{f.i, f.j, rest, rest, values.data(), f.ground});
    for (std::size_t p = 0; p < gradient[at(k)].size(); ++p) gradient[at(k)][p] = -energy.d[0].d[p];
  }
  return gradient;
}

}  // namespace catena
