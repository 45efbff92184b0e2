// The list of element types: a new joint is one file in constraints/ (a new force, in forces/) and its lines here.
//
// Everything that treats all types alike (model storage, plan, evaluation, columns, scene reader, schema, explain,
// derivative tests) goes through these lists at compile time: no registration, no virtual call, no switch over types.
#pragma once

#include <tuple>

#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_distance.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/belt.hpp"
#include "catena/elements/constraints/cam_cam.hpp"
#include "catena/elements/constraints/cam_flat.hpp"
#include "catena/elements/constraints/coupler.hpp"
#include "catena/elements/constraints/displacement.hpp"
#include "catena/elements/constraints/gear.hpp"
#include "catena/elements/constraints/point_on_curve.hpp"
#include "catena/elements/constraints/rack_pinion.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/relative_distance.hpp"
#include "catena/elements/constraints/relative_x.hpp"
#include "catena/elements/constraints/relative_y.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/slot.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "catena/elements/forces/point_force.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/elements/forces/torque.hpp"
#include "catena/elements/forces/torsion_spring.hpp"

/// CATENA_CONSTRAINTS(X) expands X(Type) for every constraint type.
#define CATENA_CONSTRAINTS(X) \
  X(AbsoluteAngle)            \
  X(AbsoluteDistance)         \
  X(AbsoluteX)                \
  X(AbsoluteY)                \
  X(Belt)                     \
  X(CamCam)                   \
  X(CamFlat)                  \
  X(Coupler)                  \
  X(Displacement)             \
  X(Gear)                     \
  X(PointOnCurve)             \
  X(RackPinion)               \
  X(RelativeAngle)            \
  X(RelativeDistance)         \
  X(RelativeX)                \
  X(RelativeY)                \
  X(Revolute)                 \
  X(Slot)                     \
  X(Translational)            \
  X(Weld)

/// CATENA_FORCES(X) expands X(Type) for every force type.
#define CATENA_FORCES(X) \
  X(PointForce)          \
  X(SpringDamper)        \
  X(Torque)              \
  X(TorsionSpring)
