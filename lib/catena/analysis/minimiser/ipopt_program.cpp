#include "catena/analysis/minimiser/ipopt_program.hpp"

#if CATENA_HAS_IPOPT

#include <IpIpoptApplication.hpp>
#include <IpTNLP.hpp>
#include <algorithm>
#include <cmath>
#include <mutex>

#include "catena/base/at.hpp"

namespace catena {
namespace {

using Ipopt::Index;
using Ipopt::Number;

// Of the complementarity at a warm start.
constexpr double near_barrier = 1e-9;

std::recursive_mutex& turn() {
  static std::recursive_mutex mutex;
  return mutex;
}

class Adapter final : public Ipopt::TNLP {
 public:
  explicit Adapter(IpoptProgram& program) : program_(program) {}

  bool get_nlp_info(Index& n, Index& m, Index& jacobian, Index& hessian, IndexStyleEnum& style) override {
    const IpoptProgram::Size size = program_.size();
    n = size.variables, m = size.rows, jacobian = size.jacobian, hessian = std::max(size.hessian, 0);
    style = C_STYLE;
    return true;
  }
  bool get_bounds_info(Index n, Number* x_low, Number* x_high, Index m, Number* g_low, Number* g_high) override {
    program_.bounds({x_low, at(n)}, {x_high, at(n)}, {g_low, at(m)}, {g_high, at(m)});
    return true;
  }
  bool get_starting_point(Index n, bool, Number* x, bool bounds, Number* low, Number* high, Index m, bool multipliers,
                          Number* lambda) override {
    program_.start({x, at(n)}, multipliers ? std::span<double>(lambda, at(m)) : std::span<double>());
    if (bounds) {
      std::fill(low, low + n, 0.0);
      std::fill(high, high + n, 0.0);
    }
    return true;
  }
  bool eval_f(Index, const Number* x, bool, Number& f) override {
    f = program_.objective(x);
    return std::isfinite(f);
  }
  bool eval_grad_f(Index n, const Number* x, bool, Number* gradient) override {
    program_.gradient(x, {gradient, at(n)});
    return true;
  }
  bool eval_g(Index, const Number* x, bool, Index m, Number* g) override {
    program_.rows(x, {g, at(m)});
    double sum = 0;
    for (Index k = 0; k < m; ++k) sum += g[k];
    return std::isfinite(sum);
  }
  bool eval_jac_g(Index, const Number* x, bool, Index, Index entries, Index* rows, Index* columns,
                  Number* values) override {
    if (values) {
      program_.jacobian(x, {values, at(entries)});
      return true;
    }
    for (Index k = 0; k < entries; ++k) place(program_.jacobian_place(k), rows[k], columns[k]);
    return true;
  }
  bool eval_h(Index, const Number* x, bool, Number factor, Index, const Number* lambda, bool, Index entries,
              Index* rows, Index* columns, Number* values) override {
    if (values) {
      program_.hessian(x, factor, lambda, {values, at(entries)});
      return true;
    }
    for (Index k = 0; k < entries; ++k) place(program_.hessian_place(k), rows[k], columns[k]);
    return true;
  }
  bool intermediate_callback(Ipopt::AlgorithmMode, Index iteration, Number, Number, Number, Number, Number, Number,
                             Number, Number, Index, const Ipopt::IpoptData*,
                             Ipopt::IpoptCalculatedQuantities*) override {
    return program_.go_on(iteration);
  }
  void finalize_solution(Ipopt::SolverReturn, Index, const Number* x, const Number*, const Number*, Index,
                         const Number*, const Number* lambda, Number, const Ipopt::IpoptData*,
                         Ipopt::IpoptCalculatedQuantities*) override {
    program_.finish(x, lambda);
  }

 private:
  static void place(const IpoptProgram::Place& from, Index& row, Index& column) {
    row = from.row;
    column = from.column;
  }
  IpoptProgram& program_;
};

IpoptEnd ending(Ipopt::ApplicationReturnStatus status) {
  switch (status) {
    case Ipopt::Solve_Succeeded:
      return IpoptEnd::solved;
    case Ipopt::Solved_To_Acceptable_Level:
      return IpoptEnd::acceptable;
    case Ipopt::Infeasible_Problem_Detected:
      return IpoptEnd::infeasible;
    case Ipopt::Diverging_Iterates:
      return IpoptEnd::diverging;
    case Ipopt::Search_Direction_Becomes_Too_Small:
      return IpoptEnd::tiny_steps;
    case Ipopt::Maximum_Iterations_Exceeded:
      return IpoptEnd::slow;
    case Ipopt::User_Requested_Stop:
      return IpoptEnd::stopped;
    default:
      return IpoptEnd::failed;
  }
}

void apply(const IpoptSettings& settings, bool has_hessian, Ipopt::OptionsList& set) {
  set.SetStringValue("sb", "yes");
  set.SetStringValue("nlp_scaling_method", "none");
  set.SetStringValue("linear_solver", "mumps");
  set.SetStringValue("fixed_variable_treatment", "make_parameter");
  if (!has_hessian) set.SetStringValue("hessian_approximation", "limited-memory");
  set.SetIntegerValue("max_iter", settings.max_iterations);
  set.SetNumericValue("tol", settings.tolerance);
  set.SetNumericValue("acceptable_tol", settings.acceptable * settings.tolerance);
  set.SetIntegerValue("acceptable_iter", settings.acceptable_iterations);
  if (settings.constraint_tolerance > 0) set.SetNumericValue("constr_viol_tol", settings.constraint_tolerance);
  if (settings.relaxed_bounds >= 0) set.SetNumericValue("bound_relax_factor", settings.relaxed_bounds);
  if (!settings.warm) return;
  set.SetStringValue("warm_start_init_point", "yes");
  set.SetNumericValue("mu_init", near_barrier);
  set.SetNumericValue("warm_start_bound_push", near_barrier);
  set.SetNumericValue("warm_start_slack_bound_push", near_barrier);
  set.SetNumericValue("warm_start_mult_bound_push", near_barrier);
}

}  // namespace

bool ipopt_program_is_built_in() { return true; }

IpoptEnd run_ipopt(IpoptProgram& program, const IpoptSettings& settings) {
  const std::lock_guard lock(turn());
  const Ipopt::SmartPtr<Ipopt::TNLP> adapter = new Adapter(program);
  const Ipopt::SmartPtr<Ipopt::IpoptApplication> application = new Ipopt::IpoptApplication(false);
  if (settings.verbose) application->Jnlst()->AddFileJournal("log", "stderr", Ipopt::J_ITERSUMMARY);
  apply(settings, program.size().hessian >= 0, *application->Options());
  if (application->Initialize() != Ipopt::Solve_Succeeded) return IpoptEnd::unavailable;
  return ending(application->OptimizeTNLP(adapter));
}

}  // namespace catena

#else

namespace catena {

bool ipopt_program_is_built_in() { return false; }

IpoptEnd run_ipopt(IpoptProgram&, const IpoptSettings&) { return IpoptEnd::unavailable; }

}  // namespace catena

#endif
