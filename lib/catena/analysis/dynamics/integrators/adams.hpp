// Adams methods of variable order (1 ... 12) and step for a constrained motion: predict, evaluate, correct, project,
// evaluate. Two evaluations a step, whatever the order.
//
// Only accelerations are kept as differences; positions are their double integral (a method for equations of second
// order), velocities and the integrals that ride along the single one. The corrector is of one order more than the
// predictor. Projection, error filter and the scale of errors are those of RungeKutta. Order and step are chosen as in
// Shampine and Gordon's program STEP: orders k-2 ... k+1 are compared, steps are doubled, or cut when they must be, so
// that equal steps are the rule. A start is of order 1, with steps that double while the order rises.
//
// A polynomial through many accelerations cannot be trusted near singular positions, where the error of each depends on
// its distance from them: when the pivots fall RungeKutta takes the steps until the position is passed.
// With a fixed step RungeKutta makes the first ones, then the order is 8.
#pragma once

#include <algorithm>

#include "catena/analysis/dynamics/integrators/adams_history.hpp"
#include "catena/analysis/dynamics/integrators/crossing_integrator.hpp"

namespace catena {

class Adams final : public CrossingIntegrator {
 public:
  /// `options`: the order does not count.
  Adams(Motion motion, const RungeKuttaOptions& options);

  bool start(double t, std::span<const double> y) override;
  bool advance(double limit) override;
  /// By the polynomial of the last step, one order above the predictor's.
  void interpolate(double t, std::span<double> y) override;
  /// Its differences are not included: an integrator that takes over this memory starts with a short step of order 1.
  IntegratorMemory memory() const override;
  void remember(const IntegratorMemory& memory) override;
  void add_error(std::span<double> error) const override;
  std::span<const double> accelerations() const override {
    return std::span(slope_).subspan(motion_.coordinates(), motion_.coordinates());
  }
  double rate() const override { return scale_.rate(); }

 private:
  // Order k of a predictor: the corrector and the estimates take difference k + 1, of k + 2 instants.
  static constexpr std::size_t most = AdamsHistory::most - 2;

  /// Estimates at orders k, k - 1 and k - 2, compared with what is allowed.
  struct Errors {
    double now = 0, below = 0, far_below = 0;
    bool favour_lower(std::size_t k) const {
      return k > 2 ? std::max(below, far_below) <= now : k == 2 && below <= 0.5 * now;
    }
  };
  void forget();
  bool advance_by_runge_kutta(double limit);
  bool try_step(double h, double remaining);
  void predict(double h);
  double weight(std::size_t c, double h) const;
  Errors estimate(double h);
  double error_of_step(double h);
  double error_within(double h);
  double weight_of_work(std::size_t place, double h) const;
  double error_of_work(double h) const;
  double estimate_above(double h) const;
  double filtered(double h, double raw);
  bool finish(double h);
  void update(double h);
  void choose(double h, const Errors& errors, bool lower, double above);
  double compared_with_end(double h, double error);
  void fail(double h, double error, bool lower);

  RungeKuttaOptions options_;
  ErrorScale scale_;
  AdamsHistory history_;
  AdamsHistory::Weights weights_, inside_;
  std::size_t k_ = 1, k_before_ = 0;  // order of the predictor; of the last step's
  double h_ = 0, t_new_ = 0;
  bool starting_ = true;
  int failures_ = 0;
  std::vector<std::vector<double>> difference_;  // of [qdd, power], numbered from 1
  std::vector<double> y_new_, slope_, unseen_;
  std::vector<double> predicted_, change_;  // [qdd, power]; what was evaluated less what was predicted
};

}  // namespace catena
