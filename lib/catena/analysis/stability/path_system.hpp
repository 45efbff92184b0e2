// The equations of static equilibrium with a parameter of the scene as one more unknown, and one more equation that
// determines the place of the point on the path (Keller's pseudo-arc-length).
//
//   V_q + Phi_q^T lambda = 0,   Phi = 0,   <t, x - x0> = s        x = (q, lambda, p)
//   <a, b> = mean_bodies (a_r . b_r / extent^2 + radius^2 a_phi b_phi / length^2) + a_p b_p / scale^2
//
// so that s is a number: root mean square travel of the bodies in parts of the mechanism's extent (RMS distance of the
// given places from their middle, or the length scale where that is more), the parameter in parts of its range. Solved
// by Newton's method with the factorization of equilibrium, two solutions an iteration. The derivative by p is a
// difference of the residual over 1e-5 of the parameter's range: it affects the convergence only, since the residual
// itself decides whether a point is solved. A parameter may change anything but the structure: loads, stiffnesses,
// lengths, places. Source: H. Keller, Lectures on Numerical Methods in Bifurcation Problems, 1987, chapters 4 and 5.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"

namespace catena {

/// The model at a value of the parameter, of the same structure always; nullptr where the scene has none.
using ModelAt = std::function<std::shared_ptr<const Model>(double)>;

/// A point of a path, or a direction: configurations in plan order relative to the origins of the first model.
struct PathPoint {
  std::vector<double> q;       ///< coordinates(); of a direction: columns
  std::vector<double> lambda;  ///< rows
  double p = 0;
};

class PathSystem {
 public:
  /// `p`: the present value; `scale`: size of the range of the parameter, not zero. The system is at the model of p.
  PathSystem(StaticSystem& system, ModelAt model_at, double p, double scale);

  /// The instant at which functions of time are frozen.
  void set_time(double t) { time_ = t; }
  /// Takes the model at x.p and moves the system to x. False, and nothing done, if there is no model at x.p.
  bool move_to(const PathPoint& x);
  /// The configuration of a point with the origins of its own model, as evaluator and columns need it: after move_to.
  std::span<const double> q() const { return placed_; }
  /// Factors the exact matrix at x, to which it moves. False where a pivot vanishes or there is no model.
  bool factorize(const PathPoint& x);
  /// Negative modes of the matrix factored last.
  int negative_modes() { return system_.matrix().negative_modes(); }

  /// Derivatives of the residual by the parameter at x, columns + rows. Leaves the system at x.
  void parameter_derivative(const PathPoint& x, std::vector<double>& derivative);
  /// Direction of the path at x, where factorize() was; of length 1, <previous, t> positive.
  PathPoint tangent(const PathPoint& x, const PathPoint& previous);
  /// Corrects x until it solves the equations with <t, x - from> = s. Returns the iterations needed, or -1.
  int correct(PathPoint& x, const PathPoint& from, const PathPoint& t, double s);
  /// x + s t.
  PathPoint advanced(const PathPoint& x, const PathPoint& t, double s) const;

  /// <a, b> of two directions.
  double product(const PathPoint& a, const PathPoint& b) const;
  /// The direction along the parameter alone, of length 1 to the side of `sign`.
  PathPoint along_parameter(double sign) const;
  /// Solves with the factors for columns + rows, refined.
  void solve(std::span<const double> given, std::span<double> x);
  /// Weights of the columns in <a, b>.
  std::span<const double> weight() const { return weight_; }
  StaticSystem& statics() { return system_; }

 private:
  bool set_parameter(double p);
  void residual(const PathPoint& x, std::vector<double>& out);

  StaticSystem& system_;
  Evaluator& evaluator_;
  const Plan& plan_;
  ModelAt model_at_;
  std::shared_ptr<const Model> model_;
  std::array<std::pair<double, std::shared_ptr<const Model>>, 3> models_{};  // the last ones
  std::size_t next_model_ = 0;
  double p_, scale_, time_, extent_ = 1;
  std::vector<Vec2<double>> first_origin_;
  std::vector<double> weight_, placed_, correction_, given_, newton_, along_, derivative_, side_;
};

}  // namespace catena
