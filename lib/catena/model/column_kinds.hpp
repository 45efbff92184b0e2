// Every kind of column of results, once: a new one is a line here, and, of an element, its name in
// columns/element_columns.cpp, which knows what elements have. The rest follows: ColumnKind, the names of columns of
// bodies and sums, what an analysis must compute for them, their values and derivatives.
//
//   NAMED(kind, name, unit, need, value)       `name` behind that of its body, of "energy" or of "momentum"
//   OF_ELEMENT(kind, need, value)              named by its element
//
// need: a ColumnNeed (column_rules.hpp). value: an expression in what RowValues has (columns/row_values.hpp),
// which gives numbers, and derivatives by design parameters. "Body" columns refer to a point fixed in the body: a named
// one, or the origin of its author's frame; they stand together, as those of energies and momenta do. Units SI,
// radians.
#pragma once

#define CATENA_COLUMN_KINDS(NAMED, OF_ELEMENT)                                                                    \
  NAMED(time, "t", time, nothing, s_.time())                                                                      \
  /* Largest constraint residual, m (angles times the length scale); rad if all are angles. */                    \
  NAMED(residual, "residual", length, nothing, s_.residual())                                                     \
  /* index = own column of the model: a formula over other columns; detail = one of its switches, or -1. */       \
  NAMED(own, "", own, nothing, column.detail < 0 ? own(column.index) : switch_of(column))                         \
  /* index = plan body (the ground: plan.bodies), detail = point of the model or -1. */                           \
  NAMED(x, "x", length, nothing, position(column).x)                                                              \
  NAMED(y, "y", length, nothing, position(column).y)                                                              \
  NAMED(angle, "angle", angle, nothing, frame(column).phi) /* continuous: whole turns count */                    \
  NAMED(vx, "vx", velocity, velocities, velocity(column).x)                                                       \
  NAMED(vy, "vy", velocity, velocities, velocity(column).y)                                                       \
  NAMED(omega, "omega", angular_velocity, velocities, s_.twist(column.index).omega)                               \
  NAMED(ax, "ax", acceleration, accelerations, acceleration(column).x)                                            \
  NAMED(ay, "ay", acceleration, accelerations, acceleration(column).y)                                            \
  NAMED(alpha, "alpha", angular_acceleration, accelerations, s_.acceleration(column.index).omega)                 \
  /* index = element; detail = ReactionSide. What the constraint exerts on a body, at its attachment point. */    \
  OF_ELEMENT(reaction_x, multipliers, force(column).x)                                                            \
  OF_ELEMENT(reaction_y, multipliers, force(column).y)                                                            \
  OF_ELEMENT(reaction_torque, multipliers, torque(column))                                                        \
  OF_ELEMENT(multiplier, multipliers, reactions(column).multiplier[column.detail]) /* of equation `detail` */     \
  OF_ELEMENT(push, multipliers, push(column)) /* of a gap: what keeps it from closing, never negative */          \
  /* index = element. Measured quantity of a scalar constraint, and its time derivative. */                       \
  OF_ELEMENT(value, nothing, s_.measured(column.index).f)                                                         \
  OF_ELEMENT(rate, velocities, s_.measured(column.index).d)                                                       \
  OF_ELEMENT(joint_angle, nothing, joint(column).angle.f) /* phi_j - phi_i */                                     \
  OF_ELEMENT(joint_omega, velocities, joint(column).angle.d)                                                      \
  OF_ELEMENT(gap, nothing, s_.measured(column.index).f)     /* of a one-sided element */                          \
  OF_ELEMENT(way, nothing, way(column.index))               /* of a rope, elastic or not: present length */       \
  OF_ELEMENT(friction, multipliers, friction(column))       /* of a contact or in a joint; on j */                \
  OF_ELEMENT(slip, multipliers, slip_now(s_, column.index)) /* of the touching points, j relative to i */         \
  OF_ELEMENT(slide, nothing, joint(column).slide.f)         /* of P_j seen from P_i, along axis_i */              \
  OF_ELEMENT(slide_rate, velocities, joint(column).slide.d)                                                       \
  OF_ELEMENT(load, multipliers, load(column)) /* lambda dPhi/dc: positive pushes the value up */                  \
  OF_ELEMENT(power, multipliers, load(column) * s_.prescribed(column.index).d) /* load x dc/dt */                 \
  OF_ELEMENT(work, summed_reaction, s_.driver_work(column.index))              /* integral of power */            \
  /* index = force element. */                                                                                    \
  /* |r_Pj - r_Pi|; with a detail: past the first end of the curve of a spring, or the last one. */               \
  OF_ELEMENT(length, nothing, column.detail < 0 ? joint(column).length.f : past_end_of_curve(column))             \
  OF_ELEMENT(length_rate, velocities, joint(column).length.d)                                                     \
  OF_ELEMENT(tension, damping, tension(column.index))                      /* pulls P_i, P_j together */          \
  OF_ELEMENT(turn, nothing, joint(column).angle.f)                         /* phi_j - phi_i */                    \
  OF_ELEMENT(spring_torque, damping, s_.spring_loads(column.index).torque) /* n, on body i */                     \
  OF_ELEMENT(slack, nothing, s_.spring_loads(column.index).slack)          /* of an elastic cable */              \
  OF_ELEMENT(offset_x, nothing, s_.spring_loads(column.index).offset.x)    /* of P_j from P_i, axes of i */       \
  OF_ELEMENT(offset_y, nothing, s_.spring_loads(column.index).offset.y)                                           \
  OF_ELEMENT(exerted_x, damping, exerted(column).x) /* on body j at P_j; detail = ReactionSide */                 \
  OF_ELEMENT(exerted_y, damping, exerted(column).y)                                                               \
  OF_ELEMENT(exerted_torque, damping, s_.spring_loads(column.index).torque_on_j) /* about P_j */                  \
  OF_ELEMENT(applied_x, damping, s_.spring_loads(column.index).force_on_i.x)     /* on the body, ground axes */   \
  OF_ELEMENT(applied_y, damping, s_.spring_loads(column.index).force_on_i.y)                                      \
  /* Of what the element's functions of time or laws add to its force. */                                         \
  OF_ELEMENT(supplied_power, velocities, s_.spring_loads(column.index).power)                                     \
  NAMED(kinetic, "kinetic", energy, motion, kinetic())                                                            \
  NAMED(potential, "potential", energy, weight, potential())                                                      \
  NAMED(total, "total", energy, motion, total())                                                                  \
  NAMED(dissipated, "dissipated", energy, sums, s_.dissipated())                                                  \
  NAMED(balance, "balance", energy, energies, total() - s_.initial_energy() - s_.work() + s_.dissipated())        \
  NAMED(momentum_x, "x", momentum, motion, momenta().linear.x)                                                    \
  NAMED(momentum_y, "y", momentum, motion, momenta().linear.y)                                                    \
  NAMED(angular_momentum, "angular", angular_momentum, motion, momenta().angular) /* about the ground's origin */ \
  /* index = rope, elastic or not: its tension at its end j. */                                                   \
  OF_ELEMENT(far_pull, multipliers, far_pull(column))
