// Modes under forces without a potential: their spectrum as rows, and what is to be said of it.
#include <fmt/format.h>

#include <cmath>

#include "catena/analysis/run/energyless_forces.hpp"
#include "catena/analysis/spectrum/circulatory_words.hpp"
#include "catena/analysis/stability/modes.hpp"
#include "catena/base/at.hpp"

namespace catena {

Report Modes::find_circulatory(std::span<const double> mass, std::span<const double> lambda, double residual, int count,
                               ModesReport& report) {
  StaticTangent tangent(system_);
  CirculatoryMotions motions(system_, tangent, mass);
  if (!motions.are_small())
    return too_large_without_energy(*model_, motions.freedoms(), CirculatoryMotions::most_freedoms);
  if (motions.massless_column()) return undetermined(*motions.massless_column());
  CirculatoryModes found;
  if (!motions.find(lambda, residual, found)) {
    return {Status::not_converged, "the eigenvalues of the stiffness did not settle: is a number in it infinite?", {}};
  }
  list(found, count, report);
  report.free_motions = found.neutral;
  report.free_bodies = free_bodies_of(system_, lambda, found);
  for (std::string& sentence : describe_motions(system_, evaluator_, found, report.free_bodies))
    report.warnings.push_back(std::move(sentence));
  const int modes = static_cast<int>(report.omega2.size());
  if (modes == 0) {
    report.warnings.emplace_back("nothing can move: there are no modes");
  } else if (modes < options_.count) {
    const char* plural = modes > 1 ? "s" : "";
    report.warnings.push_back(
        fmt::format("{} degree{} of freedom: {} mode{} instead of {}", modes, plural, modes, plural, options_.count));
  }
  return {};
}

// The lowest `count`; a pair is not cut in two.
void Modes::list(const CirculatoryModes& found, int count, ModesReport& report) {
  report.unstable = found.negative + found.pairs;
  report.flutter = found.pairs;
  const auto add = [&](double omega2, double omega, double imaginary, double growth, const std::vector<double>& shape) {
    report.omega2.push_back(omega2);
    report.omega.push_back(omega);
    report.shapes.push_back(shape);
    if (found.pairs == 0) return;
    report.imaginary.push_back(imaginary);
    report.growth.push_back(growth);
  };
  for (const CirculatoryMode& mode : found.modes) {
    if (static_cast<int>(report.omega2.size()) >= count) break;
    if (mode.is_pair()) {
      add(mode.omega2, mode.frequency(), -mode.imaginary, mode.growth(), mode.shape);
      add(mode.omega2, mode.frequency(), mode.imaginary, -mode.growth(), mode.quadrature);
    } else {
      const double omega = std::sqrt(std::abs(mode.omega2));
      add(mode.omega2, omega, 0, mode.omega2 < 0 ? omega : 0, mode.shape);
    }
  }
}

}  // namespace catena
