#include "catena/analysis/branches/branch_keeping.hpp"

#include <algorithm>
#include <cmath>
#include <optional>

#include "catena/analysis/branches/branch_passage.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// The corner that a motion turns at is as near as c says: where rounding changes c by a larger part of it no step can
// follow it, and it is crossed as if c were zero, which is told. Four-bars that differ from parallel cranks by 1e-10 of
// a rod and more turn at tolerances from 1e-4 to 1e-10; by 6e-11 and less they stall or need 33 000 steps in place of
// 37.
constexpr double largest_rounding_of_offset = 5e-4;
// Branches count as near to each other up to so many times the offset from which on steps can turn, and for a motion
// that is no further away than this, length scales or rad: beyond it pivots are some 1e-4 of the usual ones or more,
// and steps are not held up.
constexpr double narrow = 10, beside = 1e-2;

/// x along e of a place.
double along(const Plan& plan, const BranchCorner& corner, std::span<const double> place, std::span<const double> q) {
  double sum = 0;
  for (int c = 0; c < plan.columns; ++c) {
    const std::size_t k = at(plan.coordinate[at(c)]);
    sum += corner.direction[at(c)] * (place[k] - q[k]);
  }
  return sum;
}

}  // namespace

BranchKeeping::BranchKeeping(const EquationsOfMotion& equations)
    : q_(at(equations.plan().coordinates())),
      phi_(at(equations.plan().rows)),
      values_(at(equations.plan().trash_slot()) + 1) {}

BranchKeeping::Course BranchKeeping::course(EquationsOfMotion& equations, std::span<const double> q0,
                                            std::span<const double> q1, std::span<const double> middle) {
  std::copy(middle.begin(), middle.end(), q_.begin());
  const std::optional<BranchCorner> corner = find_branch_corner(equations, q_, q0, phi_, values_);
  const Plan& plan = equations.plan();
  if (!corner || !(along(plan, *corner, q0, q_) * along(plan, *corner, q1, q_) < 0)) return Course::kept;
  gap_ = corner->gap;
  return largest_rounding_of_offset * corner->offset > corner->rounding ? Course::left : Course::left_within_rounding;
}

double BranchKeeping::narrow_gap(EquationsOfMotion& equations, std::span<const double> q) {
  std::copy(q.begin(), q.end(), q_.begin());
  const std::optional<BranchCorner> corner = find_branch_corner(equations, q_, q, phi_, values_);
  if (!corner || !(largest_rounding_of_offset * corner->offset < narrow * corner->rounding)) return 0;
  double distance = 0;
  for (const int k : equations.plan().coordinate) {
    const double unit = k % 3 == 2 ? 1 : equations.evaluator().length_scale();
    distance = std::max(distance, std::abs(q[at(k)] - q_[at(k)]) / unit);
  }
  return distance < beside ? corner->gap : 0;
}

}  // namespace catena
