#include "catena/analysis/contact/holding.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <span>
#include <stdexcept>
#include <utility>

#include "catena/analysis/contact/contact_loads.hpp"
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
constexpr double balanced = 1e-11, balanced_of_forces = 64 * std::numeric_limits<double>::epsilon();
// Friction beyond this is as good as any: the edges of the cone are then along the tangent to this part.
constexpr double most_friction = 1e8;

/// The entries of a vector, or of a matrix column by column.
template <class M>
auto entries_of(M& of) {
  return std::span(of.data(), static_cast<std::size_t>(of.size()));
}

/// A contact: its forces form a cone with two edges.
struct Edge {
  Eigen::VectorXd normal, along;
  double friction;
};

/// A rope with friction on pulleys: one edge for each choice of the side of every pulley on which the tension is
/// larger.
struct RopeEdges {
  Eigen::VectorXd gap;
  std::vector<Eigen::VectorXd> along;
  std::vector<double> exponent;

  /// The force for a largest tension of 1.
  Eigen::VectorXd edge(double u, std::size_t signs) const {
    std::vector<double> tension{0};  // logarithms
    for (std::size_t k = 0; k < along.size(); ++k)
      tension.push_back(tension.back() + ((signs >> k) & 1 ? 1 : -1) * u * exponent[k]);
    const double largest = *std::max_element(tension.begin(), tension.end());
    for (double& t : tension) t = std::exp(t - largest);
    Eigen::VectorXd force = tension[0] * gap;
    for (std::size_t k = 0; k < along.size(); ++k) force += (tension[k + 1] - tension[k]) * along[k];
    return force;
  }
};

// The edges of a rope double with every pulley.
constexpr std::size_t most_held_grips = 8;

/// Forces as columns of the plan, moments divided by the length scale so that they compare.
class ForceColumns {
 public:
  explicit ForceColumns(Evaluator& evaluator)
      : evaluator_(evaluator), length_(evaluator.length_scale()), rest_(at(evaluator.plan().coordinates()), 0.0) {}

  Eigen::VectorXd of(std::span<const double> loads) const {
    const Plan& plan = evaluator_.plan();
    Eigen::VectorXd f(plan.columns);
    for (int c = 0; c < plan.columns; ++c) {
      const int coordinate = plan.coordinate[at(c)];
      f(c) = loads[at(coordinate)] / (coordinate % 3 == 2 ? length_ : 1);
    }
    return f;
  }
  /// Of what is applied, at rest.
  Eigen::VectorXd applied() {
    std::vector<double> loads(rest_.size(), 0.0);
    evaluator_.applied_forces(rest_, loads);
    return of(loads);
  }
  Evaluator::ScalarMotion motion(int element) { return evaluator_.scalar_motion(element, rest_); }
  /// Of a force of one along the motion of an element's value.
  Eigen::VectorXd along(const Evaluator::ScalarMotion& motion) {
    std::vector<double> by(rest_.size(), 0.0);
    scatter_gradient(motion, 1, by);
    return of(by);
  }
  Eigen::VectorXd along(int element) { return along(motion(element)); }

  /// The rows span what constraints cannot balance: forces along the null space of Phi_q are left.
  Eigen::MatrixXd free_of_constraints() {
    const Plan& plan = evaluator_.plan();
    if (plan.rows == 0) return Eigen::MatrixXd::Identity(plan.columns, plan.columns);
    std::vector<double> jacobian(at(plan.trash_slot()) + 1);
    evaluator_.start_jacobian(jacobian);
    evaluator_.jacobian(jacobian);
    Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(plan.columns, plan.rows);
    for (int c = 0; c < plan.columns; ++c) {
      const double unit = plan.coordinate[at(c)] % 3 == 2 ? length_ : 1;
      for (int k = plan.jacobian.column_start[at(c)]; k < plan.jacobian.column_start[at(c) + 1]; ++k)
        rows(c, plan.jacobian.row_index[at(k)]) = jacobian[at(k)] / unit;
    }
    const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors(rows);
    const Eigen::MatrixXd q_full = factors.householderQ();
    return q_full.rightCols(plan.columns - factors.rank()).transpose();
  }

 private:
  Evaluator& evaluator_;
  double length_;
  std::vector<double> rest_;
};

