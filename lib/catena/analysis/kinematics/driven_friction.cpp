#include "catena/analysis/kinematics/driven_friction.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>
#include <utility>

#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double not_known = std::numeric_limits<double>::quiet_NaN();

}  // namespace

DrivenFriction::DrivenFriction(const Evaluator& evaluator)
    : evaluator_(evaluator), joints_(joints_with_friction(evaluator.model())) {
  if (any()) by_element_.resize(evaluator.model().elements.size());
  states_.assign(joints_.size(), {.closed = true});
}

// Which way each joint slips.
void DrivenFriction::begin(double t, std::span<const double> qd, std::span<double> friction) {
  const double none = no_speed * fastest(evaluator_, qd);
  bool rests = false, changed = !loads_;
  for (std::size_t k = 0; k < joints_.size(); ++k) {
    const double rate = evaluator_.scalar_motion(joints_[k].slide, qd).rate;
    const int direction = direction_of(rate, rate_of_speed(joints_[k], none, evaluator_.length_scale()));
    changed |= std::exchange(states_[k].direction, direction) != direction;
    if (direction != 0 || !joints_[k].is_exact()) continue;
    if (rests_ == 0 && !rests) first_rest_ = t, resting_ = k;
    rests = true;
  }
  rests_ += rests;
  if (changed) loads_.emplace(evaluator_, joints_, states_);
  loads_->add(qd, friction);
}

void DrivenFriction::finish(std::span<const double> lambda) {
  loads_->finish(lambda);
  loads_->scatter(by_element_);
}

void DrivenFriction::forget() {
  loads_.reset();
  for (const ContactPoint& joint : joints_) by_element_[at(joint.element)] = {not_known, not_known, not_known};
}

double DrivenFriction::dissipation() const { return loads_ ? loads_->dissipation() : any() ? not_known : 0; }

Report DrivenFriction::no_friction(double t) const {
  Report report;
  report.status = Status::inconsistent;
  report.message = fmt::format("at t = {:.12g} s {}", t, loads_->trouble());
  return report;
}

// As ContactLoads::joint_force, before lengths are taken: forces of a pin are one vector, force and moment of a guide
// two numbers.
void DrivenFriction::read_pressing(std::span<const double> lambda, std::span<const double> qd,
                                   std::vector<Vec2<double>>& pressing) const {
  pressing.clear();
  for (const ContactPoint& joint : joints_) {
    const std::size_t row = at(evaluator_.plan().element_row[at(joint.joint)]);
    const double power = joint.mu * joint.radius * std::abs(evaluator_.scalar_motion(joint.slide, qd).rate);
    if (evaluator_.plan().row_is_angle[row + 1]) {
      pressing.push_back({power * lambda[row], 0});
      pressing.push_back({power * lambda[row + 1] / joint.half_length, 0});
    } else {
      pressing.push_back({power * lambda[row], power * lambda[row + 1]});
    }
  }
}

void DrivenFriction::add_remarks(std::vector<std::string>& warnings) const {
  if (rests_ == 0) return;
  warnings.push_back(
      fmt::format("\"{}\" rests at t = {:.12g} s: its friction may be anything up to mu_static N there, and none is "
                  "taken{}; with vs it is smoothed, and known at rest as well",
                  evaluator_.model().element_name(joints_[resting_].element), first_rest_,
                  rests_ > 1 ? fmt::format(", nor at {} more instants at which a joint rests", rests_ - 1) : ""));
}

}  // namespace catena
