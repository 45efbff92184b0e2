// The field "singular" of results: one object a singular configuration that kinematics or dynamics came to.
//
//   {"t": s, "kind": "branch_point"|"tangency"|"rest"|"isolated"|"lock_up", "nullity", "bodies": [...],
//    "branches": [...], "driver": name, "value": m or rad}
//
// `bodies` take part in what moves there, the most mobile first; `branches` are velocities in words, and where none
// goes on that is said in place of an empty list; `driver` and `value` are missing where nothing is driven.
#pragma once

#include <vector>

#include "catena/analysis/dynamics/error_estimate.hpp"
#include "catena/analysis/pose/singular_point.hpp"
#include "catena/scene/running/analysis_run.hpp"

namespace catena {

void add_singular_points(AnalysisResult& result, const std::vector<SingularPoint>& points, const Model& model);
/// The field "estimated_error": one object a kind of coordinate.
void add_estimated_error(AnalysisResult& result, const EstimatedError& error, const Model& model);

}  // namespace catena
