#include "catena/analysis/accuracy/flutter_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "catena/analysis/accuracy/disturbance.hpp"
#include "catena/analysis/stability/load_search.hpp"

namespace catena {
namespace {

constexpr double no_place = std::numeric_limits<double>::quiet_NaN();
// Three distances, in parts of it, that have no places in common.
constexpr std::array<double, 3> distances = {1, 1.3, 1.7};

/// Two values that may meet: their mean, and D.
struct Meeting {
  double omega2 = 0, square = 0;
};

/// The one with the least of `measure`.
template <class Measure>
std::optional<Meeting> least_meeting(const CirculatoryModes& found, Measure&& measure) {
  std::optional<Meeting> least;
  const CirculatoryMode* before = nullptr;
  const auto look = [&](const Meeting& meeting) {
    if (!least || measure(meeting) < measure(*least)) least = meeting;
  };
  for (const CirculatoryMode& mode : found.modes) {
    if (mode.is_pair()) {
      look({mode.omega2, -mode.imaginary * mode.imaginary});
      continue;
    }
    const double half = before ? (mode.omega2 - before->omega2) / 2 : 0;
    if (before) look({before->omega2 + half, half * half});
    before = &mode;
  }
  return least;
}

/// s(0) of the polynomial through the points (D_i, s_i), by Neville's scheme.
double at_zero(const std::array<double, 4>& squares, std::array<double, 4> places) {
  for (std::size_t width = 1; width < places.size(); ++width) {
    for (std::size_t i = 0; i + width < places.size(); ++i) {
      const double a = squares[i], b = squares[i + width];
      places[i] = (a * places[i + 1] - b * places[i]) / (a - b);
    }
  }
  return places[0];
}

}  // namespace

double flutter_place_error(PathSystem& path, const PathPoint& row, const PathPoint& tangent) {
  CirculatoryModes found;
  if (!path.spectrum(row, found)) return no_place;
  const auto met = least_meeting(found, [](const Meeting& m) { return std::abs(m.square); });
  if (!met) return no_place;
  const auto off = [&](const Meeting& m) { return std::abs(m.omega2 - met->omega2) + std::sqrt(std::abs(m.square)); };
  std::array<double, distances.size()> zeros{};
  double mean = 0, largest = 0, square = 0;
  for (std::size_t k = 0; k < zeros.size(); ++k) {
    std::array<double, 4> squares{}, places{};
    for (std::size_t i = 0; i < places.size(); ++i) {
      constexpr std::array<double, 4> sides = {-2, -1, 1, 2};
      // Four places leave out what changes with the fourth power of it.
      const double s = load_difference * distances[k] * sides[i];
      PathPoint x = path.advanced(row, tangent, s);
      if (path.correct(x, row, tangent, s) < 0 || !path.spectrum(x, found)) return no_place;
      const auto near = least_meeting(found, off);
      if (!near) return no_place;
      squares[i] = near->square;
      places[i] = path.way(row, x, tangent);
    }
    zeros[k] = at_zero(squares, places);
    mean += zeros[k] / static_cast<double>(zeros.size());
    largest = std::max(largest, std::abs(zeros[k]));
  }
  for (const double zero : zeros) square += (zero - mean) * (zero - mean) / static_cast<double>(zeros.size());
  return largest + Disturbance::deviations * std::sqrt(square);
}

}  // namespace catena
