// What derivatives of a motion with contacts and events need of a scene: events with the derivatives of their numbers,
// models with the equations of slides; and gradients of the instants that a result reports.
#pragma once

#include "catena/analysis/sensitivity/phases/phased_derivatives.hpp"
#include "catena/scene/running/analysis_run.hpp"

namespace catena {

/// Whether the motion goes on in another way after it.
bool acts(const EventRequest& event);
/// Whether it is made of the instants of events.
bool reads_events(const PlacedMeasure& measure);

/// `options`: those of the analysis; `plan`: of its start. Throws as ColumnSet does.
PhasedDesign phased_design(const AnalysisContext& context, const std::shared_ptr<const Model>& model,
                           const PlanOptions& options, const Plan& plan, const ColumnSources& sources);

/// Gradients of the measures of instants in the field "events", after add_field_measures().
void set_event_gradients(const AnalysisContext& context, AnalysisResult& result, const InstantRates& instants);

}  // namespace catena
