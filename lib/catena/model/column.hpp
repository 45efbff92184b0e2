// One column of results, resolved: what it shows, of which body or element. Eight bytes and a half dozen more, because
// a scene of a million links has three million of them.
//
// The names are listed in apps/manual/scenes.md#columns; the meaning of every kind is given beside it. "Body" columns
// refer to a point fixed in the body: a named one, or the origin of its author's frame. Units SI, radians.
#pragma once

namespace catena {

enum class ColumnKind : unsigned char {
  time,      ///< t, s
  residual,  ///< largest constraint residual, m (angles times the length scale); rad if all are angles
  own,       ///< index = own column of the model: a formula over other columns

  // index = plan body (the ground: plan.bodies), detail = point of the model or -1
  x,
  y,
  angle,  ///< continuous: whole turns count
  vx,
  vy,
  omega,
  ax,
  ay,
  alpha,

  // index = element; detail = ReactionSide. What the constraint exerts on a body, at its attachment point there
  reaction_x,
  reaction_y,
  reaction_torque,
  multiplier,  ///< of the published equation number `detail`
  push,        ///< of a gap: the force or torque that keeps it from closing, never negative

  // index = element
  value,        ///< measured quantity of a scalar constraint
  rate,         ///< its time derivative
  joint_angle,  ///< phi_j - phi_i
  joint_omega,
  gap,       ///< of a one-sided element
  way,       ///< of a rope, elastic or not: its present length
  friction,  ///< of a contact, along the curve's direction, or in a joint; on j
  slip,      ///< of the touching material points, j relative to i
  slide,     ///< of P_j seen from P_i, along axis_i
  slide_rate,
  load,   ///< lambda dPhi/dc: positive pushes the value up
  power,  ///< load x dc/dt
  work,   ///< integral of power

  // index = force element
  length,         ///< |r_Pj - r_Pi|
  length_rate,    ///< its time derivative
  tension,        ///< pulls P_i and P_j together
  turn,           ///< phi_j - phi_i
  spring_torque,  ///< n, on body i
  slack,          ///< of an elastic cable: its length without tension less the present one
  offset_x,       ///< of P_j seen from P_i, in the axes of body i
  offset_y,
  exerted_x,  ///< on body j at P_j; detail = ReactionSide
  exerted_y,
  exerted_torque,  ///< about P_j
  applied_x,       ///< on the body, ground axes
  applied_y,
  supplied_power,  ///< of what the element's functions of time or laws add to its force

  kinetic,
  potential,
  total,
  dissipated,
  balance,  ///< total - initial total - work + dissipated
  momentum_x,
  momentum_y,
  angular_momentum,  ///< about the ground's origin

  far_pull,  ///< index = rope, elastic or not: its tension at its end j
};

/// Whether the column shows the place, velocity or acceleration of a body or its point.
constexpr bool is_body_column(ColumnKind kind) { return kind >= ColumnKind::x && kind <= ColumnKind::alpha; }

/// Which body a reaction acts on, and in which axes it is given.
enum ReactionSide : int {
  on_j = 0,           ///< ground axes; on the only body of an absolute constraint
  on_i = 1,           ///< ground axes
  on_j_in_joint = 2,  ///< axes of the joint: along axis_i and across it, or those of body i where there is no axis
};

struct Column {
  ColumnKind kind;
  int index = -1;
  int detail = -1;

  friend bool operator==(const Column&, const Column&) = default;
};

}  // namespace catena
