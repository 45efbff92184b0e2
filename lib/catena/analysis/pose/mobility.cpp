#include "catena/analysis/pose/mobility.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "catena/analysis/pose/jacobian_rank.hpp"
#include "catena/analysis/pose/redundancy.hpp"
#include "catena/analysis/run/name_list.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Phi_q without the rows of drivers.
int rank_without_drivers(const Evaluator& evaluator, std::span<const double> values, int full_rank) {
  const Plan& plan = evaluator.plan();
  if (plan.driver_rows == 0) return full_rank;
  SparsePattern kept{0, plan.columns, {0}, {}};
  std::vector<int> place(at(plan.rows), -1);
  for (int r = 0; r < plan.rows; ++r) {
    const bool driver = evaluator.model().elements[at(plan.row_element[at(r)])].kind == ElementKind::driver;
    if (!driver) place[at(r)] = kept.rows++;
  }
  std::vector<double> kept_values;
  for (int c = 0; c < plan.columns; ++c) {
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k) {
      const int row = place[at(plan.jacobian.row_index[at(k)])];
      if (row < 0) continue;
      kept.row_index.push_back(row);
      kept_values.push_back(values[at(k)]);
    }
    kept.column_start.push_back(static_cast<int>(kept_values.size()));
  }
  RankOptions options;
  options.most_dependencies = options.most_null_vectors = 0;
  return jacobian_rank(evaluator, kept, kept_values, options).rank;
}

// Bodies by their share in the free motions, the most mobile first; bodies that hardly take part are left out.
std::vector<std::string> name_free_bodies(const Evaluator& evaluator, const RankReport& rank) {
  const Plan& plan = evaluator.plan();
  std::map<int, double> share;
  const auto add = [&](int column, double value) {
    const int coordinate = plan.coordinate[at(column)];
    const double size = coordinate % 3 == 2 ? std::abs(value) : std::abs(value) / evaluator.length_scale();
    double& largest = share[coordinate / 3];
    largest = std::max(largest, size);
  };
  const SparseVectors& vectors = rank.right_null_vectors;
  if (vectors.count() > 0) {
    for (int k = 0; k < vectors.count(); ++k) {
      for (int n = vectors.start[at(k)]; n < vectors.start[at(k) + 1]; ++n) {
        add(vectors.index[at(n)], vectors.value[at(n)]);
      }
    }
  } else {
    for (int column : rank.free_columns) add(column, 1);
  }
  std::vector<std::pair<double, int>> order;
  double largest = 0;
  for (const auto& [body, size] : share) {
    order.push_back({size, body});
    largest = std::max(largest, size);
  }
  std::stable_sort(order.begin(), order.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
  std::vector<std::string> names;
  for (const auto& [size, body] : order) {
    if (size < 1e-9 * largest || names.size() == 10) break;
    names.emplace_back(evaluator.model().body_name(plan.model_body[at(body)]));
  }
  return names;
}

}  // namespace

std::string MobilityReport::describe_freedom() const {
  NameList bodies;
  for (const std::string& body : free_bodies) bodies.add(body);
  return fmt::format(
      "{} of {} coordinates are left free by the constraints and drivers; free to move: {}; likely cause: a driver or "
      "joint is missing",
      dof(), columns, bodies.text());
}

MobilityReport analyse_mobility(Evaluator& evaluator, std::span<const double> q) {
  const Plan& plan = evaluator.plan();
  const std::vector<double> values = jacobian_values(evaluator, q);
  const RankReport rank = jacobian_rank(evaluator, plan.jacobian, values);

  MobilityReport report;
  report.columns = plan.columns;
  report.rows = plan.rows;
  report.rank = rank.rank;
  report.rank_without_drivers = rank_without_drivers(evaluator, values, rank.rank);
  if (!rank.warning.empty()) report.warnings.push_back(rank.warning);
  std::vector<double> nu(at(plan.rows));
  if (!rank.dependent_rows.empty()) evaluator.nu(nu);
  for (const RedundantRow& redundant : choose_redundant_rows(plan, rank)) {
    const int element = plan.row_element[at(redundant.row)];
    if (report.redundant_elements.empty() || report.redundant_elements.back() != element) {
      report.redundant_elements.push_back(element);
      report.dependent_on.emplace_back();
    }
    std::vector<int>& others = report.dependent_on.back();
    for (const auto& [row, weight] : redundant.combination) {
      const int other = plan.row_element[at(row)];
      if (other != element && std::find(others.begin(), others.end(), other) == others.end()) others.push_back(other);
    }
    std::sort(others.begin(), others.end());
    std::vector<int>& contradictory = report.contradictory_elements;
    if (!agrees(redundant, nu) && (contradictory.empty() || contradictory.back() != element)) {
      contradictory.push_back(element);
    }
  }
  if (report.dof() > 0) report.free_bodies = name_free_bodies(evaluator, rank);
  return report;
}

std::vector<int> elements_against(const MobilityReport& mobility, const Model& model, int element) {
  for (std::size_t k = 0; k < mobility.redundant_elements.size(); ++k) {
    std::vector<int> all = mobility.dependent_on[k];
    all.push_back(mobility.redundant_elements[k]);
    if (std::find(all.begin(), all.end(), element) == all.end()) continue;
    std::stable_partition(all.begin(), all.end(),
                          [&](int e) { return model.elements[at(e)].kind == ElementKind::driver; });
    std::erase(all, element);
    return all;
  }
  return {};
}

}  // namespace catena
