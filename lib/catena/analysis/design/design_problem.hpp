// A design problem: numbers of a mechanism that may be chosen, what is to be least, and what must hold.
//
//   min f(x)   subject to   lower <= x <= upper,   g(x) <= 0,   h(x) = 0
//
// evaluate() analyses a design. One that cannot be analysed (does not assemble, locks, buckles) is data: it has a
// reason in place of values, and the search goes on; so has one whose values are not numbers (`not_finite`), or whose
// gradients are not where the method uses them (`no_derivative`). Objective and constraints may be anything that a
// mechanism's numbers decide.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/minimiser/minimiser.hpp"

namespace catena {

/// Objective and constraints of a design with their gradients by its variables: gradient, then a row a constraint.
struct DesignValues {
  double objective = 0;
  std::vector<double> unequal, equal;  ///< g, wanted <= 0; h, wanted = 0
  std::vector<double> gradient, unequal_gradient, equal_gradient;
};

struct DesignEvaluation {
  std::string failure;  ///< empty: it could be analysed; else the status or reason, as a word
  DesignValues values;
};

struct DesignProblem {
  std::vector<double> lower, upper, start;  ///< one a variable; lower < upper
  int inequalities = 0, equations = 0;
  using Evaluate = std::function<DesignEvaluation(std::span<const double> x, bool gradients)>;
  Evaluate evaluate;
  /// In place of it: what one search analyses its designs with, one after the other, so that it may remember.
  std::function<Evaluate()> begin_search = {};
};

struct DesignOptions {
  MinimiserMethod method = MinimiserMethod::slsqp;
  int starts = 1;  ///< the given one, then random ones within the bounds
  int threads =
      1;  ///< that starts may use, and so call `evaluate` at once; what comes of it is the same for any number
  std::uint64_t seed = 1;
  double tolerance = 1e-8;  ///< of variables, in parts of their ranges, and of constraints, in their sizes at the start
  int max_evaluations = 1000;
  std::function<bool()> go_on = {};  ///< asked after every design, by any thread; false keeps the best so far
  /// Told of every design that is better than all before: of each start in turn, by one thread at a time.
  std::function<void(std::span<const double> x, const DesignValues&)> improved = {};
};

enum class DesignEnd {
  converged,
  slow,            ///< max_evaluations reached
  broken_off,      ///< the method came to an end of its own without an optimum
  not_stationary,  ///< the method counted itself done, but a short step from the best design leads to a better one
  cancelled,
  infeasible,
  failed,  ///< no design could be analysed
};

struct DesignOutcome {
  DesignEnd end = DesignEnd::failed;
  std::vector<double> x;  ///< the best design; where the constraints cannot be met, the least infeasible
  DesignValues values;
  double violation = 0;              ///< largest of its constraints, in their sizes at the start
  std::optional<double> optimality;  ///< see optimality_of(); nothing where the gradients there are not known
  bool at_kink = false;  ///< converged where gradients do not vanish, but short steps along them lead to nothing better
  bool is_constant = false;             ///< the objective was the same in all designs, and variables do not change it
  std::vector<int> active_unequal;      ///< inequalities that hold it
  std::vector<int> at_lower, at_upper;  ///< variables at their bounds
  int evaluations = 0;                  ///< designs that were analysed, failed ones included
  std::map<std::string, int> failed;    ///< how many, by reason
};

/// Searches for the best design.
DesignOutcome optimise_design(const DesignProblem& problem, const DesignOptions& options);

/// How far a design is from a stationary one: the norm of f_x + sum mu g_x + sum nu h_x + bounds, with the multipliers
/// (mu >= 0) that make it least, relative to the largest of its terms and of `size`. Derivatives by variables in parts
/// of their ranges. Zero at a minimum. `rest`: that sum, whose opposite leads downhill along the active constraints.
struct Stationarity {
  double optimality = 0;
  std::vector<int> active_unequal;
  std::vector<double> rest;
};
Stationarity optimality_of(const DesignProblem& problem, std::span<const double> x, const DesignValues& values,
                           std::span<const double> unequal_size, double size);

}  // namespace catena
