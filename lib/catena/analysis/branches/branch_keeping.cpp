#include "catena/analysis/branches/branch_keeping.hpp"

#include <algorithm>
#include <cmath>

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

/// The largest difference of two places, length scales or rad.
double distance(EquationsOfMotion& equations, std::span<const double> a, std::span<const double> b) {
  double largest = 0;
  for (const int k : equations.plan().coordinate) {
    const double unit = k % 3 == 2 ? 1 : equations.evaluator().length_scale();
    largest = std::max(largest, std::abs(a[at(k)] - b[at(k)]) / unit);
  }
  return largest;
}

}  // namespace

BranchKeeping::BranchKeeping(const EquationsOfMotion& equations)
    : q_(at(equations.plan().coordinates())),
      phi_(at(equations.plan().rows)),
      values_(at(equations.plan().trash_slot()) + 1) {}

BranchKeeping::Course BranchKeeping::course(EquationsOfMotion& equations, std::span<const double> q0,
                                            std::span<const double> q1, std::span<const double> middle) {
  std::copy(middle.begin(), middle.end(), q_.begin());
  BranchCorner corner;
  const BranchMeeting meeting = find_branch_meeting(equations, q_, q0, phi_, values_, corner);
  if (meeting == BranchMeeting::several) return Course::unjudged;
  // The middle is known no better than the step is long.
  if (meeting == BranchMeeting::crossing && distance(equations, middle, q_) < distance(equations, q0, q1))
    return Course::crossed;
  const Plan& plan = equations.plan();
  if (meeting != BranchMeeting::corner || !(along(plan, corner, q0, q_) * along(plan, corner, q1, q_) < 0))
    return Course::kept;
  gap_ = corner.gap;
  return largest_rounding_of_offset * corner.offset > corner.rounding ? Course::left : Course::left_within_rounding;
}

double BranchKeeping::narrow_gap(EquationsOfMotion& equations, std::span<const double> q) {
  std::copy(q.begin(), q.end(), q_.begin());
  BranchCorner corner;
  if (find_branch_meeting(equations, q_, q, phi_, values_, corner) != BranchMeeting::corner ||
      !(largest_rounding_of_offset * corner.offset < narrow * corner.rounding))
    return 0;
  return distance(equations, q, q_) < beside ? corner.gap : 0;
}

}  // namespace catena
