#include "catena/analysis/contact/holding/holding_cones.hpp"

#include <fmt/format.h>

#include <utility>

#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// The edges of a rope double with every pulley.
constexpr std::size_t most_held_grips = 8;

/// Takes the multipliers of joints with friction from the constraints.
void find_joints(const ContactModel& contacts, const Evaluator& evaluator, ForceColumns& columns, ContactCones& cones) {
  const Plan& plan = evaluator.plan();
  cones.constraints = columns.of_constraints();
  for (const ContactPoint& point : contacts.points) {
    if (point.kind != ContactKind::joint) continue;
    const std::size_t row = at(plan.element_row[at(point.joint)]);
    cones.joints.emplace_back(cones.constraints[row], cones.constraints[row + 1], columns.along(point.slide), point,
                              plan.row_is_angle[row + 1] != 0);
    for (const std::size_t r : {row, row + 1}) cones.constraints[r].assign(cones.constraints[r].size(), 0.0);
  }
}

}  // namespace

Report find_cones(const ContactModel& contacts, const Evaluator& evaluator, ForceColumns& columns,
                  ContactCones& cones) {
  for (std::size_t k = 0; k < contacts.points.size(); ++k) {
    const ContactPoint& point = contacts.points[k];
    if (point.kind == ContactKind::grip || point.kind == ContactKind::joint) continue;  // with its rope; below
    const Evaluator::ScalarMotion gap = columns.motion(point.element);
    if (gap.value > thresholds::given_depth * evaluator.length_scale()) continue;
    RopeEdges rope{columns.along(gap), {}, {}};
    for (const ContactPoint& grip : contacts.points) {
      if (grip.kind != ContactKind::grip || grip.rope->head != static_cast<int>(k) || !grip.has_friction()) continue;
      rope.along.push_back(columns.along(grip.slide));
      rope.exponent.push_back(std::max(grip.lines->exponent(evaluator, {}).f, 0.0));
    }
    if (rope.along.size() > most_held_grips) {
      Report report;
      report.status = Status::refused;
      report.message =
          fmt::format("whether friction holds is asked of ropes with friction on at most {} pulleys; \"{}\" has {}",
                      most_held_grips, contacts.model->element_name(point.element), rope.along.size());
      return report;
    }
    if (!rope.along.empty()) {
      cones.ropes.push_back(std::move(rope));
      continue;
    }
    Edge edge{rope.gap, ForceColumn(rope.gap.size(), 0.0), point.mu_static};
    if (point.has_friction()) edge.along = columns.along(point.slide);
    cones.edges.push_back(std::move(edge));
  }
  find_joints(contacts, evaluator, columns, cones);
  return {};
}

std::vector<ForceColumn> ForceColumns::of_constraints() {
  const Plan& plan = evaluator_.plan();
  std::vector<double> jacobian(at(plan.trash_slot()) + 1);
  evaluator_.start_jacobian(jacobian);
  evaluator_.jacobian(jacobian);
  std::vector<ForceColumn> rows(at(plan.rows), ForceColumn(at(plan.columns), 0.0));
  for (int c = 0; c < plan.columns; ++c) {
    const double unit = plan.coordinate[at(c)] % 3 == 2 ? length_ : 1;
    for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k)
      rows[at(plan.jacobian.row_index[at(k)])][at(c)] = jacobian[at(k)] / unit;
  }
  return rows;
}

}  // namespace catena
