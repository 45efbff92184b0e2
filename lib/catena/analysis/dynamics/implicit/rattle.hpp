// RATTLE: steps of one length that keep the structure of a motion without losses, of order 2.
//
//   v' = v + h/2 M^-1 (Q(q, v) - Phi_q^T lambda)     q1 = q + h v',   lambda such that Phi(q1) = 0
//   v1 = v' + h/2 M^-1 (Q(q1, v1) - Phi_q1^T mu)     mu such that Phi_q1 v1 = nu
//
// The map is symmetric in time and symplectic where Q has a potential: the energy of a motion without losses stays
// within a bound of size h^2 over times as long as wanted, where other methods drift. The impulse h/2 lambda acts along
// the constraints of the beginning of the step: the factors at q serve the whole search for q1. Forces that depend on
// velocities make the second line an equation for v1; it is solved by repetition, which converges where a step is
// shorter than what damping needs to stop a body.
//
// Singular positions are crossed as a fixed step happens to. The integrals that ride along (motion.hpp) are summed up
// by the trapezoid rule, of the same order. Source: H. Andersen, J. Comp. Phys. 52 (1983); E. Hairer, C. Lubich, G.
// Wanner, Geometric Numerical Integration, VII.1.4.
#pragma once

#include <limits>
#include <vector>

#include "catena/analysis/dynamics/integrators/error_scale.hpp"
#include "catena/analysis/dynamics/integrators/integrator.hpp"
#include "catena/analysis/dynamics/integrators/motion.hpp"

namespace catena {

class Rattle final : public Integrator {
 public:
  /// `step`, s: of all steps but those that end where the run does, or where a function of time jumps. `horizon`, s:
  /// where the run ends.
  Rattle(Motion motion, double step, double horizon);

  bool start(double t, std::span<const double> y) override;
  bool advance(double limit) override;
  /// By the cubic through places and velocities of both ends, and that through velocities and accelerations.
  void interpolate(double t, std::span<double> y) override;
  IntegratorMemory memory() const override;
  void remember(const IntegratorMemory& memory) override { scale_.remember(memory); }
  bool may_pause() const override { return true; }
  /// Not known: a step of one length has no estimate.
  void add_error(std::span<double> error) const override {
    std::fill(error.begin(), error.end(), std::numeric_limits<double>::quiet_NaN());
  }
  std::span<const double> accelerations() const override {
    return std::span(slope_).subspan(motion_.coordinates(), motion_.coordinates());
  }
  double rate() const override { return scale_.rate(); }

 private:
  bool find_places(double h);
  bool find_velocities(double h);
  void observe(double h);

  Motion motion_;
  ErrorScale scale_;
  double step_ = 0, from_ = 0, t_new_ = 0;
  std::int64_t steps_ = 0;                       // since from_: multiplied, they do not add up their roundings
  std::vector<double> y_before_, y_new_, half_;  // half_: v'
  std::vector<double> slope_, slope_before_;
};

}  // namespace catena
