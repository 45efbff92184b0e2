// ColumnSet::evaluate: the value of every kind of column.
#include <optional>
#include <stdexcept>
#include <string>

#include "catena/columns/attachment.hpp"
#include "catena/columns/column_set.hpp"
#include "catena/columns/energy.hpp"
#include "catena/columns/reaction.hpp"
#include "catena/columns/spring.hpp"
#include "catena/elements/all.hpp"

namespace catena {
namespace {

/// Values of one row. Neighbouring columns mostly show the same element: what was computed last is kept.
class RowValues {
 public:
  RowValues(const Snapshot& snapshot, bool only_angles)
      : s_(snapshot), evaluator_(snapshot.evaluator), only_angles_(only_angles) {}

  double value(const Column& column) {
    switch (column.kind) {
      case ColumnKind::time:
        return s_.t;
      case ColumnKind::residual:
        return only_angles_ ? s_.residual / evaluator_.length_scale() : s_.residual;
      case ColumnKind::x:
        return position(column).x;
      case ColumnKind::y:
        return position(column).y;
      case ColumnKind::angle:
        return frame(column).phi;
      case ColumnKind::vx:
        return velocity(column).x;
      case ColumnKind::vy:
        return velocity(column).y;
      case ColumnKind::omega:
        return s_.qd[coordinate(column) + 2];
      case ColumnKind::ax:
        return acceleration(column).x;
      case ColumnKind::ay:
        return acceleration(column).y;
      case ColumnKind::alpha:
        return s_.qdd[coordinate(column) + 2];
      case ColumnKind::reaction_x:
        return force(column).x;
      case ColumnKind::reaction_y:
        return force(column).y;
      case ColumnKind::reaction_torque:
        return column.detail == on_i ? reactions(column).on_i.torque : reactions(column).on_j.torque;
      case ColumnKind::multiplier:
        return reactions(column).multiplier[column.detail];
      case ColumnKind::push:
        if (!s_.contact_force.empty()) return s_.contact_force[static_cast<std::size_t>(column.index)];
        return 0 - reactions(column).multiplier[0];
      case ColumnKind::friction:
        return s_.contact_friction.empty() ? 0 : s_.contact_friction[static_cast<std::size_t>(column.index)];
      case ColumnKind::slip:
        return s_.contact_slip.empty() ? 0 : s_.contact_slip[static_cast<std::size_t>(column.index)];
      case ColumnKind::gap:
        return evaluator_.measure(column.index, {}, {}).value;
      case ColumnKind::slack:
        return spring_loads(s_, column.index).slack;
      case ColumnKind::value:
        return evaluator_.measure(column.index, {}, {}).value;
      case ColumnKind::rate:
        return evaluator_.measure(column.index, s_.qd, {}).rate;
      case ColumnKind::joint_angle:
        return joint(column).angle.f;
      case ColumnKind::joint_omega:
        return joint(column).angle.d;
      case ColumnKind::slide:
        return joint(column).slide.f;
      case ColumnKind::slide_rate:
        return joint(column).slide.d;
      case ColumnKind::load:
        return load(column);
      case ColumnKind::power:
        return load(column) * evaluator_.element_value(column.index).d;
      case ColumnKind::work:
        return s_.driver_work[static_cast<std::size_t>(column.index)];
      case ColumnKind::length:
        return joint(column).length.f;
      case ColumnKind::length_rate:
        return joint(column).length.d;
      case ColumnKind::turn:
        return joint(column).angle.f;
      case ColumnKind::tension:
        return spring_loads(s_, column.index).tension;
      case ColumnKind::spring_torque:
        return spring_loads(s_, column.index).torque;
      case ColumnKind::offset_x:
        return spring_loads(s_, column.index).offset.x;
      case ColumnKind::offset_y:
        return spring_loads(s_, column.index).offset.y;
      case ColumnKind::exerted_x:
        return exerted(column).x;
      case ColumnKind::exerted_y:
        return exerted(column).y;
      case ColumnKind::exerted_torque:
        return spring_loads(s_, column.index).torque_on_j;
      case ColumnKind::kinetic:
        return kinetic();
      case ColumnKind::potential:
        return potential();
      case ColumnKind::total:
        return total();
      case ColumnKind::dissipated:
        return s_.dissipated;
      case ColumnKind::balance:
        return total() - s_.initial_energy - s_.work + s_.dissipated;
      case ColumnKind::momentum_x:
        return sums().linear.x;
      case ColumnKind::momentum_y:
        return sums().linear.y;
      case ColumnKind::angular_momentum:
        return sums().angular;
    }
    return 0;
  }

 private:
  struct Joint {
    Taylor<double> angle, slide, length;
  };

  static std::size_t coordinate(const Column& column) { return 3 * static_cast<std::size_t>(column.index); }
  Frame<double> frame(const Column& column) const { return evaluator_.ground_frame(column.index); }

  /// The point's place in the centroidal frame: a named one, or the origin of the author's frame.
  Vec2<double> local(const Column& column) const {
    const Model& model = evaluator_.model();
    if (column.detail >= 0) return model.points[static_cast<std::size_t>(column.detail)].local;
    const Plan& plan = evaluator_.plan();
    if (column.index == plan.bodies) return {};
    return model.bodies[static_cast<std::size_t>(plan.model_body[static_cast<std::size_t>(column.index)])].origin;
  }
  Vec2<double> arm(const Column& column) const { return frame(column).axis(local(column)); }

