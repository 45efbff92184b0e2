// The value of every kind of column, for any scalar: what the list of kinds (model/column_kinds.hpp) says of it serves
// plain numbers and derivatives.
//
// A State is what is known of a mechanism at one instant: SnapshotState in plain numbers, DesignState with derivatives
// by design parameters. It gives, besides what snapshot_state.hpp says,
//
//   residual(), work(), dissipated(), initial_energy(), driver_work(element)      what an analysis sums up
//   measured(element)      the quantity of a scalar constraint or gap: f and d     prescribed(element)  c, c', c''
//   reactions(element)     spring_loads(element)      potential()
//   contact(element)       loads of a contact in motion, nullptr: none are known
//
// Source files alone include it: this is where templates meet every element.
#pragma once

#include <optional>
#include <vector>

#include "catena/columns/contact_values.hpp"
#include "catena/columns/energy_of.hpp"
#include "catena/columns/own_columns.hpp"
#include "catena/columns/reaction.hpp"
#include "catena/columns/spring.hpp"
#include "catena/columns/switches.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/attachment.hpp"
#include "catena/model/column.hpp"

namespace catena {

/// Values of one row. Neighbouring columns mostly show the same element: what was computed last is kept.
template <class State>
class RowValues {
 public:
  using S = typename State::Scalar;

  /// Both must outlive this object.
  RowValues(const State& state, const OwnInputs& own_inputs) : s_(state), own_inputs_(own_inputs) {}

  S value(const Column& column) {
    switch (column.kind) {
#define CATENA_NAMED(kind, name, unit, need, value) \
  case ColumnKind::kind:                            \
    return value;
#define CATENA_OF_ELEMENT(kind, need, value) \
  case ColumnKind::kind:                     \
    return value;
      CATENA_COLUMN_KINDS(CATENA_NAMED, CATENA_OF_ELEMENT)
#undef CATENA_NAMED
#undef CATENA_OF_ELEMENT
    }
    return S(0.0);
  }

 private:
  struct Joint {
    Taylor<S> angle, slide, length;
  };

  Frame<S> frame(const Column& column) const { return s_.frame(column.index); }

  /// The value of an own column, from the columns that its formula reads.
  S own(int number) {
    const auto k = static_cast<std::size_t>(number);
    return s_.model().own_columns[k].formula.evaluate(
        [&](std::uint32_t input) { return value(own_inputs_[k][static_cast<std::size_t>(input)]); });
  }

  /// The difference by which an own column takes one branch or the other.
  S switch_of(const Column& column) {
    const auto k = static_cast<std::size_t>(column.index);
    SwitchNotes<S> notes{column.detail};
    note_switches(
        formula_of(s_.model(), column.index),
        [&](std::uint32_t input) { return value(own_inputs_[k][static_cast<std::size_t>(input)]); }, notes);
    return notes.difference;
  }

  /// The elongation of a spring past an end of its curve, 0 the first one.
  S past_end_of_curve(const Column& column) {
    const S length = joint(column).length.f;
    for (const auto& spring : std::get<std::vector<ElementEntry<SpringDamper<S>, S>>>(s_.model().forces)) {
      if (spring.id != column.index) continue;
      const CurveUse ends = spring.element.curve.use_at(0);
      return length - spring.element.length - S(column.detail == 0 ? ends.first : ends.last);
    }
    return length;
  }

  /// The point's place in the centroidal frame: a named one, or the origin of the author's frame.
  Vec2<S> local(const Column& column) const {
    const auto& model = s_.model();
    if (column.detail >= 0) return model.points[static_cast<std::size_t>(column.detail)].local;
    const Plan& plan = s_.plan();
    if (column.index == plan.bodies) return {};
    return model.bodies[static_cast<std::size_t>(plan.model_body[static_cast<std::size_t>(column.index)])].origin;
  }
  Vec2<S> arm(const Column& column) const { return frame(column).axis(local(column)); }

  Vec2<S> position(const Column& column) const { return frame(column).point(local(column)); }
  Vec2<S> velocity(const Column& column) const {
    const Twist<S> v = s_.twist(column.index);
    return Vec2<S>{v.vx, v.vy} + v.omega * perpendicular(arm(column));
  }
  Vec2<S> acceleration(const Column& column) const {
    const S omega = s_.twist(column.index).omega;
    const Twist<S> a = s_.acceleration(column.index);
    const Vec2<S> s = arm(column);
    return Vec2<S>{a.vx, a.vy} + a.omega * perpendicular(s) - (omega * omega) * s;
  }

  const BasicElementReactions<S>& reactions(const Column& column) {
    if (column.index == reactions_of_) return reactions_;
    reactions_ = s_.reactions(reactions_of_ = column.index);
    take_push(s_, column.index, reactions_);
    return reactions_;
  }
  Vec2<S> force(const Column& column) {
    const BasicElementReactions<S>& r = reactions(column);
    if (column.detail == on_i) return r.on_i.force;
    if (column.detail == on_j) return r.on_j.force;
    return {dot(r.joint_x, r.on_j.force), cross(r.joint_x, r.on_j.force)};
  }

