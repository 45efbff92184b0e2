// Radau IIA of three stages, order 5: the implicit method for motions with stiff springs, bushings and dampers, whose
// steps are as long as the motion allows, not as the fastest vibration would.
//
//   Z_i = h sum_j a_ij f(t + c_j h, y + Z_j),   y1 = y + Z_3        c = (4 - sqrt 6)/10, (4 + sqrt 6)/10, 1
//
// f is that of the other methods, [qd, qdd] with the multipliers of the same instant, so that nothing of the mechanics
// is repeated here; y1 is projected onto the constraints. Newton's method solves for all Z at once with one matrix,
// that of implicit_matrix.hpp: in the basis in which A^-1 is diagonal the stages part into one real and one complex
// system of the size of the mechanism. The matrix is kept while it converges well, its factors while the step keeps its
// length. The first guess is the polynomial of the step before.
//
// Estimate of a step's error: e = (g I / h - J)^-1 (f(y) + (e_1 Z_1 + e_2 Z_2 + e_3 Z_3) / h), of order 3 and damped in
// stiff directions. The error itself, of order 5, goes with e^(5/4) then: a tolerance x is one of 1.5 x^(4/5) of e.
// Where steps have to be repeated the motion is not smooth enough for that, and e is held to the tolerance itself. The
// integrals that ride along (motion.hpp) have no part in Newton's method: they are summed up with the same weights.
// Across singular positions RungeKutta takes the steps, as it does for Adams. Friction that is mu times a multiplier
// has no part in the matrix: smoothed, with mu = 0.3 on the guides beside a damped spring of 1e7 N/m, the evaluations
// of 339 steps without friction became 4 % more. Source: E. Hairer, G. Wanner, Solving Ordinary Differential Equations
// II, IV.8; K. Gustafsson, ACM TOMS 20 (1994) for the choice of steps.
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "catena/analysis/dynamics/implicit/implicit_matrix.hpp"
#include "catena/analysis/dynamics/implicit/implicit_step.hpp"
#include "catena/analysis/dynamics/integrators/crossing_integrator.hpp"

namespace catena {

/// A^-1 = T L T^-1 with L = [g, 0, 0; 0, a, -b; 0, b, a], and what else makes the method.
struct RadauTableau {
  using Matrix = std::array<std::array<double, 3>, 3>;
  std::array<double, 3> c{}, error{};
  Matrix a{}, inverse{}, basis{}, basis_inverse{};
  double real = 0, pair_real = 0, pair_imaginary = 0;  ///< g, a, b
};
const RadauTableau& radau_tableau();

class Radau final : public CrossingIntegrator {
 public:
  /// `options`: those of Runge-Kutta, whose order and way of keeping constraints do not count.
  Radau(Motion motion, const RungeKuttaOptions& options);

  bool start(double t, std::span<const double> y) override;
  bool advance(double limit) override;
  /// By both ends of the step and their accelerations, of order 5; beside what dies away within it by the polynomial of
  /// the stages, of order 3, as good as the estimate of the error.
  void interpolate(double t, std::span<double> y) override;
  IntegratorMemory memory() const override { return memory_of(scale_, h_); }
  void remember(const IntegratorMemory& memory) override;
  /// Not known: the estimate is of two orders less than the step.
  void add_error(std::span<double> error) const override {
    std::fill(error.begin(), error.end(), std::numeric_limits<double>::quiet_NaN());
  }
  std::span<const double> accelerations() const override {
    return std::span(slope_).subspan(motion_.coordinates(), motion_.coordinates());
  }
  double rate() const override { return scale_.rate(); }

 private:
  // Corrections of all stages: a matrix that needs more is not worth its step. Speed of convergence below which it
  // serves the next step as well. Both by Hairer and Wanner.
  static constexpr int most_corrections = 7;
  static constexpr double keeps_matrix = 1e-3;
  enum class Newton { converged, slow, failed };
  enum class Smooth { unknown, yes, no };
  void forget();
  void predict(double h);
  bool linearize(double h);
  bool prepare(double h);
  Newton solve_stages(double h);
  bool correct(double h, double& change);
  double size_of(std::span<const double> change, double h, double part);
  double error_of_step(double h);
  void sum_up_work(double h);
  double error_of_work(double h) const;
  bool finish();
  void accept(double h, double error);
  void reject(double h, double error);
  void observe(double h);
  bool is_smooth();
  implicit_step::Ends ends() const { return {t_before_, t_, y_before_, y_, slope_before_, slope_}; }
  bool advance_by_runge_kutta(double limit);

  RungeKuttaOptions options_;
  ImplicitMatrix matrix_;
  ErrorScale scale_;
  double h_ = 0, t_new_ = 0, factored_h_ = 0, last_h_ = 0, last_error_ = 0;
  struct {
    bool linearized = false, fresh = false, has_stages = false, rejected = false, first = true;
  } is_;
  Smooth smooth_ = Smooth::unknown;  // the last step
  StepSwitches::Found switches_;     // in the step that is tried
  double convergence_ = 0;
  int corrections_ = 0;
  std::array<std::vector<double>, 3> z_, last_z_, f_, residual_;  // of the stages; of the step before
  std::vector<double> y_before_, y_new_, y_stage_, slope_, slope_before_, error_;
};

}  // namespace catena
