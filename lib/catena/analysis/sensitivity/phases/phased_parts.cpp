// PhasedDerivatives: steps in parts.
#include <algorithm>

#include "catena/analysis/sensitivity/phases/phased_derivatives.hpp"

namespace catena {

// The next part of the step, behind those that have been covered.
bool PhasedDerivatives::cover_part(const MotionStretch& stretch, double to) {
  if (has_.step) parts_.push_back({from_, to_, has_.interpolant, tracks_});
  for (Track& track : tracks_) track.begin = track.end;
  from_ = to_;
  to_ = to;
  has_.step = true;
  has_.interpolant = false;
  return make_step(to_ - from_) && take_values(stretch, to_, &Track::end) && project(to_, Side::before, &Track::end);
}

// Makes the part in which t lies the present one; false where there is none.
bool PhasedDerivatives::go_to_part(double t) {
  const auto holds = [t](double from, double to) { return t >= from && t <= to; };
  if (holds(from_, to_)) return true;
  const auto found = std::find_if(parts_.begin(), parts_.end(), [&](const Part& p) { return holds(p.from, p.to); });
  if (found == parts_.end()) return false;
  std::swap(from_, found->from);
  std::swap(to_, found->to);
  std::swap(has_.interpolant, found->has_interpolant);
  std::swap(tracks_, found->tracks);
  return true;
}

}  // namespace catena
