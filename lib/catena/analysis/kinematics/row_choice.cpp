#include "catena/analysis/kinematics/row_choice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/pose/jacobian_rank.hpp"
#include "catena/analysis/run/name_list.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
bool RowChoice::choose(std::span<const double> q) {
  const std::vector<double> values = jacobian_values(evaluator_, q);
  RankOptions options;
  options.most_dependencies = options.most_null_vectors = 0;
  RankReport rank = jacobian_rank(evaluator_, plan_.jacobian, values, options);
  if (rank.rank < plan_.columns) return false;
  solver_.use_rows(std::move(rank.independent_rows));
  solver_.exchange_rows(q);
  return true;
}

bool RowChoice::choose_better(std::span<const double> q) {
  const bool better = solver_.exchange_rows(q);
  note_condition(q);
  return better;
}

void RowChoice::name_redundant(const MobilityReport& mobility) {
  mobility_ = mobility.mobility();
  for (int element : mobility.redundant_elements) names_.push_back(evaluator_.model().element_name(element));
}

const char* RowChoice::unit_of(int row) const { return plan_.row_is_angle[at(row)] ? "rad" : "m"; }

Report RowChoice::check_places(const DrivenInstant& now) {
  int worst = -1;
  if (!(solver_.redundant_residual(solver_.phi(), &worst) > thresholds::contradiction)) return {};
  return contradicts(now, worst,
                     fmt::format("it misses by {:.3g} {}", std::abs(solver_.phi()[at(worst)]), unit_of(worst)));
}

Report RowChoice::check_rates(const DrivenInstant& now, double allowed, bool in_words) {
  const std::span<const double> values = solver_.jacobian().first(at(plan_.trash_slot()));
  rest_.resize(at(plan_.rows));
  rates_.resize(at(plan_.columns));
  const double speed = now.qd.empty() ? 0 : solver_.rate_size(now.qd);
  const auto check = [&](std::span<const double> known, double least, const char* quantity, const char* per) -> Report {
    const double scale = std::max({solver_.row_norm(rest_), solver_.rate_size(known), least});
    for (std::size_t c = 0; c < rates_.size(); ++c) rates_[c] = -known[at(plan_.coordinate[c])];
    multiply_add(plan_.jacobian, values, rates_, rest_);
    int worst = -1;
    if (!(solver_.redundant_residual(rest_, &worst) > allowed * scale)) return {};
    if (!in_words) {
      Report report;
      report.status = Status::inconsistent;
      return report;
    }
    return contradicts(
        now, worst,
        fmt::format("its {} misses by {:.3g} {}/{}", quantity, std::abs(rest_[at(worst)]), unit_of(worst), per));
  };
  if (!now.qd.empty()) {
    evaluator_.nu(rest_);
    if (const Report report = check(now.qd, 0, "velocity", "s"); !report.ok()) return report;
  }
  if (now.qdd.empty()) return {};
  evaluator_.gamma(now.qd, rest_);
  return check(now.qdd, speed * speed, "acceleration", "s^2");
}

// `inconsistent`: names the element of an equation and the elements that it contradicts.
Report RowChoice::contradicts(const DrivenInstant& now, int row, const std::string& how) {
  const Model& model = evaluator_.model();
  const int element = plan_.row_element[at(row)];
  const std::string names = element_names(model, elements_against(analyse_mobility(evaluator_, now.q), model, element));
  Report report;
  report.status = Status::inconsistent;
  report.message =
      fmt::format("{} \"{}\" contradicts {} at t = {:.12g} s: {}", model.element_type(element),
                  model.element_name(element), names.empty() ? "the other constraints" : names, now.t, how);
  return report;
}

}  // namespace catena
