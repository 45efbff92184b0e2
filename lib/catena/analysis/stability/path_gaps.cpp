// One-sided elements on a path of equilibria: which hold is followed from point to point.
//
//   closed:  lambda = -p passes zero from below       open:  Psi passes zero from above
//
// Both are continuous along the path of the present set; the first zero in a step is its end. There the set changes,
// and the path of the new set has two sides, on one of which it holds: p' > 0 of what closed, Psi' > 0 of what opened.
// These signs, not that of the parameter, say where the path goes on: it may turn back. Singular: several change at
// once and no side holds for all; the new set leaves the place without stiffness, or with a motion that nothing
// resists.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/stability/path_march.hpp"
#include "catena/analysis/statics/active_set_at.hpp"
#include "catena/analysis/statics/solvers/static_active_set.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Faults (static_active_set.hpp) below this are rounding of a point that is solved, and all that are as good as closed
// at the place of a change change there; it is located until the largest fault is that of solved equations.
constexpr double no_fault = 1e-10;
// How often sets may change without a step between, besides once each.
constexpr int most_changes_here = 4;

}  // namespace

double Path::March::largest_fault(const PathPoint& x) {
  system_.move_to(x);
  faults_ = gap_faults(path_.system_, x.lambda, gaps_.closed);
  double largest = -std::numeric_limits<double>::infinity();
  for (const std::size_t k : changing_) largest = std::max(largest, faults_[k]);
  return largest;
}

bool Path::March::change_within(PathPoint& next, double& s, bool& located) {
  changing_.clear();
  static_cast<void>(largest_fault(next));
  for (std::size_t k = 0; k < faults_.size(); ++k) {
    if (faults_[k] > no_fault) changing_.push_back(k);
  }
  if (changing_.empty()) return false;
  double low = 0, high = s, high_fault = largest_fault(next), low_fault = largest_fault(x_), fault = low_fault;
  PathPoint point = x_;
  s = 0;
  // What touched at the present point, without force, may be about to change there.
  for (int k = 0; k < thresholds::most_bisections && fault < -thresholds::solved && std::nextafter(low, high) < high;
       ++k) {
    double trial = low + (high - low) * low_fault / (low_fault - high_fault);
    if (k % 3 == 2) trial = 0.5 * (low + high);
    PathPoint found = system_.advanced(x_, direction_, trial);
    if (system_.correct(found, x_, direction_, trial) < 0) {
      located = false;
      return false;
    }
    const double there = largest_fault(found);
    if (there > thresholds::solved) {
      high = trial;
      high_fault = there;
      continue;
    }
    low = s = trial;
    low_fault = fault = there;
    point = std::move(found);
  }
  fault = largest_fault(point);
  std::erase_if(changing_, [&](std::size_t k) { return faults_[k] < fault - thresholds::closed_gap; });
  next = std::move(point);
  return true;
}

Report Path::March::change_gaps() {
  const Plan& plan = *path_.plan_;
  const auto name = [&](std::size_t k) {
    return path_.evaluator_.model().element_name(plan.row_element[at(plan.gap_rows[k])]);
  };
  const std::string first = name(changing_.front());
  if (++changed_here_ > static_cast<int>(gaps_.closed.size()) + most_changes_here) {
    return {
        Status::singular,
        fmt::format("at the value {:.10g} one-sided elements open and close without end, \"{}\" among them: the path "
                    "cannot go on from there",
                    x_.p, first),
        {}};
  }
  for (const std::size_t k : changing_) {
    gaps_.closed[k] = !gaps_.closed[k];
    x_.lambda[at(plan.gap_rows[k])] = 0;
    const int row = static_cast<int>(report_->negative_modes.size()) - 1;
    report_->changes.push_back({plan.row_element[at(plan.gap_rows[k])], gaps_.closed[k] != 0, x_.p, row});
  }
  path_.system_.close_gaps(gaps_.closed);
  if (!system_.factorize(x_)) {
    return {
        Status::singular,
        fmt::format("at the value {:.10g} of the parameter \"{}\" {}, and nothing holds the mechanism there: the path "
                    "cannot go on",
                    x_.p, first, gaps_.closed[changing_.front()] ? "closes" : "opens"),
        {}};
  }
  if (!judge(x_)) return unjudged();
  direction_ = system_.tangent(x_, direction_);
  // To which side each of them holds.
  static_cast<void>(largest_fault(x_));
  const std::vector<double> here = faults_;
  static_cast<void>(largest_fault(system_.advanced(x_, direction_, beside_point)));
  int holds = 0, fails = 0;
  for (const std::size_t k : changing_) (faults_[k] < here[k] ? holds : fails) += 1;
  changing_.clear();
  if (holds > 0 && fails > 0) {
    return {Status::bifurcation,
            fmt::format("at the value {:.10g} of the parameter several one-sided elements change at once, \"{}\" among "
                        "them, and to neither side do all of them hold: the path branches there",
                        x_.p, first),
            {}};
  }
  if (fails > 0) {
    for (double& v : direction_.q) v = -v;
    for (double& v : direction_.lambda) v = -v;
    direction_.p = -direction_.p;
  }
  return {};
}

}  // namespace catena
