#include "catena/analysis/contact/holding/holding.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>
#include <vector>

#include "catena/analysis/contact/holding/holding_cones.hpp"
#include "catena/analysis/pose/assemble.hpp"
#include "catena/analysis/run/rope_ways_at.hpp"
#include "catena/analysis/run/state_conversion.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/assembly/rope_ways.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/rank/nonnegative_least_squares.hpp"

namespace catena {
namespace {

// Of the loads, and of the forces that balance them: what is left unbalanced by rounding. Where places wedge a body the
// forces grow without bound as friction falls to the least that holds.
constexpr double balanced = 1e-11, balanced_of_forces = thresholds::sum_rounding;
// Friction beyond this is as good as any: the edges of the cone are then along the tangent to this part.
constexpr double most_friction = 1e8;

/// The entries of a vector, or of a matrix column by column.
template <class M>
auto entries_of(M& of) {
  return std::span(of.data(), static_cast<std::size_t>(of.size()));
}

Eigen::Map<const Eigen::VectorXd> vector_of(const ForceColumn& force) {
  return {force.data(), static_cast<Eigen::Index>(force.size())};
}

/// The rows span what constraints cannot balance: forces along the null space of Phi_q are left.
Eigen::MatrixXd free_of(const std::vector<ForceColumn>& constraints, Eigen::Index columns) {
  if (constraints.empty()) return Eigen::MatrixXd::Identity(columns, columns);
  Eigen::MatrixXd rows(columns, static_cast<Eigen::Index>(constraints.size()));
  for (std::size_t r = 0; r < constraints.size(); ++r)
    rows.col(static_cast<Eigen::Index>(r)) = vector_of(constraints[r]);
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(rows);
  const Eigen::MatrixXd q_full = factors.householderQ();
  return q_full.rightCols(columns - factors.rank()).transpose();
}

/// Whether the cones balance loads with a part u of their friction.
class HoldingTest {
 public:
  HoldingTest(ContactCones cones, ForceColumns& columns) : cones_(std::move(cones)) {
    const ForceColumn applied = columns.applied();
    const auto loads = vector_of(applied);
    free_ = free_of(cones_.constraints, loads.size());
    b_ = free_ * loads;
    enough_ = balanced * loads.norm();
    columns_ = 2 * cones_.edges.size() + HeldJoint::edges * cones_.joints.size();
    for (const RopeEdges& rope : cones_.ropes) columns_ += std::size_t{1} << rope.along.size();
  }
  std::vector<HeldJoint>& joints() { return cones_.joints; }

  /// Leaves the forces that were found, of joints the multipliers.
  bool operator()(double u) {
    Eigen::MatrixXd A(free_.rows(), static_cast<Eigen::Index>(columns_));
    std::vector<double> unit;  // of the sizes
    const auto add = [&](const ForceColumn& force) {
      const Eigen::VectorXd edge = free_ * vector_of(force);
      unit.push_back(std::max(edge.norm(), 1e-300));
      A.col(static_cast<Eigen::Index>(unit.size()) - 1) = edge / unit.back();
    };
    for (const HeldJoint& joint : cones_.joints) {
      for (std::size_t k = 0; k < HeldJoint::edges; ++k) add(joint.edge(k, u));
    }
    for (const Edge& edge : cones_.edges) {
      for (const double side : {u, -u}) add(sum_of(1, edge.normal, side * edge.friction, edge.along));
    }
    for (const RopeEdges& rope : cones_.ropes) {
      for (std::size_t signs = 0; signs < std::size_t{1} << rope.along.size(); ++signs) add(rope.edge(u, signs));
    }
    Eigen::VectorXd sizes(A.cols());
    const double left = nonnegative_least_squares(entries_of(A), entries_of(b_), entries_of(sizes));
    const bool held = left <= enough_ + balanced_of_forces * sizes.norm();
    pressed_.clear();
    for (std::size_t j = 0; j < cones_.joints.size(); ++j) {
      std::array<double, HeldJoint::edges> size{};
      for (std::size_t k = 0; k < HeldJoint::edges; ++k) {
        const std::size_t c = HeldJoint::edges * j + k;
        size[k] = sizes[static_cast<Eigen::Index>(c)] / unit[c];
      }
      pressed_.push_back(cones_.joints[j].force(size));
    }
    return held;
  }
  /// The slopes of joints become those at the forces that were found last.
  void press() {
    for (std::size_t j = 0; j < cones_.joints.size(); ++j) cones_.joints[j].press(pressed_[j]);
  }

  /// The slopes of joints at the least forces that balance the loads, whatever friction that takes. Whether these are
  /// the only ones.
  bool press_as_balanced() {
    const auto count = static_cast<Eigen::Index>(3 * cones_.joints.size() + 2 * cones_.edges.size());
    Eigen::MatrixXd A(free_.rows(), count);
    Eigen::Index c = 0;
    for (const HeldJoint& joint : cones_.joints) {
      for (const ForceColumn* force : {&joint.part(0), &joint.part(1), &joint.along()})
        A.col(c++) = free_ * vector_of(*force);
    }
    for (const Edge& edge : cones_.edges) {
      A.col(c++) = free_ * vector_of(edge.normal);
      A.col(c++) = free_ * vector_of(edge.along);
    }
    const Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors(A);
    const Eigen::VectorXd forces = factors.solve(-b_);
    for (std::size_t j = 0; j < cones_.joints.size(); ++j) {
      const auto first = static_cast<Eigen::Index>(3 * j);
      cones_.joints[j].press({forces[first], forces[first + 1]});
    }
    return cones_.ropes.empty() && factors.rank() == count;
  }