/// What the contacts and ropes of a place can do.
struct ContactCones {
  std::vector<Edge> edges;
  std::vector<RopeEdges> ropes;
};

/// At the evaluator's configuration. A report where a rope has too many pulleys with friction.
Report find_cones(const ContactModel& contacts, Evaluator& evaluator, ForceColumns& columns, ContactCones& cones) {
  for (std::size_t k = 0; k < contacts.points.size(); ++k) {
    const ContactPoint& point = contacts.points[k];
    if (point.kind == ContactKind::grip) continue;  // with its rope
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
    Edge edge{rope.gap, Eigen::VectorXd::Zero(evaluator.plan().columns), point.mu_static};
    if (point.has_friction()) edge.along = columns.along(point.slide);
    cones.edges.push_back(std::move(edge));
  }
  return {};
}

/// Whether the cones balance loads with a part u of their friction.
class HoldingTest {
 public:
  HoldingTest(ContactCones cones, ForceColumns& columns)
      : cones_(std::move(cones)), free_(columns.free_of_constraints()) {
    const Eigen::VectorXd loads = columns.applied();
    b_ = free_ * loads;
    enough_ = balanced * loads.norm();
    columns_ = 2 * cones_.edges.size();
    for (const RopeEdges& rope : cones_.ropes) columns_ += std::size_t{1} << rope.along.size();
  }

  bool operator()(double u) const {
    const std::vector<Edge>& edges = cones_.edges;
    Eigen::MatrixXd A(free_.rows(), static_cast<Eigen::Index>(columns_));
    Eigen::Index c = 2 * static_cast<Eigen::Index>(edges.size());
    for (const RopeEdges& rope : cones_.ropes) {
      for (std::size_t signs = 0; signs < std::size_t{1} << rope.along.size(); ++signs) {
        const Eigen::VectorXd edge = free_ * rope.edge(u, signs);
        A.col(c++) = edge / std::max(edge.norm(), 1e-300);
      }
    }
    for (std::size_t k = 0; k < edges.size(); ++k) {
      for (int s = 0; s < 2; ++s) {
        const double slope = (s == 0 ? u : -u) * edges[k].friction;
        const Eigen::VectorXd edge = free_ * (edges[k].normal + slope * edges[k].along);
        A.col(2 * static_cast<Eigen::Index>(k) + s) = edge / std::max(edge.norm(), 1e-300);
      }
    }
    Eigen::VectorXd sizes(A.cols());
    const double left = nonnegative_least_squares(entries_of(A), entries_of(b_), entries_of(sizes));
    return left <= enough_ + balanced_of_forces * sizes.norm();
  }

 private:
  ContactCones cones_;
  Eigen::MatrixXd free_;
  Eigen::VectorXd b_;
  double enough_ = 0;
  std::size_t columns_ = 0;
};

/// The smallest part of friction that holds; nothing: none does, however large.
std::optional<double> least_utilisation(const HoldingTest& holds) {
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

}  // namespace

ContactHolding::ContactHolding(std::shared_ptr<const Model> model) : contacts_(contact_points(std::move(model))) {
  PlanOptions options;
  for (const ContactPoint& point : contacts_.points) {
    if (point.kind == ContactKind::joint) {
      throw std::invalid_argument(
          fmt::format("whether friction holds can be asked of contacts; that of joint \"{}\" is not treated there",
                      contacts_.model->element_name(point.joint)));
    }
    if (point.is_elastic_grip()) {
      throw std::invalid_argument(fmt::format(
          "whether friction holds can be asked of contacts and ropes without stiffness; that of rope \"{}\" "
          "has one",
          contacts_.model->element_name(point.element)));
    }
    if (point.kind != ContactKind::grip) options.released_elements.push_back(point.element);
    if (point.kind == ContactKind::grip) options.released_elements.push_back(point.slide);
    if (point.kind != ContactKind::grip && point.has_friction()) options.released_elements.push_back(point.slide);
  }
  evaluator_ = std::make_unique<Evaluator>(Plan::make(*contacts_.model, options), *contacts_.model);
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
  if (holding.ok()) holding.utilisation = least_utilisation(HoldingTest(std::move(cones), forces));
  return holding;
}

}  // namespace catena
