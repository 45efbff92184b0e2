#include "view_page.hpp"

#include <fmt/format.h>

#include "catena/scene/viewing/view_document.hpp"
#include "catena/scene/viewing/viewer_page.hpp"
#include "commands.hpp"

namespace catena::cli {

std::string viewer_obstacle() {
  if (!viewer_template().empty()) return {};
  return "catena: this catena was built without the viewer (CATENA_WITH_VIEWER=OFF); \"catena draw\" and \"catena "
         "plot\" make figures\n";
}

int write_page(const std::string& path, const RunRecord& record, const OutputUnits::Wishes& units, bool quiet) {
  if (const int written = write_file(path, compose_page(view_document(record, units)), quiet); written != solved)
    return written;
  for (const std::string& note : view_notes(record)) {
    if (!quiet) complain(fmt::format("{}: {}\n", path, note));
  }
  return solved;
}

}  // namespace catena::cli
