// Processor time of whole runs of a scene, from its text to rows in memory: what other languages are compared with
// (beside_python.py).
#pragma once

#include <string>

namespace bench {

/// Prints the seconds of one run of the scene's analyses of this type, the least of so many, and how many values its
/// rows have. False where the scene has none, or they are not solved.
bool print_scene_runs(const std::string& path, const std::string& type, int repeats);

}  // namespace bench
