#include "catena/analysis/minimiser/minimiser_parts.hpp"

#if CATENA_HAS_NLOPT

#include <nlopt.h>

#include <algorithm>
#include <memory>

namespace catena {
namespace {

struct Destroy {
  void operator()(nlopt_opt_s* optimiser) const { nlopt_destroy(optimiser); }
};
using Optimiser = std::unique_ptr<nlopt_opt_s, Destroy>;

nlopt_algorithm algorithm_of(MinimiserMethod method) {
  switch (method) {
    case MinimiserMethod::slsqp:
      return NLOPT_LD_SLSQP;
    case MinimiserMethod::mma:
      return NLOPT_LD_MMA;
    case MinimiserMethod::ipopt:
      break;  // never asked for here
    case MinimiserMethod::bobyqa:
      return NLOPT_LN_BOBYQA;
    case MinimiserMethod::cobyla:
      return NLOPT_LN_COBYLA;
    case MinimiserMethod::crs2:
      return NLOPT_GN_CRS2_LM;
    case MinimiserMethod::isres:
      return NLOPT_GN_ISRES;
    case MinimiserMethod::direct:
      return NLOPT_GN_DIRECT_L;
  }
  return NLOPT_LD_SLSQP;
}

/// Whether the method needs help with the constraints of the problem.
bool lacks_constraints(MinimiserMethod method, const MinimisationProblem& problem) {
  if (method == MinimiserMethod::mma) return problem.equations() > 0;
  const bool none =
      method == MinimiserMethod::bobyqa || method == MinimiserMethod::crs2 || method == MinimiserMethod::direct;
  return none && problem.equations() + problem.inequalities() > 0;
}

/// The problem and the optimiser that is to be stopped, as the callbacks get them.
struct Call {
  MinimisationProblem& problem;
  nlopt_opt optimiser = nullptr;

  static std::span<double> wanted(double* values, std::size_t size) {
    return values ? std::span<double>(values, size) : std::span<double>();
  }
  static double objective(unsigned n, const double* x, double* gradient, void* self) {
    Call& call = *static_cast<Call*>(self);
    const double value = call.problem.objective({x, n}, wanted(gradient, n));
    if (!call.problem.go_on()) nlopt_force_stop(call.optimiser);
    return value;
  }
  static void unequal(unsigned m, double* g, unsigned n, const double* x, double* jacobian, void* self) {
    static_cast<Call*>(self)->problem.unequal({x, n}, {g, m}, wanted(jacobian, std::size_t{m} * n));
  }
  static void equal(unsigned m, double* h, unsigned n, const double* x, double* jacobian, void* self) {
    static_cast<Call*>(self)->problem.equal({x, n}, {h, m}, wanted(jacobian, std::size_t{m} * n));
  }
};

void set_limits(nlopt_opt optimiser, const MinimiserOptions& options) {
  if (!options.lower.empty()) nlopt_set_lower_bounds(optimiser, options.lower.data());
  if (!options.upper.empty()) nlopt_set_upper_bounds(optimiser, options.upper.data());
  if (options.x_tolerance > 0) nlopt_set_xtol_abs1(optimiser, options.x_tolerance);
  if (options.f_tolerance > 0) nlopt_set_ftol_rel(optimiser, options.f_tolerance);
  nlopt_set_maxeval(optimiser, options.max_evaluations);
}

MinimiserEnd ending(nlopt_result result) {
  switch (result) {
    case NLOPT_STOPVAL_REACHED:
      return MinimiserEnd::enough;
    case NLOPT_MAXEVAL_REACHED:
      return MinimiserEnd::slow;
    case NLOPT_FORCED_STOP:
      return MinimiserEnd::stopped;
    case NLOPT_ROUNDOFF_LIMITED:
      return MinimiserEnd::rounding;
    default:
      return result > 0 ? MinimiserEnd::converged : MinimiserEnd::failed;
  }
}

}  // namespace

bool nlopt_is_built_in() { return true; }

MinimiserEnd minimise_by_nlopt(MinimisationProblem& problem, const MinimiserOptions& options, std::span<double> x) {
  const auto n = static_cast<unsigned>(problem.variables());
  Call call{problem};
  const bool helped = lacks_constraints(options.method, problem);
  const nlopt_algorithm own = algorithm_of(options.method);
  const Optimiser outer(nlopt_create(!helped                          ? own
                                     : uses_gradients(options.method) ? NLOPT_LD_AUGLAG
                                                                      : NLOPT_LN_AUGLAG,
                                     n));
  call.optimiser = outer.get();
  nlopt_srand(static_cast<unsigned long>(options.seed));
  nlopt_set_min_objective(outer.get(), &Call::objective, &call);
  const std::vector<double> close(static_cast<std::size_t>(std::max(problem.equations(), problem.inequalities())),
                                  options.constraint_tolerance);
  if (problem.equations() > 0) {
    nlopt_add_equality_mconstraint(outer.get(), static_cast<unsigned>(problem.equations()), &Call::equal, &call,
                                   close.data());
  }
  if (problem.inequalities() > 0) {
    nlopt_add_inequality_mconstraint(outer.get(), static_cast<unsigned>(problem.inequalities()), &Call::unequal, &call,
                                     close.data());
  }
  set_limits(outer.get(), options);
  nlopt_set_stopval(outer.get(), options.enough);
  if (helped) {
    const Optimiser inner(nlopt_create(own, n));
    set_limits(inner.get(), options);
    nlopt_set_local_optimizer(outer.get(), inner.get());
  }
  double value = 0;
  return ending(nlopt_optimize(outer.get(), x.data(), &value));
}

}  // namespace catena

#else

namespace catena {

bool nlopt_is_built_in() { return false; }

MinimiserEnd minimise_by_nlopt(MinimisationProblem&, const MinimiserOptions&, std::span<double>) {
  return MinimiserEnd::failed;
}

}  // namespace catena

#endif
