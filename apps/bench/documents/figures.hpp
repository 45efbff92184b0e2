// The plots of a run of `catena bench`, and the page that shows them with all rows.
#pragma once

#include <string>
#include <vector>

#include "documents/document.hpp"

namespace bench {

struct Figure {
  std::string name;   ///< of its file, without ending: "dynamics_car_axis"
  std::string title;  ///< what it shows
  std::string svg;
};

/// Error over processor time for every problem of dynamics and for kinematics, a line for each method and engine; run
/// time, cost a body and memory over the number of bodies; claimed over true errors, and both over the condition
/// number. Those without rows are left out.
std::vector<Figure> figures_of(const Document& document);

/// One HTML file that needs no other.
std::string page_of(const Document& document);

}  // namespace bench
