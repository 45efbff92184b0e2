// In place of the page that the build makes: a library that was built without the viewer.
#include "catena/scene/viewing/viewer_page.hpp"

std::string_view catena::viewer_template() { return {}; }
