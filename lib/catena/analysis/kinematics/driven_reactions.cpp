#include "catena/analysis/kinematics/driven_reactions.hpp"

#include <fmt/format.h>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
// Q - M qdd by columns, at the evaluator's configuration.
void DrivenReactions::find_loads(std::span<const double> qd, std::span<const double> qdd) {
  const Model& model = evaluator_.model();
  applied_.resize(at(plan_.coordinates()));
  evaluator_.applied_forces(qd, applied_);
  loads_.resize(at(plan_.columns));
  for (int c = 0; c < plan_.columns; ++c) {
    const int coordinate = plan_.coordinate[at(c)];
    const auto& body = model.bodies[at(plan_.model_body[at(coordinate / 3)])];
    const double inertia = coordinate % 3 == 2 ? body.inertia : body.mass;
    loads_[at(c)] = applied_[at(coordinate)] - inertia * qdd[at(coordinate)];
  }
}

Report DrivenReactions::solve(const DrivenInstant& now) {
  Report report;
  lambda_.resize(at(plan_.rows));
  find_loads(now.qd, now.qdd);
  if (!solver_.solve_multipliers(loads_, lambda_)) {
    report.status = Status::singular;
    report.message = fmt::format("reactions are not determined at t = {:.12g} s", now.t);
    return report;
  }
  if (plan_.rows > plan_.columns) choose_least(now);
  return friction_.any() ? add_friction(now) : report;
}

Report DrivenReactions::add_friction(const DrivenInstant& now) {
  Report report;
  if (!ambiguity_.empty()) {
    report.status = Status::refused;
    report.message = fmt::format(
        "friction needs reactions that are unique, but {}; take away what repeats, or friction", ambiguity_);
    return report;
  }
  columns_.resize(loads_.size());
  const auto solve = [&](std::span<const double> loads, std::span<double> lambda) {
    for (std::size_t c = 0; c < columns_.size(); ++c) columns_[c] = loads[at(plan_.coordinate[c])];
    solver_.solve_multipliers(columns_, lambda);
  };
  std::fill(applied_.begin(), applied_.end(), 0.0);
  if (Report found = friction_.find(now.t, now.qd, lambda_, applied_, solve); !found.ok()) return found;
  for (std::size_t c = 0; c < loads_.size(); ++c) loads_[c] += applied_[at(plan_.coordinate[c])];
  solver_.solve_multipliers(loads_, lambda_);
  friction_.finish(lambda_);
  return report;
}

// The least multipliers for loads_, with the factors at hand; the part of the loads that they leave unbalanced.
double DrivenReactions::solve_least(std::span<double> lambda) {
  for (int c = 0; c < plan_.columns; ++c) applied_[at(plan_.coordinate[at(c)])] = loads_[at(c)];
  return minimum_norm_->solve(applied_, lambda);
}

// Where equations depend on each other. Multipliers that do not balance the loads are rejected.
void DrivenReactions::choose_least(const DrivenInstant& now) {
  if (!minimum_norm_) minimum_norm_.emplace(evaluator_);
  evaluator_.set_configuration(now.q);
  if (!minimum_norm_->factorize()) return;
  least_lambda_.assign(lambda_.size(), 0.0);
  if (!(solve_least(least_lambda_) <= thresholds::no_force)) return;
  lambda_.swap(least_lambda_);
  ambiguity_ = minimum_norm_->ambiguity();
}

void DrivenReactions::add_remarks(std::vector<std::string>& warnings) const {
  if (!ambiguity_.empty()) warnings.push_back(ambiguity_);
  friction_.add_remarks(warnings);
  if (limit_rows_ == 0) return;
  std::string remark = fmt::format(
      "at t = {:.12g} s{} the mechanism is in a singular configuration: loads and reactions there are the limit of the "
      "motion",
      limit_t_, limit_rows_ > 1 ? fmt::format(" and in {} more rows", limit_rows_ - 1) : "");
  if (!without_limit_.empty()) {
    remark += fmt::format("; those of {} grow without bound towards it and are left empty", without_limit_);
  }
  warnings.push_back(std::move(remark));
}

}  // namespace catena