  Vec2<double> position(const Column& column) const { return frame(column).point(local(column)); }
  Vec2<double> velocity(const Column& column) const {
    const double* v = s_.qd.data() + coordinate(column);
    return Vec2<double>{v[0], v[1]} + v[2] * perpendicular(arm(column));
  }
  Vec2<double> acceleration(const Column& column) const {
    const double omega = s_.qd[coordinate(column) + 2];
    const double* a = s_.qdd.data() + coordinate(column);
    const Vec2<double> s = arm(column);
    return Vec2<double>{a[0], a[1]} + a[2] * perpendicular(s) - (omega * omega) * s;
  }

  const ElementReactions& reactions(const Column& column) {
    if (column.index != reactions_of_) reactions_ = element_reactions(s_, reactions_of_ = column.index);
    return reactions_;
  }
  Vec2<double> force(const Column& column) {
    const ElementReactions& r = reactions(column);
    if (column.detail == on_i) return r.on_i.force;
    if (column.detail == on_j) return r.on_j.force;
    return {dot(r.joint_x, r.on_j.force), cross(r.joint_x, r.on_j.force)};
  }

  Vec2<double> exerted(const Column& column) const {
    const SpringLoads loads = spring_loads(s_, column.index);
    return column.detail == on_j_in_joint ? loads.force_on_j_in_i : loads.force_on_j;
  }

  /// lambda dPhi/dc: Phi contains -c, or -c^2 where distances are squared.
  double load(const Column& column) {
    const double multiplier = reactions(column).multiplier[0];
    const ElementRecord& record = evaluator_.model().elements[static_cast<std::size_t>(column.index)];
    bool squared = false;
    with_list(evaluator_.model().constraints, record.type,
              [&](const auto& list) { squared = HasSquaredValue<ElementOf<decltype(list)>>; });
    return squared ? -2 * evaluator_.element_value(column.index).f * multiplier : -multiplier;
  }

  Frame<Taylor<double>> motion(int body) const {
    const Plan& plan = evaluator_.plan();
    const int p = body < 0 ? plan.bodies : plan.plan_body[static_cast<std::size_t>(body)];
    if (s_.qd.empty()) return constant_frame<Taylor<double>>(evaluator_.ground_frame(p));
    const double* v = s_.qd.data() + 3 * p;
    return moving(evaluator_.ground_frame(p), v[0], v[1], v[2]);
  }
  const Joint& joint(const Column& column) {
    if (column.index == joint_of_) return joint_;
    joint_of_ = column.index;
    const Attachment a = attachment_of(evaluator_.model(), column.index);
    const Frame<Taylor<double>> i = motion(a.i), j = motion(a.j);
    joint_.angle = j.phi - i.phi;
    const Vec2<Taylor<double>> h = j.point(a.point_j) - i.point(a.point_i);
    joint_.slide = dot(i.axis(a.axis_i), h);
    // Where the points meet the length has no derivative.
    const bool apart = value_of(squared_norm(h)) > 0;
    joint_.length = apart ? norm(h) : Taylor<double>(0.0);
    return joint_;
  }

  double potential() {
    if (!potential_) potential_ = evaluator_.potential_energy() + s_.contact_energy;
    return *potential_;
  }
  double kinetic() {
    if (!kinetic_) kinetic_ = kinetic_energy(s_);
    return *kinetic_;
  }
  double total() { return kinetic() + potential(); }
  const Momentum& sums() {
    if (!momentum_) momentum_ = momentum(s_);
    return *momentum_;
  }

  const Snapshot& s_;
  const Evaluator& evaluator_;
  const bool only_angles_;
  int reactions_of_ = -1, joint_of_ = -1;
  ElementReactions reactions_;
  Joint joint_;
  std::optional<double> kinetic_, potential_;
  std::optional<Momentum> momentum_;
};

}  // namespace

void ColumnSet::evaluate(const Snapshot& snapshot, std::span<double> out) const {
  if (out.size() < columns_.size()) throw std::invalid_argument("columns: there is no room for all values of a row");
  if (static_cast<std::size_t>(snapshot.evaluator.plan().coordinates()) != coordinates_)
    throw std::invalid_argument("columns: the row is of another model than the one they were resolved for");
  const auto require = [](bool needed, std::span<const double> values, std::size_t size, const char* what) {
    if (needed && values.size() < size)
      throw std::invalid_argument(std::string("columns: the row has no ") + what +
                                  "; an analysis must compute needs()");
  };
  require(needs_.velocity, snapshot.qd, coordinates_, "velocities");
  require(needs_.acceleration, snapshot.qdd, coordinates_, "accelerations");
  // Rows of released constraints are missing while they are.
  const auto rows = static_cast<std::size_t>(snapshot.evaluator.plan().rows);
  require(needs_.multipliers, snapshot.lambda, rows, "multipliers");
  RowValues row(snapshot, only_angles_);
  for (std::size_t k = 0; k < columns_.size(); ++k) out[k] = row.value(columns_[k]);
}

}  // namespace catena
