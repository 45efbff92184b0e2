#include "catena/scene/viewing/viewer_page.hpp"

#include <stdexcept>

namespace catena {

std::string compose_page(std::string_view document) {
  constexpr std::string_view mark = "CATENA_DATA";
  const std::string_view page = viewer_template();
  const std::size_t at = page.find(mark);
  if (at == std::string_view::npos)
    throw std::logic_error("this catena has no viewer page, or one without a place for data");
  std::string out;
  out.reserve(page.size() + document.size() + document.size() / 100);
  out += page.substr(0, at);
  // JSON has "<" within texts alone, where it may be written by its number.
  for (std::size_t from = 0; from < document.size();) {
    const std::size_t next = document.find('<', from);
    out += document.substr(from, next - from);
    if (next == std::string_view::npos) break;
    out += "\\u003c";
    from = next + 1;
  }
  out += page.substr(at + mark.size());
  return out;
}

}  // namespace catena
