// One random oscillator by the library against its dense matrices: what differs, in words; empty where nothing does.
#pragma once

#include <cmath>
#include <sstream>
#include <string>

#include "catena/analysis/stability/modes.hpp"
#include "oracles/oscillators.hpp"

namespace catena::testing {

inline std::string compare_modes(unsigned seed) {
  const Oscillator oscillator(seed);
  Modes modes(oscillator.model, {}, {.count = 1000});
  const ModesReport report = modes.run();
  std::ostringstream what;
  what.precision(12);
  what << "seed " << seed << " (" << oscillator.kind << "): ";
  const auto say = [&](const auto&... part) {
    (what << ... << part);
    return what.str();
  };
  if (!report.ok()) return say(report.message);
  const std::vector<long double> wanted = oscillator.omega2();
  if (report.omega2.size() != wanted.size()) return say(report.omega2.size(), " modes of ", wanted.size());
  const long double largest = std::max(std::abs(wanted.front()), std::abs(wanted.back()));
  for (std::size_t k = 0; k < wanted.size(); ++k) {
    const long double found = report.omega2[k] / static_cast<long double>(oscillator.rate()), right = wanted[k];
    // Matrices are rounded to 1e-16 of their largest entries; a hundred of these.
    if (!(std::abs(found - right) <= 1e-10L * std::abs(right) + 2e-14L * largest))
      return say("omega2[", k, "] = ", found, " instead of ", right, ", of ", largest);
    const bool zero = std::abs(right) <= 1e-16L * largest, clear = std::abs(right) > 1e-11L * largest;
    if (oscillator.is_balanced() && zero && found != 0) return say(found, " instead of an exact zero");
    if (clear && found == 0) return say(right, " lost as a zero");
  }
  return {};
}

}  // namespace catena::testing
