#include "catena/analysis/minimiser/minimiser.hpp"

#include "catena/analysis/minimiser/minimiser_parts.hpp"

namespace catena {

bool minimiser_is_built_in(MinimiserMethod method) {
  return method == MinimiserMethod::ipopt ? ipopt_minimiser_is_built_in() : nlopt_is_built_in();
}

MinimiserEnd minimise(MinimisationProblem& problem, const MinimiserOptions& options, std::span<double> x) {
  return options.method == MinimiserMethod::ipopt ? minimise_by_ipopt(problem, options, x)
                                                  : minimise_by_nlopt(problem, options, x);
}

}  // namespace catena
