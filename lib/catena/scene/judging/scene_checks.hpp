// Names in a scene that can be judged only once its model is there: columns of outputs, events and measures, what
// columns of the scene's own are made of, what events act on.
//
// With errors before, half of the model may be missing: check after a sound reading. Everything wrong is reported at
// its place, with a near miss.
#pragma once

#include <vector>

#include "catena/base/row_sink.hpp"
#include "catena/model/model.hpp"
#include "catena/scene/json/diagnostic.hpp"
#include "catena/scene/reading/analysis_task.hpp"

namespace catena {

class SceneChecks {
 public:
  /// All must outlive this object.
  SceneChecks(const SceneTemplate& scene, const Model& model, Diagnostics& diagnostics)
      : scene_(scene), model_(model), diagnostics_(diagnostics) {}

  void check_columns(const std::vector<PlacedName>& names);
  void check_own_columns();
  void check_task(const AnalysisTask& task);

 private:
  void check_event(const EventRequest& event);
  void check_event_value(const EventRequest& event, const ColumnInfo& column);
  void check_impulse(const EventRequest::Impulse& impulse);
  void check_measure(const PlacedMeasure& measure);

  const SceneTemplate& scene_;
  const Model& model_;
  Diagnostics& diagnostics_;
};

}  // namespace catena
