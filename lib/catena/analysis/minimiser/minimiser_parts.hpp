// The two libraries behind minimise(). Private to minimiser.
#pragma once

#include "catena/analysis/minimiser/minimiser.hpp"

namespace catena {

MinimiserEnd minimise_by_nlopt(MinimisationProblem& problem, const MinimiserOptions& options, std::span<double> x);
bool ipopt_minimiser_is_built_in();
MinimiserEnd minimise_by_ipopt(MinimisationProblem& problem, const MinimiserOptions& options, std::span<double> x);

}  // namespace catena
