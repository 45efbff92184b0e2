// Kinematics with more equations than coordinates: the choice of those that are solved with, and the check of the
// others.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/pose/jacobian_rank.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Residual of redundant equations, in length scales or rad, above which they contradict the others.
constexpr double contradiction = 1e-8;
// Pivots of blocks above this part of the largest that they have been determine rates to that accuracy.
constexpr double well_determined = 1e-3;
constexpr std::size_t most_names = 6;  // in a message

}  // namespace

// Of more equations than needed an independent set, then the best one.
bool Kinematics::choose_rows(std::span<const double> q) {
  const std::vector<double> values = jacobian_values(evaluator_, q);
  RankOptions options;
  options.most_dependencies = options.most_null_vectors = 0;
  RankReport rank = jacobian_rank(evaluator_, plan_->jacobian, values, options);
  if (rank.rank < plan_->columns) return false;
  solver_.use_rows(std::move(rank.independent_rows));
  solver_.exchange_rows(q);
  return true;
}

// Where the equations in use come near to dependence, others may be better conditioned. False: they are not.
bool Kinematics::choose_better_rows() {
  if (plan_->rows == plan_->columns) return false;
  evaluator_.set_time(t_);
  const bool better = solver_.exchange_rows(q_);
  chosen_rcond_ = solver_.factor_at(q_);
  if (better) {
    margins_.clear();
    largest_margins_.clear();
    remember_margins();
  }
  return better;
}

// Equations that are not solved with must follow from the others at every instant, not only where they were found
// redundant.
Report Kinematics::check_redundant_rows() {
  int worst = -1;
  if (!(solver_.redundant_residual(solver_.phi(), &worst) > contradiction)) return {};
  return contradicts(worst, fmt::format("it misses by {:.3g} {}", std::abs(solver_.phi()[at(worst)]),
                                        plan_->row_is_angle[at(worst)] ? "rad" : "m"));
}

// The same for velocities and accelerations: drivers may agree in place and differ in speed. `allowed`: part of the
// largest rates. Unless `in_words`, only the status is set.
Report Kinematics::check_redundant_rates(double allowed, bool in_words) {
  if (plan_->rows == plan_->columns || on_bridge_) return {};
  // Near a singular configuration rates are as accurate as the equations in use allow, which may be no digit at all.
  for (std::size_t k = 0; k < margins_.size() && k < largest_margins_.size(); ++k) {
    if (std::abs(margins_[k].pivot) < well_determined * largest_margins_[k]) return {};
  }
  const std::span<const double> values = solver_.jacobian().first(at(plan_->trash_slot()));
  rest_.resize(at(plan_->rows));
  rates_.resize(at(plan_->columns));
  const double speed = solver_.distance(qd_, nothing_, nullptr);
  const auto check = [&](std::span<const double> known, double least, const char* what, const char* per) -> Report {
    const double scale = std::max({solver_.row_norm(rest_), solver_.distance(known, nothing_, nullptr), least});
    for (std::size_t c = 0; c < rates_.size(); ++c) rates_[c] = -known[at(plan_->coordinate[c])];
    multiply_add(plan_->jacobian, values, rates_, rest_);
    int worst = -1;
    if (!(solver_.redundant_residual(rest_, &worst) > allowed * scale)) return {};
    if (!in_words) {
      Report report;
      report.status = Status::inconsistent;
      return report;
    }
    return contradicts(worst, fmt::format("its {} misses by {:.3g} {}/{}", what, std::abs(rest_[at(worst)]),
                                          plan_->row_is_angle[at(worst)] ? "rad" : "m", per));
  };
  if (has_velocity_) {
    evaluator_.nu(rest_);
    if (const Report report = check(qd_, 0, "velocity", "s"); !report.ok()) return report;
  }
  if (!has_acceleration_) return {};
  evaluator_.gamma(qd_, rest_);
  return check(qdd_, speed * speed, "acceleration", "s^2");
}

// `inconsistent`: names the element of an equation and the elements that it contradicts.
Report Kinematics::contradicts(int row, const std::string& how) {
  const int element = plan_->row_element[at(row)];
  const MobilityReport mobility = analyse_mobility(evaluator_, q_);
  std::vector<int> others;
  for (std::size_t k = 0; k < mobility.redundant_elements.size(); ++k) {
    std::vector<int> all = mobility.dependent_on[k];
    all.push_back(mobility.redundant_elements[k]);
    if (std::find(all.begin(), all.end(), element) == all.end()) continue;
    // Drivers first: they are the most likely cause of a contradiction.
    std::stable_partition(all.begin(), all.end(),
                          [&](int e) { return model_->elements[at(e)].kind == ElementKind::driver; });
    std::erase(all, element);
    others = std::move(all);
    break;
  }
  std::string names;
  for (std::size_t k = 0; k < others.size() && k < most_names; ++k) {
    names += fmt::format("{}\"{}\"", k ? ", " : "", model_->element_name(others[k]));
  }
  if (others.size() > most_names) names += ", ...";
  Report report;
  report.status = Status::inconsistent;
  report.message = fmt::format("{} \"{}\" contradicts {} at t = {:.12g} s: {}", model_->element_type(element),
                               model_->element_name(element), names.empty() ? "the other constraints" : names, t_, how);
  return report;
}

}  // namespace catena
