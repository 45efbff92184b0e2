#include "catena/analysis/minimiser/minimiser_parts.hpp"

#if CATENA_HAS_IPOPT

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <vector>

#include "catena/analysis/minimiser/ipopt_turn.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

using Ipopt::Index;
using Ipopt::Number;

// Ipopt takes any value beyond 1e19 as no bound.
constexpr double no_bound = 2e19;
// Ten iterates in a row whose errors are below so many tolerances end the search too: derivatives by which constraints
// are measured are good to some 1e-10, and of the dual error nothing better can be asked.
constexpr double acceptable = 100;

/// Rows of constraints: the unequal ones first, then the equal ones; Jacobians dense.
class Problem final : public Ipopt::TNLP {
 public:
  Problem(MinimisationProblem& problem, const MinimiserOptions& options, std::span<double> x)
      : problem_(problem),
        options_(options),
        x_(x),
        unequal_(at(problem.inequalities())),
        equal_(at(problem.equations())),
        jacobian_((unequal_.size() + equal_.size()) * x.size()) {}

  bool was_stopped() const { return stopped_; }
  bool ran_out() const { return evaluations_ >= options_.max_evaluations; }
  bool has_enough() const { return enough_; }

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    n = static_cast<Index>(x_.size());
    m = static_cast<Index>(unequal_.size() + equal_.size());
    jacobian = static_cast<Index>(jacobian_.size());
    hessian = 0;
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* low, Number* high, Index m, Number* g_low, Number* g_high) override {
    for (Index v = 0; v < n; ++v) {
      low[v] = options_.lower.empty() ? -no_bound : options_.lower[at(v)];
      high[v] = options_.upper.empty() ? no_bound : options_.upper[at(v)];
    }
    for (Index k = 0; k < m; ++k) {
      g_low[k] = at(k) < unequal_.size() ? -no_bound : 0;
      g_high[k] = 0;
    }
    return true;
  }
  bool get_starting_point(Index, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) override {
    std::copy(x_.begin(), x_.end(), x);
    return true;
  }
  bool eval_f(Index n, const Number* x, bool, Number& f) override {
    ++evaluations_;
    f = problem_.objective({x, at(n)}, {});
    stopped_ = stopped_ || !problem_.go_on();
    enough_ = enough_ || f <= options_.enough;
    return std::isfinite(f);
  }
  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    problem_.objective({x, at(n)}, {gradient, at(n)});
    return true;
  }
  bool eval_g(Index n, const Number* x, bool, Index, Number* g) override {
    if (!unequal_.empty()) problem_.unequal({x, at(n)}, unequal_, {});
    if (!equal_.empty()) problem_.equal({x, at(n)}, equal_, {});
    std::copy(equal_.begin(), equal_.end(), std::copy(unequal_.begin(), unequal_.end(), g));
    return true;
  }
  bool eval_jac_g(Index n, const Number* x, bool, Index, Index entries, Index* rows, Index* columns,
                  Number* values) override {
    for (Index k = 0; k < entries && !values; ++k) {
      rows[k] = k / n;
      columns[k] = k % n;
    }
    if (!values) return true;
    const std::span<double> all(jacobian_);
    const std::size_t split = unequal_.size() * at(n);
    if (!unequal_.empty()) problem_.unequal({x, at(n)}, unequal_, all.first(split));
    if (!equal_.empty()) problem_.equal({x, at(n)}, equal_, all.subspan(split));
    std::copy(jacobian_.begin(), jacobian_.end(), values);
    return true;
  }
  bool intermediate_callback(Ipopt::AlgorithmMode, Index, Number, Number, Number, Number, Number, Number, Number,
                             Number, Index, const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) override {
    return !stopped_ && !enough_ && !ran_out();
  }
  void finalize_solution(Ipopt::SolverReturn, Index n, const Number* x, const Number*, const Number*, Index,
                         const Number*, const Number*, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    std::copy(x, x + n, x_.begin());
  }

 private:
  MinimisationProblem& problem_;
  const MinimiserOptions& options_;
  std::span<double> x_;
  std::vector<double> unequal_, equal_, jacobian_;
  int evaluations_ = 0;
  bool stopped_ = false, enough_ = false;
};

MinimiserEnd ending(Ipopt::ApplicationReturnStatus status, const Problem& problem) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
    case Ipopt::Solved_To_Acceptable_Level:
    case Ipopt::Infeasible_Problem_Detected:  // at the least infeasible place: whose constraints tell
      return MinimiserEnd::converged;
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return MinimiserEnd::rounding;
    case Ipopt::Maximum_Iterations_Exceeded:
      return MinimiserEnd::slow;
    case Ipopt::User_Requested_Stop:
      return problem.has_enough()    ? MinimiserEnd::enough
             : problem.was_stopped() ? MinimiserEnd::stopped
                                     : MinimiserEnd::slow;
    default:
      return MinimiserEnd::failed;
  }
}

}  // namespace

bool ipopt_minimiser_is_built_in() { return true; }

MinimiserEnd minimise_by_ipopt(MinimisationProblem& problem, const MinimiserOptions& options, std::span<double> x) {
  const std::lock_guard turn(ipopt_turn());
  const Ipopt::SmartPtr<Problem> own = new Problem(problem, options, x);
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  Ipopt::OptionsList& set = *application->Options();
  set.SetStringValue("sb", "yes");
  set.SetStringValue("linear_solver", "mumps");
  set.SetStringValue("nlp_scaling_method", "none");
  set.SetStringValue("hessian_approximation", "limited-memory");
  set.SetStringValue("fixed_variable_treatment", "make_parameter");
  set.SetNumericValue("bound_relax_factor", 0);
  set.SetIntegerValue("max_iter", options.max_evaluations);
  if (options.x_tolerance > 0) {
    set.SetNumericValue("tol", options.x_tolerance);
    set.SetNumericValue("acceptable_tol", acceptable * options.x_tolerance);
    set.SetIntegerValue("acceptable_iter", 10);
  }
  if (options.constraint_tolerance > 0) set.SetNumericValue("constr_viol_tol", options.constraint_tolerance);
  if (application->Initialize() != Ipopt::Solve_Succeeded) return MinimiserEnd::failed;
  return ending(application->OptimizeTNLP(own), *own);
}

}  // namespace catena

#else

namespace catena {

bool ipopt_minimiser_is_built_in() { return false; }

MinimiserEnd minimise_by_ipopt(MinimisationProblem&, const MinimiserOptions&, std::span<double>) {
  return MinimiserEnd::failed;
}

}  // namespace catena

#endif
