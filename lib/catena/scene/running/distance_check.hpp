// Checks that driven distances stay positive: their functions of time must be above zero while an analysis lasts.
//
// Rows of distances are squared, h^T h = f(t)^2, and vanish with their derivatives where f = 0: the motion would go on
// with a negative distance without any sign of it. So f is checked beforehand: at evenly spread instants, and at the
// minima between them, found by bisection of f'. Dips shorter than a quarter of the spacing of rows may be missed.
#pragma once

#include <optional>
#include <string>

#include "catena/analysis/run/time_grid.hpp"
#include "catena/model/model.hpp"

namespace catena {

/// What is wrong, with the instant; nothing if all driven distances are positive from `first` to the grid's last
/// instant (either may be the earlier).
std::optional<std::string> vanishing_distance(const Model& model, double first, const TimeGrid& grid);

}  // namespace catena
