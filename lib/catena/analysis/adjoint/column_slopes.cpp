#include "catena/analysis/adjoint/column_slopes.hpp"

#include <algorithm>
#include <set>

#include "catena/base/at.hpp"
#include "catena/columns/column_names.hpp"
#include "catena/columns/own_columns.hpp"
#include "catena/model/model_part.hpp"

namespace catena {
namespace {

/// Whether the column is made of all bodies.
bool reads_all(ColumnKind kind) { return kind >= ColumnKind::kinetic || kind == ColumnKind::residual; }

void lift(std::span<const double> values, std::vector<DesignScalar>& out) {
  for (std::size_t k = 0; k < out.size(); ++k) out[k] = k < values.size() ? values[k] : 0.0;
}

}  // namespace

ColumnSlopes::ColumnSlopes(const Model& model, const ColumnSet& columns, std::vector<DesignMechanism*> groups,
                           int parameters, ContactSlopes contacts)
    : columns_(columns), groups_(std::move(groups)), parameters_(at(parameters)), contacts_(std::move(contacts)) {
  const Plan& plan = groups_.front()->plan();
  for (auto* values : {&q_, &qd_, &qdd_}) values->resize(at(plan.coordinates()));
  lambda_.resize(at(plan.rows));
  still_.resize(columns.size());
  moved_.resize(columns.size());
  collect(model);
  slope_.resize(columns.size() * variables_.size());
  explicit_.resize(columns.size() * parameters_);
}

void ColumnSlopes::collect(const Model& model) {
  const Plan& plan = groups_.front()->plan();
  std::set<int> bodies, elements;
  OwnInputs inputs(model.own_columns.size());
  for (const ColumnInfo& info : columns_.info()) {
    std::vector<NamedColumn> named;
    static_cast<void>(find_columns(model, info.name, named));  // they have been found before
    for (const NamedColumn& one : named) {
      if (one.column.kind == ColumnKind::own) static_cast<void>(find_own_inputs(model, one.column.index, inputs));
      visit_read_columns(inputs, one.column, [&](const Column& read) {
        if (reads_all(read.kind)) {
          for (int b = 0; b < plan.moving; ++b) bodies.insert(b);
          return;
        }
        if (is_reaction(read.kind)) elements.insert(read.index);
        if (read.kind == ColumnKind::time) return;
        visit_read_bodies(model, read, [&](int body) {
          if (body >= 0 && plan.plan_body[at(body)] < plan.moving) bodies.insert(plan.plan_body[at(body)]);
        });
      });
    }
  }
  const Needs& needs = columns_.needs();
  for (const int body : bodies) {
    for (int c = 3 * body; c < 3 * body + 3; ++c) {
      if (plan.column[at(c)] < 0) continue;
      variables_.push_back({Level::q, c});
      variables_.push_back({Level::qd, c});
      if (needs.acceleration) variables_.push_back({Level::qdd, c});
    }
  }
  std::set<int> rows;
  for (const int element : elements) {
    const int first = plan.element_row[at(element)];
    for (int r = first; first >= 0 && r < plan.rows && plan.row_element[at(r)] == element; ++r) rows.insert(r);
  }
  if (needs.multipliers) rows.insert(contacts_.rows.begin(), contacts_.rows.end());
  for (const int row : rows) variables_.push_back({Level::lambda, row});
}

std::vector<DesignScalar>& ColumnSlopes::values(Level level) {
  return level == Level::q ? q_ : level == Level::qd ? qd_ : level == Level::qdd ? qdd_ : lambda_;
}

void ColumnSlopes::evaluate(std::size_t group, const Snapshot& snapshot, std::vector<DesignScalar>& out) {
  DesignMechanism& mechanism = *groups_[group];
  if (snapshot.qd.empty())
    mechanism.set_state(q_);
  else
    mechanism.set_state(q_, qd_);
  const DesignContacts* const contacts = contacts_.at ? contacts_.at(group, lambda_) : nullptr;
  columns_.differentiate(DesignState(mechanism, snapshot, qdd_, lambda_, contacts), out);
}

void ColumnSlopes::look(const Snapshot& snapshot) {
  lift(snapshot.qd, qd_);
  lift(snapshot.qdd, qdd_);
  lift(snapshot.lambda, lambda_);
  for (std::size_t g = groups_.size(); g-- > 0;) {
    groups_[g]->lift_configuration(snapshot.q, q_);
    evaluate(g, snapshot, still_);
    for (std::size_t k = 0; k < still_.size(); ++k) {
      for (std::size_t p = g * parameters_at_once; p < std::min(parameters_, (g + 1) * parameters_at_once); ++p)
        explicit_[k * parameters_ + p] = still_[k].d[p - g * parameters_at_once];
    }
  }
  // The last ones were those of the first group: what variables change is what they add to its derivatives.
  for (std::size_t first = 0; first < variables_.size(); first += parameters_at_once) {
    const std::size_t count = std::min<std::size_t>(parameters_at_once, variables_.size() - first);
    for (std::size_t s = 0; s < count; ++s) {
      const Variable& variable = variables_[first + s];
      values(variable.level)[at(variable.index)].d[s] = 1;
    }
    evaluate(0, snapshot, moved_);
    for (std::size_t s = 0; s < count; ++s) {
      const Variable& variable = variables_[first + s];
      values(variable.level)[at(variable.index)].d[s] = 0;
      for (std::size_t k = 0; k < moved_.size(); ++k)
        slope_[k * variables_.size() + first + s] = moved_[k].d[s] - still_[k].d[s];
    }
  }
}

void ColumnSlopes::add(std::size_t column, double weight, StateSlopes& slopes) const {
  for (std::size_t v = 0; v < variables_.size(); ++v) {
    const Variable& variable = variables_[v];
    std::vector<double>& target = variable.level == Level::q     ? slopes.by_q
                                  : variable.level == Level::qd  ? slopes.by_qd
                                  : variable.level == Level::qdd ? slopes.by_qdd
                                                                 : slopes.by_lambda;
    target[at(variable.index)] += weight * slope_[column * variables_.size() + v];
  }
  for (std::size_t p = 0; p < parameters_; ++p) slopes.by_p[p] += weight * explicit_[column * parameters_ + p];
}

StateSlopes ColumnSlopes::empty() const {
  const std::vector<double> coordinates(q_.size(), 0.0), rows(lambda_.size(), 0.0);
  const Needs& needs = columns_.needs();
  return {coordinates, coordinates, needs.acceleration ? coordinates : std::vector<double>{},
          needs.multipliers ? rows : std::vector<double>{}, std::vector<double>(parameters_, 0.0)};
}

bool ColumnSlopes::reads_multipliers(std::size_t column) const {
  for (std::size_t v = 0; v < variables_.size(); ++v) {
    if (variables_[v].level == Level::lambda && slope_[column * variables_.size() + v] != 0) return true;
  }
  return false;
}

}  // namespace catena
