// Writing the page of a recorded run.
#pragma once

#include <string>

#include "catena/scene/numbers/output_units.hpp"
#include "catena/scene/viewing/run_recorder.hpp"

namespace catena::cli {

/// Why this catena cannot write pages, as a message; empty if it can.
std::string viewer_obstacle();

/// Writes the page, its numbers shown in these units, and says where, how large it is and what it leaves out unless it
/// is to be quiet; the exit code.
int write_page(const std::string& path, const RunRecord& record, const OutputUnits::Wishes& units, bool quiet = false);

}  // namespace catena::cli
