// The data of a page: geometry, poses and columns of a recorded run as one JSON document.
//
// Its version is `catena_view`; every field is explained in apps/manual/viewer.md, and the page reads nothing else.
// Numbers are finite or null, binary ones packed (packed_numbers.hpp), all in SI: the document says in which units they
// are to be shown.
#pragma once

#include <string>
#include <vector>

#include "catena/drawing/shapes/drawing.hpp"
#include "catena/scene/numbers/output_units.hpp"
#include "catena/scene/viewing/run_recorder.hpp"

namespace catena {

inline constexpr int view_version = 1;

/// The document; the record must have a model. `wishes` for units come before those of the scene.
std::string view_document(const RunRecord& record, const OutputUnits::Wishes& wishes = {});

/// What the document leaves out of the run, in sentences.
std::vector<std::string> view_notes(const RunRecord& record);

class ViewJson;
/// Members of an object: names of bodies, elements and points.
void append_names(ViewJson& json, const Model& model);
/// Whether append_names() writes the same of both.
bool same_names(const Model& a, const Model& b);
/// Members of an object: symbols, shapes, loads, the given poses.
void append_drawing(ViewJson& json, const Model& model, const Drawing& drawing);
/// Poses of an analysis as an object. `count`: how many of them.
void append_poses(ViewJson& json, const RecordedAnalysis& analysis);

}  // namespace catena
