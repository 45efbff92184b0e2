// What derivatives of a motion with contacts and events need of a scene: events with the derivatives of their numbers,
// models with the equations of slides.
#pragma once

#include "catena/analysis/sensitivity/phases/phased_derivatives.hpp"
#include "catena/scene/models/scene_models.hpp"

namespace catena {

/// Whether the motion goes on in another way after it.
bool acts(const EventRequest& event);
/// Whether it is made of the instants of events.
bool reads_events(const PlacedMeasure& measure);

/// `sizes`: of the parameters; `moving`: how the task's numbers move with each parameter; `options`: those of the
/// analysis; `plan`: of its start. Throws as ColumnSet does.
PhasedDesign phased_design(const DesignModels& designs, const std::vector<double>& sizes, const AnalysisTask& task,
                           const std::vector<std::vector<SceneModels::MovingNumber>>& moving,
                           const std::shared_ptr<const Model>& model, const PlanOptions& options, const Plan& plan,
                           const ColumnSources& sources);

}  // namespace catena
