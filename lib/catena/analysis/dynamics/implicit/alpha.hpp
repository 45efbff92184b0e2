// The generalized-alpha method, of order 2: vibrations too fast for the step are damped as strongly as `rho` says.
//
//   (1 - am) A1 + am A0 = (1 - af) a(t1, q1, v1) + af a(t0, q0, v0)
//   q1 = q0 + h v0 + h^2 ((1/2 - b) A0 + b A1),   v1 = v0 + h ((1 - g) A0 + g A1)
//   am = (2 rho - 1)/(rho + 1),  af = rho/(rho + 1),  g = 1/2 + af - am,  b = (g + 1/2)^2 / 4
//
// a is the acceleration that the equations of motion give, A one of the method's own, which follows it. rho, 0 ... 1:
// the part that a step leaves of a vibration much faster than it; 1 leaves all of it, 0 nothing. Newton's method has
// one system of the size of the mechanism with implicit_matrix.hpp, at mu = sqrt((1 - am)/((1 - af) b)) / h: its
// damping has the coefficient mu in place of g/(b h), which differs by 6 % at most. q1 and v1 are projected onto the
// constraints.
//
// Of a vibration with h omega >> 1 all three roots are -rho. Error of a step: h^2 |b - 1/6| (A1 - A0) of places, h/12
// of the second difference of a of velocities. Source: J. Chung, G. Hulbert, J. Appl. Mech. 60 (1993); M. Arnold, O.
// Bruels, Multibody Syst. Dyn. 18 (2007) for constrained motions.
#pragma once

#include <limits>
#include <vector>

#include "catena/analysis/dynamics/implicit/implicit_matrix.hpp"
#include "catena/analysis/dynamics/integrators/crossing_integrator.hpp"
#include "catena/analysis/dynamics/integrators/error_scale.hpp"

namespace catena {

struct AlphaOptions {
  double rho = 0.8;
  double tolerance = 1e-10;  ///< of a step's error, see error_scale.hpp
  double fixed_step = 0;     ///< s; 0: adaptive
  double horizon = 0;        ///< s, where the run ends
};

class Alpha final : public CrossingIntegrator {
 public:
  /// `across`: of Runge-Kutta, which takes the steps across singular positions.
  Alpha(Motion motion, const AlphaOptions& options, const RungeKuttaOptions& across);

  bool start(double t, std::span<const double> y) override;
  bool advance(double limit) override;
  /// By the cubic through places and velocities of both ends, and that through velocities and accelerations.
  void interpolate(double t, std::span<double> y) override;
  IntegratorMemory memory() const override { return memory_of(scale_, h_); }
  void remember(const IntegratorMemory& memory) override {
    scale_.remember(memory);
    usual_ratio_ = memory.usual_ratio;
  }
  /// Not known: errors of phase add up.
  void add_error(std::span<double> error) const override {
    std::fill(error.begin(), error.end(), std::numeric_limits<double>::quiet_NaN());
  }
  std::span<const double> accelerations() const override {
    return std::span(slope_).subspan(motion_.coordinates(), motion_.coordinates());
  }
  double rate() const override { return scale_.rate(); }

 private:
  bool solve(double h);
  void place(double h);
  double size_of(std::span<const double> change, double h, double of_place, double of_velocity, double part);
  double error_of_step(double h);
  double error_within(double h);
  double error_of_work(double h, double ratio) const;
  bool finish();
  void accept(double h, double error);
  void observe(double h);
  void begin_anew();
  bool advance_by_runge_kutta(double limit);

  AlphaOptions options_;
  ImplicitMatrix matrix_;
  ErrorScale scale_;
  double am_ = 0, af_ = 0, g_ = 0, b_ = 0;
  double h_ = 0, t_new_ = 0, last_h_ = 0, factored_h_ = 0;
  bool linearized_ = false;
  std::vector<double> y_before_, y_new_, slope_, slope_new_, slope_before_;
  std::vector<double> own_, shifted_, own_new_;  // A; the same for the length of the step that is tried
  std::vector<double> residual_;                 // [0, r_v] for the matrix
};

}  // namespace catena
