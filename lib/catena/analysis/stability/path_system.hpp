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
// lengths, places. Beside forces without a potential K is unsymmetric and factored as it is (static_tangent.hpp), and
// the kind of a point follows from its small motions (circulatory_modes.hpp), up to 500 degrees of freedom; without
// masses in the metric of lengths, in which pairs of complex values mean nothing. Source: H. Keller, Lectures on
// Numerical Methods in Bifurcation Problems, 1987, chapters 4 and 5.
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"
#include "catena/analysis/spectrum/circulatory_modes.hpp"

namespace catena {

/// The model at a value of the parameter, of the same structure always; nullptr where the scene has none.
using ModelAt = std::function<std::shared_ptr<const Model>(double)>;

/// A point of a path, or a direction: configurations in plan order relative to the origins of the first model.
struct PathPoint {
  std::vector<double> q;       ///< coordinates(); of a direction: columns
  std::vector<double> lambda;  ///< rows
  double p = 0;
};

/// How many motions of a point of a path are unstable.
struct PathStability {
  int negative = 0;  ///< values below zero
  int pairs = 0;     ///< of complex ones, beside forces without a potential

  bool operator==(const PathStability&) const = default;
};

/// Of a step, or of the parameter's range: so far beside a point a path is looked at. Effects are above rounding there,
/// the bend of the path below it.
inline constexpr double beside_point = 1e-6;
/// Where no longer step can be made the path ends, and corners are located to this; in the units of beside_point.
inline constexpr double shortest_arc = 1e-9;

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
  /// Of the point factored last; nothing where its spectrum is not found.
  std::optional<PathStability> stability();
  /// Whether there are forces without a potential.
  bool is_circulatory() const { return tangent_.has_value(); }
  /// The spectrum at a point, to which the system moves. False where there is none.
  bool spectrum(const PathPoint& x, CirculatoryModes& found);
  /// Why the spectrum says nothing of flutter; empty where it does. Of the last spectrum.
  const std::string& lack_of_masses() const { return lack_of_masses_; }
  /// columns + rows: w of w^T [K, Phi_q^T; Phi_q, 0] = 0, with the factors of a matrix that is nearly singular.
  std::vector<double> left_null_vector();

  /// Derivatives of the residual by the parameter at x, columns + rows. Leaves the system at x.
  void parameter_derivative(const PathPoint& x, std::vector<double>& derivative);
  /// Direction of the path at x, where factorize() was; of length 1, <previous, t> positive.
  PathPoint tangent(const PathPoint& x, const PathPoint& previous);
  /// Corrects x until it solves the equations with <t, x - from> = s. Returns the iterations needed, or -1.
  int correct(PathPoint& x, const PathPoint& from, const PathPoint& t, double s);
  /// The value of the parameter at which the scene has no model and correct() gave up, the last one since
  /// forget_refused_value().
  std::optional<double> refused_value() const { return refused_value_; }
  void forget_refused_value() { refused_value_.reset(); }
  /// x + s t.
  PathPoint advanced(const PathPoint& x, const PathPoint& t, double s) const;

  /// <t, x - from>.
  double way(const PathPoint& from, const PathPoint& x, const PathPoint& t) const;
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
  /// Fills and factors the matrix where the system is; `shift` N/m.
  bool factorize_here(std::span<const double> lambda, double shift);
  double largest_stiffness() const;
  void residual(const PathPoint& x, std::vector<double>& out);
  /// Of differences by the parameter at x; `closely`: the shortest.
  double parameter_step(const PathPoint& x, bool closely) const;
  double difference_over(const PathPoint& x, double h, std::vector<double>& derivative);
  bool find_newton_step(const PathPoint& x, const PathPoint& t, double place, bool closely, double& dp);
  void make_newton_step(PathPoint& x, double dp) const;

  StaticSystem& system_;
  Evaluator& evaluator_;
  const Plan& plan_;
  ModelAt model_at_;
  std::shared_ptr<const Model> model_;
  std::array<std::pair<double, std::shared_ptr<const Model>>, 3> models_{};  // the last ones
  std::size_t next_model_ = 0;
  std::optional<double> refused_value_;
  double p_, scale_, time_, extent_ = 1;
  std::optional<StaticTangent> tangent_, spectrum_tangent_;
  std::string lack_of_masses_;
  PathPoint factored_;  // where there are forces without a potential
  std::vector<Vec2<double>> first_origin_;
  std::vector<double> weight_, placed_, correction_, given_, newton_, along_, derivative_, side_, here_;
};

}  // namespace catena
