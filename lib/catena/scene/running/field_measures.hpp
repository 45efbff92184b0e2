// Measures of what an analysis reports beside its rows: an energy, a critical load, an optimum.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "catena/results/analysis_result.hpp"

namespace catena {

struct AnalysisContext;

/// Measures of the kind `field`, from the fields of the result; those that it has not are told as such.
void add_field_measures(const AnalysisContext& context, AnalysisResult& result);
/// The gradient of the measures of a field, after add_field_measures(); number 0: it is no list.
void set_field_gradient(const AnalysisContext& context, AnalysisResult& result, std::string_view field, int number,
                        const std::vector<double>& gradient, const std::string& trouble = {},
                        std::string_view part = "value");

/// Gradients of the measures of instants in the field "events", after add_field_measures(). `instants`: how
/// they move with the parameters, by instant.
void set_event_gradients(const AnalysisContext& context, AnalysisResult& result,
                         const std::map<double, std::vector<double>>& instants);

}  // namespace catena
