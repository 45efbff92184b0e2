// The text of a scene with other values of some parameters: comments and layout stay as they are.
#pragma once

#include <string>

#include "catena/scene/running/scene_models.hpp"

namespace catena {

/// The scene's own text in which the values of the seeds stand in place of those that its parameters are given there;
/// numbers, SI, that read back exactly. Parameters that follow from others keep their expressions, unless they are
/// among the seeds.
std::string text_with_values(const SceneTemplate& scene, const ParameterSeeds& seeds);

}  // namespace catena
