#include <algorithm>
#include <limits>
#include <vector>

#include "catena/analysis/minimiser/ipopt_program.hpp"
#include "catena/analysis/minimiser/minimiser_parts.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Of the tolerance of variables, that of the equations of a minimum: in flat valleys a variable is off by the root of
// what these leave. Ten iterates in a row that meet the tolerance itself will do: derivatives are good to some 1e-10.
constexpr double part_of_tolerance = 1e-3, acceptable = 1 / part_of_tolerance;
constexpr int acceptable_iterations = 10;
// Where none is asked for.
constexpr double usual_tolerance = 1e-8;

/// Rows of constraints: the unequal ones first, then the equal ones; Jacobians dense.
class Problem final : public IpoptProgram {
 public:
  Problem(MinimisationProblem& problem, const MinimiserOptions& options, std::span<double> x)
      : problem_(problem),
        options_(options),
        x_(x),
        unequal_(at(problem.inequalities())),
        equal_(at(problem.equations())) {}

  MinimiserEnd why_stopped() const {
    return enough_ ? MinimiserEnd::enough : stopped_ ? MinimiserEnd::stopped : MinimiserEnd::slow;
  }

  Size size() const override {
    const std::size_t rows = unequal_.size() + equal_.size();
    return {static_cast<int>(x_.size()), static_cast<int>(rows), static_cast<int>(rows * x_.size())};
  }
  void bounds(std::span<double> low, std::span<double> high, std::span<double> g_low,
              std::span<double> g_high) override {
    for (std::size_t v = 0; v < low.size(); ++v) {
      low[v] = options_.lower.empty() ? -ipopt_no_bound : options_.lower[v];
      high[v] = options_.upper.empty() ? ipopt_no_bound : options_.upper[v];
    }
    for (std::size_t k = 0; k < g_low.size(); ++k) {
      g_low[k] = k < unequal_.size() ? -ipopt_no_bound : 0;
      g_high[k] = 0;
    }
  }
  void start(std::span<double> x, std::span<double> lambda) override {
    std::copy(x_.begin(), x_.end(), x.begin());
    std::fill(lambda.begin(), lambda.end(), 0.0);
  }
  double objective(const double* x) override {
    // A line search would go on without being asked: what is not finite ends it.
    if (!go_on(0)) return std::numeric_limits<double>::quiet_NaN();
    ++evaluations_;
    const double f = problem_.objective({x, x_.size()}, {});
    stopped_ = stopped_ || !problem_.go_on();
    enough_ = enough_ || f <= options_.enough;
    return f;
  }
  void gradient(const double* x, std::span<double> out) override { problem_.objective({x, x_.size()}, out); }
  void rows(const double* x, std::span<double> g) override {
    const std::span<const double> place(x, x_.size());
    if (!unequal_.empty()) problem_.unequal(place, g.first(unequal_.size()), {});
    if (!equal_.empty()) problem_.equal(place, g.subspan(unequal_.size()), {});
  }
  Place jacobian_place(int entry) const override {
    const int n = static_cast<int>(x_.size());
    return {entry / n, entry % n};
  }
  void jacobian(const double* x, std::span<double> values) override {
    const std::span<const double> place(x, x_.size());
    const std::size_t split = unequal_.size() * x_.size();
    if (!unequal_.empty()) problem_.unequal(place, unequal_, values.first(split));
    if (!equal_.empty()) problem_.equal(place, equal_, values.subspan(split));
  }
  bool go_on(int) override { return !stopped_ && !enough_ && evaluations_ < options_.max_evaluations; }
  void finish(const double* x, const double*) override { std::copy(x, x + x_.size(), x_.begin()); }

 private:
  MinimisationProblem& problem_;
  const MinimiserOptions& options_;
  std::span<double> x_;
  std::vector<double> unequal_, equal_;
  int evaluations_ = 0;
  bool stopped_ = false, enough_ = false;
};

}  // namespace

bool ipopt_minimiser_is_built_in() { return ipopt_program_is_built_in(); }

MinimiserEnd minimise_by_ipopt(MinimisationProblem& problem, const MinimiserOptions& options, std::span<double> x) {
  Problem program(problem, options, x);
  const IpoptSettings settings{
      .max_iterations = options.max_evaluations,
      .tolerance = part_of_tolerance * (options.x_tolerance > 0 ? options.x_tolerance : usual_tolerance),
      .acceptable = acceptable,
      .acceptable_iterations = acceptable_iterations,
      .constraint_tolerance = options.constraint_tolerance,
      .relaxed_bounds = 0};
  switch (run_ipopt(program, settings)) {
    case IpoptEnd::solved:
    case IpoptEnd::acceptable:
    case IpoptEnd::infeasible:  // the constraints there tell
      return MinimiserEnd::converged;
    case IpoptEnd::tiny_steps:
      return MinimiserEnd::rounding;
    case IpoptEnd::slow:
      return MinimiserEnd::slow;
    case IpoptEnd::stopped:
      return program.why_stopped();
    default:
      return program.go_on(0) ? MinimiserEnd::failed : program.why_stopped();
  }
}

}  // namespace catena
