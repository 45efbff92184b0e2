// Reads columns of a scene's own: formulas over columns, parameters and t.
//
//   "columns": {"transmission": "=abs(coupler.angle - rocker.angle)", "speed": {"value": "=...", "unit": "m/s"}}
//
// They are compiled here; whether the columns that they name exist is known once the model is built. An expression may
// also stand by itself where a column may: it is then a column whose name is its own text.
#pragma once

#include <span>
#include <string>

#include "catena/scene/reading/scene_template.hpp"

namespace catena {

/// The object "columns" of a scene.
void read_own_columns(const JsonValue& object, SceneTemplate& scene, Diagnostics& diagnostics);

/// The variables of replicate blocks that an expression may name, and their values; outermost first.
struct LoopValues {
  std::span<const std::string> names = {};
  std::span<const double> values = {};
};

/// The name of the column that the text at `value` means: itself, or, where it begins with =, the expression's, which
/// is added to the scene if it is new. Empty, with a report, if it cannot be read.
std::string column_name(const JsonValue& value, SceneTemplate& scene, Diagnostics& diagnostics);

/// The same of a text that was made of the one at `place`, in a block that is repeated.
std::string column_name(const JsonValue& place, std::string text, const LoopValues& loop, SceneTemplate& scene,
                        Diagnostics& diagnostics);

}  // namespace catena
