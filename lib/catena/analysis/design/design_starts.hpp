// The searches of an optimisation from all its starts, in several threads. Private to design.
//
// The first start that can be analysed gives the sizes that objectives and constraints are measured in; every other one
// is a search of its own, with its own count of designs. What they found is put together in the order of the starts, as
// if each had begun where the one before had ended, and no more designs count than max_evaluations: the same designs
// count, and the same one comes of it, whatever the number of threads.
#pragma once

#include <optional>

#include "catena/analysis/design/design_search.hpp"

namespace catena {

// Of the tolerance, the relative gain of a step that ends a method.
inline constexpr double part_of_gain = 1e-3;

/// What the method is asked for after so many designs.
MinimiserOptions minimiser_options(const DesignOptions& options, int evaluations, std::size_t variables);

/// `search`, whose outcome this is, has then found the best design of all starts. Returns how the search that found it
/// ended; nothing where no start could be analysed.
std::optional<MinimiserEnd> search_from_all_starts(const DesignProblem& problem, const DesignOptions& options,
                                                   DesignSearch& search, const DesignOutcome& outcome);

}  // namespace catena