 private:
  ContactCones cones_;
  Eigen::MatrixXd free_;
  Eigen::VectorXd b_;
  double enough_ = 0;
  std::size_t columns_ = 0;
  std::vector<std::array<double, 2>> pressed_;
};

/// The smallest part of friction that holds, of joints with their slopes; nothing: none does, however large.
std::optional<double> least_with_slopes(HoldingTest& holds) {
  if (holds(0)) return 0;
  double low = 0, high = 1;
  while (!holds(high)) {
    low = high;
    high *= 4;
    if (high > most_friction) return {};
  }
  while (high - low > 1e-14 * high) {
    const double middle = low + (high - low) / 2;
    if (middle == low || middle == high) break;
    (holds(middle) ? high : low) = middle;
  }
  return high;
}

/// From these slopes on, each the one at the forces found with that before, until u falls by rounding alone: each turn
/// leaves a part of the way, about a tenth at most where statics determines all but one force.
std::optional<double> least_from_slopes(HoldingTest& holds) {
  std::optional<double> least = least_with_slopes(holds);
  for (int turn = 0; least && *least > 0 && turn < thresholds::most_bisections; ++turn) {
    holds(*least);
    holds.press();
    const std::optional<double> next = least_with_slopes(holds);
    if (!next || *next >= *least * (1 - thresholds::carried_rounding)) break;
    least = next;
  }
  return least;
}

/// Where statics does not determine the forces, the slopes of up to two joints begin at all pairs, of others at some.
std::optional<double> least_utilisation(HoldingTest& holds) {
  std::vector<HeldJoint>& joints = holds.joints();
  if (joints.empty()) return least_with_slopes(holds);
  const bool determined = holds.press_as_balanced();
  std::optional<double> least = least_from_slopes(holds);
  constexpr int slopes = HeldJoint::slopes;
  const int starts = determined ? 0 : joints.size() == 1 ? slopes : slopes * slopes;
  for (int start = 0; start < starts; ++start) {
    for (std::size_t j = 0; j < joints.size(); ++j) {
      const int n = static_cast<int>(j);
      joints[j].press_at(n == 0 ? start : n == 1 ? start / slopes : start * (2 * n + 1) + start / slopes + n);
    }
    const std::optional<double> found = least_from_slopes(holds);
    if (found && (!least || *found < *least)) least = found;
  }
  return least;
}

}  // namespace

ContactHolding::ContactHolding(std::shared_ptr<const Model> model) : contacts_(contact_points(std::move(model))) {
  PlanOptions options;
  for (const ContactPoint& point : contacts_.points) {
    if (point.is_elastic_grip()) {
      throw std::invalid_argument(fmt::format(
          "whether friction holds can be asked of contacts, joints and ropes without stiffness; that of rope \"{}\" "
          "has one",
          contacts_.model->element_name(point.element)));
    }
    if (point.kind != ContactKind::grip) options.released_elements.push_back(point.element);
    if (point.kind == ContactKind::grip) options.released_elements.push_back(point.slide);
    if (point.kind != ContactKind::grip && point.has_friction()) options.released_elements.push_back(point.slide);
  }
  evaluator_ = std::make_unique<Evaluator>(Plan::make(*contacts_.model, options), *contacts_.model, evaluation_);
}

// The grips of ropes as these lie there.
void ContactHolding::lay_grips(const SystemState& state) {
  if (contacts_.ropes.empty()) return;
  std::vector<RopeRoute> routes = rope_routes(*contacts_.model);
  if (!state.ropes.empty()) take_up(routes, state);
  for (RopeRoute& route : routes) {
    const std::vector<Frame<double>> frames = frames_of(*evaluator_, route);
    if (state.ropes.empty()) {
      find_off(*contacts_.model, route, frames);
    } else {
      go_on(*contacts_.model, route, frames);
    }
  }
  const std::shared_ptr<const Model> before = contacts_.model;  // the evaluator's until it has the next one
  catena::lay_grips(contacts_, routes, [&](const RopeRoute& route) { return frames_of(*evaluator_, route); });
  evaluator_->set_model(*contacts_.model);
}

Holding ContactHolding::find(const SystemState& state, std::vector<double>& q) {
  Holding holding;
  const int columns = evaluator_->plan().columns;
  if (columns > most_held_coordinates) {
    holding.status = Status::refused;
    holding.message = fmt::format("whether friction holds is asked of at most {} coordinates; this scene has {}",
                                  most_held_coordinates, columns);
    return holding;
  }
  q = configuration_of(*evaluator_, state);
  evaluator_->set_time(state.t);
  if (const AssemblyOutcome assembled = Assembler(*evaluator_).assemble(q); !assembled.ok()) {
    static_cast<Report&>(holding) = assembled;
    return holding;
  }
  evaluator_->set_configuration(q);
  lay_grips(state);
  evaluator_->set_configuration(q);
  ForceColumns forces(*evaluator_);
  ContactCones cones;
  static_cast<Report&>(holding) = find_cones(contacts_, *evaluator_, forces, cones);
  if (!holding.ok()) return holding;
  HoldingTest holds(std::move(cones), forces);
  holding.utilisation = least_utilisation(holds);
  return holding;
}

}  // namespace catena
