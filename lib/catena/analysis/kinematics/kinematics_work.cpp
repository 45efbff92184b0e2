// Inverse dynamics: the work that drivers and loads do along a driven motion.
//
//   W(t) = integral of -lambda nu (drivers), of the loads' power, and of what dampers dissipate
//
// by Gauss's rule of four points (order 8), which evaluates no power where one may jump: stretches end at breakpoints
// of functions of time, and no body moves further in one than a fifth of a radian or length scale. The error of all
// integrals together is known: energy.balance, the energy that the sums do not account for. Stretches are shortened
// until it, and the variation of a load within a stretch, is below 1e-10 of the energy exchanged.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/columns/energy.hpp"

namespace catena {
namespace {

// Of a stretch: rad, length scales.
constexpr double longest_stretch = 0.2;
// Parts of the energy exchanged so far: the error allowed in a stretch, above which it is repeated in shorter ones; and
// the total error above which results carry a warning. Both include rounding of energies.
constexpr double allowed_error = 1e-10, doubtful_error = 1e-6, work_rounding = 1e-13;
constexpr double shortest_part = 1.0 / 4096;
// The cubic part of the powers in a stretch, of the largest of them.
constexpr double roughest = 0.05;

// Gauss-Legendre: places in [0, 1], weights.
constexpr std::array<double, 4> places = {0.069431844202973712, 0.33000947820757187, 0.66999052179242813,
                                          0.93056815579702629};
constexpr std::array<double, 4> weights = {0.17392742256872693, 0.32607257743127307, 0.32607257743127307,
                                           0.17392742256872693};
// Weights that extract the cubic part of a power from its four values; absolute sum one.
constexpr std::array<double, 4> cubic = {-0.14153, 0.35847, -0.35847, 0.14153};

}  // namespace

// Begins at the present instant, which is assembled.
Report Kinematics::start_work() {
  if (!bridge_.empty() && t_ >= bridge_from_ && t_ <= bridge_to_) {
    place_on_bridge(t_);
  } else {
    evaluator_.set_time(t_);
    newton_ = solver_.solve_position(q_);
  }
  if (Report solved = find_rates({.velocity = true, .acceleration = true}); !solved.ok()) return solved;
  account_.emplace(evaluator_);
  work_.assign(account_->size(), 0.0);
  power_.resize(account_->size());
  driver_work_.assign(model_->elements.size(), 0.0);
  cubic_part_.resize(account_->size());
  exchanged_ = unsure_ = 0;
  stretch_part_ = 1;
  initial_energy_ = total_energy(snapshot());
  return {};
}

// Energy at the present instant that the sums do not account for.
double Kinematics::energy_gap() const {
  return total_energy(snapshot()) - initial_energy_ - EnergyAccount::supplied(work_) + EnergyAccount::dissipated(work_);
}

// The size at which energies are rounded.
double Kinematics::energy_scale() const {
  return kinetic_energy(snapshot()) + std::abs(evaluator_.potential_energy()) + std::abs(initial_energy_);
}

// The time in which no body moves further than a stretch of at most `limit` may.
double Kinematics::stretch(double limit) const {
  const double speed = solver_.distance(qd_, nothing_, nullptr), gain = solver_.distance(qdd_, nothing_, nullptr);
  // From rest the rates give no estimate: the whole way is tried first.
  double length = limit;
  if (speed > 0) length = std::min(length, longest_stretch / speed);
  if (gain > 0) length = std::min(length, std::sqrt(longest_stretch / gain));
  return stretch_part_ * length;
}

// One stretch further, to t: the powers inside, then the rates there. Returns an estimate of the error of the sums, J:
// the energy that they do not account for, and the cubic part of the powers, which four points do not resolve.
Report Kinematics::sum_up_stretch(double t, double& error, std::vector<std::string>& warnings) {
  const double from = t_, gap = energy_gap();
  const auto visit = [&](double instant, const Needs& needs) -> Report {
    Report moved = follow_to(instant);
    std::move(moved.warnings.begin(), moved.warnings.end(), std::back_inserter(warnings));
    moved.warnings.clear();
    if (!moved.ok()) return moved;
    if (Report solved = find_rates(needs); !solved.ok()) return solved;
    predictor_.push(t_, q_, qd_, qdd_);
    return {};
  };
  std::fill(cubic_part_.begin(), cubic_part_.end(), 0.0);
  double largest = 0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const Report moved =
        visit(from + (t - from) * places[k], {.velocity = true, .acceleration = true, .multipliers = true});
    if (!moved.ok()) return moved;
    account_->powers(qd_, lambda_, power_);
    for (std::size_t c = 0; c < work_.size(); ++c) {
      const double part = (t - from) * weights[k] * power_[c];
      work_[c] += part;
      exchanged_ += std::abs(part);
      cubic_part_[c] += cubic[k] * power_[c];
      largest = std::max(largest, std::abs(power_[c]));
    }
  }
  if (Report moved = visit(t, {.velocity = true, .acceleration = true}); !moved.ok()) return moved;
  double rough = 0;
  for (double part : cubic_part_) rough = std::max(rough, std::abs(part));
  error = std::max(std::abs(energy_gap() - gap), rough > roughest * largest ? rough * std::abs(t - from) : 0.0);
  return {};
}

// To t, from an instant whose rates are known, with the work done on the way.
Report Kinematics::move_and_sum_up(double t) {
  Report total;
  std::vector<double> ends, work_before;
  for (const auto& function : model_->functions) {
    const std::vector<double> breaks = function.breakpoints(std::min(t_, t), std::max(t_, t));
    ends.insert(ends.end(), breaks.begin(), breaks.end());
  }
  std::sort(ends.begin(), ends.end());
  if (t < t_) std::reverse(ends.begin(), ends.end());
  ends.push_back(t);
  for (double end : ends) {
    while (t_ != end) {
      // Equal stretches, none of them very short.
      const double from = t_, count = std::ceil(std::abs(end - from) / stretch(std::abs(end - from)) * (1 - 1e-9));
      const double to = count > 1 ? from + (end - from) / count : end;
      if (to == from) break;
      work_before = work_;
      const double exchanged_before = exchanged_;
      double error = 0;
      if (Report summed = sum_up_stretch(to, error, total.warnings); !summed.ok()) return summed;
      const double allowed = allowed_error * exchanged_ + work_rounding * energy_scale();
      if (error > allowed && stretch_part_ > shortest_part && bridge_.empty()) {
        // Repeated in shorter stretches; but not across a singular configuration, which is passed only once.
        if (Report moved = follow_to(from); !moved.ok()) return moved;
        if (Report solved = find_rates({.velocity = true, .acceleration = true}); !solved.ok()) return solved;
        work_ = work_before;
        exchanged_ = exchanged_before;
        stretch_part_ /= 4;
        continue;
      }
      if (error > allowed) unsure_ += error;
      if (error < allowed / 64) stretch_part_ = std::min(1.0, 2 * stretch_part_);
    }
  }
  return total;
}

// The warning about the accuracy of the work.
std::string Kinematics::doubt_of_work() const {
  if (!account_ || !(unsure_ > doubtful_error * exchanged_)) return {};
  return fmt::format(
      "work is accurate to {:.2g} J only, of {:.3g} J exchanged: loads change too fast for the motion, or "
      "grow near a singular configuration",
      unsure_, exchanged_);
}

}  // namespace catena
