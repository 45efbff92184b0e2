// Reads a scene's text into its compiled form (scene_template.hpp): apps/manual/scenes.md, every key checked.
//
// Errors that do not depend on parameter values or on names of other parts are reported here; the others are found when
// the model is built. Linear in the length of the text.
#pragma once

#include <array>
#include <memory>
#include <string_view>

#include "catena/scene/reading/scene_template.hpp"

namespace catena {

/// The scene, or nothing where the text is not a scene at all. It may be built even if errors were reported: parts with
/// errors are missing or NaN, and building finds the remaining errors.
std::unique_ptr<SceneTemplate> read_scene(SourceText source, Diagnostics& diagnostics);

/// The keys of a scene, and those of a replicate block.
inline constexpr std::array<std::string_view, 16> scene_keys{
    "catena", "name",      "description", "gravity", "parameters", "bodies",  "constraints", "drivers",
    "forces", "replicate", "analyses",    "outputs", "$schema",    "columns", "units",       "tables"};
inline constexpr std::array<std::string_view, 8> block_keys{"count",       "first",   "variable", "bodies",
                                                            "constraints", "drivers", "forces",   "replicate"};
/// The name of a block's variable, unless the block says another one.
inline constexpr std::string_view block_variable = "k";

}  // namespace catena
