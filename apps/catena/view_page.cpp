#include "view_page.hpp"

#include <fmt/format.h>

#include "catena/results/text_output.hpp"
#include "catena/scene/viewing/view_document.hpp"
#include "catena/scene/viewing/viewer_page.hpp"
#include "commands.hpp"

namespace catena::cli {

std::string viewer_obstacle() {
  if (!viewer_template().empty()) return {};
  return "catena: this catena was built without the viewer (CATENA_WITH_VIEWER=OFF); \"catena draw\" and \"catena "
         "plot\" make figures\n";
}

int write_page(const std::string& path, const RunRecord& record) {
  const std::string page = compose_page(view_document(record));
  TextOutput output = TextOutput::file(path);
  output.write(page);
  if (!output.commit()) {
    complain(fmt::format("catena: {}\n", output.error()));
    return no_file;
  }
  for (const std::string& note : view_notes(record)) complain(fmt::format("{}: {}\n", path, note));
  complain(fmt::format("wrote {} ({:.2g} MB)\n", path, static_cast<double>(page.size()) / 1e6));
  return solved;
}

}  // namespace catena::cli
