// ContactSwitch: grips that cannot slip because others do not (a tackle in which two sheaves hold holds altogether).
// Their equations would depend on those of the others, and the tensions beside them are not unique: they keep what was
// found.
#include <cmath>

#include "catena/analysis/contact/contact_switch.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

/// The acceleration along place a, zero if it is rounding.
double acceleration(const ContactProblem& problem, std::size_t a) {
  double sum = problem.b[2 * a + 1], terms = std::abs(sum);
  for (std::size_t c = 0; c < problem.x.size(); ++c) {
    sum += problem.D(2 * a + 1, c) * problem.x[c];
    terms += std::abs(problem.D(2 * a + 1, c) * problem.x[c]);
  }
  return std::abs(sum) > ContactProblem::rounding_of_sums * terms ? sum : 0;
}

}  // namespace

void ContactSwitch::tie_grips(const ContactProblem& problem, std::vector<ContactState>& states) const {
  std::vector<std::size_t> rows;
  for (std::size_t a = 0; a < active_.size(); ++a) {
    if (problem.place[a].head >= 0 || problem.state[a] == ContactProblem::State::open) continue;
    if (problem.place[a].has_normal) rows.push_back(2 * a);
    if (problem.state[a] == ContactProblem::State::sticks) rows.push_back(2 * a + 1);
  }
  std::vector<double> tension(active_.size(), 0.0);  // by place of a rope, behind the last grip that was looked at
  for (std::size_t a = 0; a < active_.size(); ++a) {
    const int head = problem.place[a].head;
    if (head < 0) {
      tension[a] = problem.x[2 * a];
      continue;
    }
    const double before = tension[at(head)], behind = tension[at(head)] += problem.x[2 * a + 1];
    const std::size_t k = active_[a];
    if (!states[k].closed || !(before > 0) || !(behind > 0)) continue;
    const bool rests = std::abs(slide_[k].rate) <= part_of_speed(k, no_speed);
    const bool stays = rests && states[k].direction != 0 && acceleration(problem, a) == 0;
    const bool repeats = states[k].direction == 0 && problem.depends(2 * a + 1, rows);
    if (states[k].direction == 0 && !repeats) rows.push_back(2 * a + 1);
    if (stays || repeats) states[k] = {.closed = true, .held = std::log(behind / before), .tied = true};
  }
}

// Without their ropes grips hold nothing.
void ContactSwitch::let_grips_go(std::vector<ContactState>& states) {
  std::vector<std::size_t> left;
  for (const std::size_t k : active_) {
    const bool holds = points_[k].kind != ContactKind::grip || is_active(at(points_[k].rope->head));
    if (holds) left.push_back(k);
    if (!holds) states[k] = {};
  }
  active_ = std::move(left);
}

}  // namespace catena
