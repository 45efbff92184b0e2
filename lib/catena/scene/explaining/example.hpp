// Examples for explain and schema, made from the descriptions: every type has one, and a test reads them all.
#pragma once

#include <string>

#include "catena/scene/describing/analysis_description.hpp"
#include "catena/scene/describing/element_description.hpp"

namespace catena {

/// `{"type": "revolute", "name": "A", "i": "crank.tip", "j": "rod.from"}`.
std::string example_of(const ElementDescription& type);
/// `{"type": "kinematics", "until": 2, "every": 0.01}`.
std::string example_of(const AnalysisDescription& type);
/// A scene around the example of an element: two bodies, and the element in the list it belongs to.
std::string example_scene(const ElementDescription& type);

}  // namespace catena