  S torque(const Column& column) {
    const BasicElementReactions<S>& r = reactions(column);
    return column.detail == on_i ? r.on_i.torque : r.on_j.torque;
  }
  /// Of a contact, along the curve's direction, or in a joint.
  S friction(const Column& column) const {
    const auto* load = s_.contact(column.index);
    return load ? S(load->friction) : S(0.0);
  }

  Vec2<S> exerted(const Column& column) const {
    const BasicSpringLoads<S> loads = s_.spring_loads(column.index);
    return column.detail == on_j_in_joint ? loads.force_on_j_in_i : loads.force_on_j;
  }

  /// What presses.
  S push(const Column& column) {
    if (const Friction<S>* idle = idle_friction(s_, column.index))
      return idle_press(*idle, reactions({.kind = column.kind, .index = idle->joint}).multiplier);
    if (const auto* load = s_.contact(column.index)) return S(load->force);
    return S(0.0) - reactions(column).multiplier[0];
  }

  /// lambda dPhi/dc: Phi contains -c, or -c^2 where distances are squared.
  S load(const Column& column) {
    const S multiplier = reactions(column).multiplier[0];
    const ElementRecord& record = s_.model().elements[static_cast<std::size_t>(column.index)];
    bool squared = false;
    with_list(s_.model().constraints, record.type,
              [&](const auto& list) { squared = HasSquaredValue<ElementOf<decltype(list)>>; });
    return squared ? S(-2.0) * s_.prescribed(column.index).f * multiplier : -multiplier;
  }

  /// Of a spring, cable or rope; that of a rope with friction on pulleys is at its end i.
  S tension(int element) const {
    const S pull = s_.spring_loads(element).tension;
    const auto* load = s_.contact(element);
    return load ? pull + S(load->force) : pull;
  }
  /// Of a rope at its end j.
  S far_pull(const Column& column) {
    const bool elastic = s_.model().elements[static_cast<std::size_t>(column.index)].kind == ElementKind::force;
    const auto* load = s_.contact(column.index);
    if (elastic) return load ? tension(column.index) + S(load->friction) : tension(column.index);
    return load ? S(load->force + load->friction) : S(0.0) - reactions(column).multiplier[0];
  }

  /// The length of a rope's way.
  S way(int element) const {
    const ElementRecord& record = s_.model().elements[static_cast<std::size_t>(element)];
    const bool elastic = record.kind == ElementKind::force;
    S way = elastic ? -s_.spring_loads(element).slack : -s_.measured(element).f;
    const auto add_length = [&](const auto& list) {
      const auto& rope = list[static_cast<std::size_t>(record.index)].element;
      if constexpr (requires { rope.length; }) way += rope.length;
    };
    if (elastic) {
      with_list(s_.model().forces, record.type, add_length);
    } else {
      with_list(s_.model().constraints, record.type, add_length);
    }
    return way;
  }

  Frame<Taylor<S>> motion(int body) const {
    const int p = plan_body(s_.plan(), body);
    const Twist<S> v = s_.twist(p);
    return moving(s_.frame(p), v.vx, v.vy, v.omega);
  }
  const Joint& joint(const Column& column) {
    if (column.index == joint_of_) return joint_;
    joint_of_ = column.index;
    const BasicAttachment<S> a = attachment_of(s_.model(), column.index);
    const Frame<Taylor<S>> i = motion(a.i), j = motion(a.j);
    joint_.angle = j.phi - i.phi;
    const Vec2<Taylor<S>> h = j.point(a.point_j) - i.point(a.point_i);
    joint_.slide = dot(i.axis(a.axis_i), h);
    // Where the points meet the length has no derivative.
    const bool apart = value_of(squared_norm(h)) > 0;
    joint_.length = apart ? norm(h) : Taylor<S>(S(0.0));
    return joint_;
  }

  S potential() {
    if (!potential_) potential_ = s_.potential();
    return *potential_;
  }
  S kinetic() {
    if (!kinetic_) kinetic_ = kinetic_energy_of(s_);
    return *kinetic_;
  }
  S total() { return kinetic() + potential(); }
  const BasicMomentum<S>& momenta() {
    if (!momentum_) momentum_ = momentum_of(s_);
    return *momentum_;
  }

  const State& s_;
  const OwnInputs& own_inputs_;
  int reactions_of_ = -1, joint_of_ = -1;
  BasicElementReactions<S> reactions_;
  Joint joint_;
  std::optional<S> kinetic_, potential_;
  std::optional<BasicMomentum<S>> momentum_;
};

}  // namespace catena
