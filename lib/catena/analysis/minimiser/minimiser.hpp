// Minimisation under bounds and constraints by the methods of NLopt and by Ipopt, for functions of a few hundred
// variables at most.
//
//   min f(x)   subject to   lower <= x <= upper,   g(x) <= 0,   h(x) = 0
//
// Methods: slsqp (sequential quadratic programming, Kraft, ACM TOMS 20 (1994)) and mma (moving asymptotes, Svanberg,
// SIAM J. Optim. 12 (2002)) use gradients; bobyqa and cobyla (Powell) models through values; crs2, isres and direct
// search everywhere within the bounds. mma, bobyqa, crs2 and direct treat no equations, bobyqa, crs2 and direct no
// constraints at all: those that lack something run within an augmented Lagrangian (Birgin and Martinez, 2008), which
// has it. ipopt is the interior-point method of Waechter and Biegler, Math. Program. 106 (2006), with gradients; second
// derivatives it makes of their changes (limited-memory BFGS). Variables should be scaled to the same size. Source: S.
// Johnson, The NLopt nonlinear-optimization package.
#pragma once

#include <cstdint>
#include <limits>
#include <span>
#include <vector>

namespace catena {

enum class MinimiserMethod { slsqp, mma, ipopt, bobyqa, cobyla, crs2, isres, direct };

/// Whether a method asks for gradients.
constexpr bool uses_gradients(MinimiserMethod method) { return method <= MinimiserMethod::ipopt; }
/// Whether a method looks for designs everywhere within the bounds: it finds the best ones coarsely.
constexpr bool searches_everywhere(MinimiserMethod method) { return method >= MinimiserMethod::crs2; }

/// What is minimised. Gradients and Jacobians (row-major, a row a constraint) are wanted where their spans are not
/// empty.
class MinimisationProblem {
 public:
  virtual ~MinimisationProblem() = default;
  virtual int variables() const = 0;
  virtual int inequalities() const = 0;
  virtual int equations() const = 0;
  virtual double objective(std::span<const double> x, std::span<double> gradient) = 0;
  virtual void unequal(std::span<const double> x, std::span<double> g, std::span<double> jacobian) = 0;
  virtual void equal(std::span<const double> x, std::span<double> h, std::span<double> jacobian) = 0;
  /// Asked after every value of the objective: whether to go on.
  virtual bool go_on() { return true; }
};

struct MinimiserOptions {
  MinimiserMethod method = MinimiserMethod::slsqp;
  std::vector<double> lower = {}, upper = {};  ///< empty: none
  double x_tolerance = 0;                      ///< largest change of a variable that counts as none
  double f_tolerance = 0;                      ///< relative change of the objective that counts as none
  double constraint_tolerance = 0;             ///< what of a constraint counts as met
  int max_evaluations = 1000;
  double enough = -std::numeric_limits<double>::infinity();  ///< a value at which to stop
  std::uint64_t seed = 1;                                    ///< of methods that draw random numbers
};

enum class MinimiserEnd {
  converged,
  rounding,  ///< rounding ends the progress
  slow,      ///< max_evaluations reached
  stopped,   ///< go_on() said no
  enough,    ///< the value asked for was reached
  failed,
};

/// Whether the library was built with NLopt (CATENA_WITH_NLOPT).
bool nlopt_is_built_in();

/// Whether the library was built with what the method needs: Ipopt (CATENA_WITH_IPOPT) or NLopt.
bool minimiser_is_built_in(MinimiserMethod method);

/// Minimises from x, in place. `failed` where minimiser_is_built_in() is false.
MinimiserEnd minimise(MinimisationProblem& problem, const MinimiserOptions& options, std::span<double> x);

}  // namespace catena
