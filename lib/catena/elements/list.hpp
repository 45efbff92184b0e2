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
#include "catena/elements/constraints/custom_constraint.hpp"
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
#include "catena/elements/forces/bushing.hpp"
#include "catena/elements/forces/custom_force.hpp"
#include "catena/elements/forces/point_force.hpp"
#include "catena/elements/forces/spring_damper.hpp"
#include "catena/elements/forces/torque.hpp"
#include "catena/elements/forces/torsion_spring.hpp"

/// CATENA_CONSTRAINTS(X) expands X(Type) for every constraint type that a scene may name.
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

/// The same with those that only C++ can make; they come last.
#define CATENA_ALL_CONSTRAINTS(X) \
  CATENA_CONSTRAINTS(X)           \
  X(CustomConstraint)

/// CATENA_FORCES(X) expands X(Type) for every force type that a scene may name.
#define CATENA_FORCES(X) \
  X(Bushing)             \
  X(PointForce)          \
  X(SpringDamper)        \
  X(Torque)              \
  X(TorsionSpring)

/// The same with those that only C++ can make; they come last.
#define CATENA_ALL_FORCES(X) \
  CATENA_FORCES(X)           \
  X(CustomForce)
