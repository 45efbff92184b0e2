#include "catena/analysis/statics/solvers/endless_fall.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "catena/analysis/balance/descent_rules.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Extents of the scene, or radians, at which the energy is first compared: its rounding is far below its fall there.
constexpr double far = 1e3;
// What the energy's fall may differ from F s by, of itself: its rounding is 1e-12, and any spring that is stretched on
// the way is larger where the way is long enough.
constexpr double bend = 1e-6;

}  // namespace

bool falls_for_ever(StaticSystem& system, std::span<const double> q, std::span<const double> direction) {
  system.move_to(q);
  const double size = system.change_norm(direction), energy = system.energy();
  double force = 0;
  for (std::size_t c = 0; c < direction.size(); ++c) force -= direction[c] * system.gradient()[c];
  // Springs across the line are stretched by what its direction is wrong by: it has no more stiffness than such a part.
  const double across = neutral_part * system.matrix().absolute_quadratic(direction);
  const double longest = std::cbrt(std::numeric_limits<double>::max()) / system.length();
  bool endless = force > 0 && std::isfinite(size);
  std::vector<double> there, gaps;
  const std::vector<CurvePlace> places = system.evaluator().curve_places();
  for (double way = far * system.extent() / system.length(); endless && way < longest; way *= 2) {
    const double s = way / size;
    there.assign(q.begin(), q.end());
    system.advance(there, direction, s, std::numeric_limits<double>::infinity());
    system.move_to(there);
    endless =
        system.phi_norm() <= std::max({descent::restored, 10 * system.rounding_change(), neutral_part * way * way}) &&
        std::abs(energy - system.energy() - force * s) <= bend * force * s + across * s * s / 2;
    system.all_gaps(gaps);
    // A closed gap along which the line leads is rounding of places there.
    const double rounding =
        std::max({descent::restored, 10 * system.rounding_change(), thresholds::few_roundings * way});
    for (std::size_t k = 0; endless && k < gaps.size(); ++k) {
      const bool angle = system.plan().row_is_angle[at(system.plan().gap_rows[k])] != 0;
      endless = gaps[k] >= -rounding * (angle ? 1 : system.length());
    }
  }
  system.evaluator().go_to_curve_places(places);
  system.move_to(q);
  return endless;
}

}  // namespace catena
