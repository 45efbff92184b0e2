// The list of element types: a new joint is one file in constraints/ (a new force, in forces/), its line here and its
// include in all.hpp.
//
// Here the types are only declared: code that stores or passes elements needs no more; code that uses their members
// includes the element's own file, or all.hpp. An edited element then recompiles only the files that include it.
//
// Everything that treats all types alike (model storage, plan, evaluation, columns, scene reader, schema, explain,
// derivative tests) goes through these lists at compile time: no registration, no virtual call, no switch over types.
#pragma once

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

/// One-sided constraints (gap_element.hpp), and friction of joints: scenes list them as forces.
#define CATENA_GAPS(X) \
  X(Cable)             \
  X(Contact)           \
  X(Friction)          \
  X(Rope)              \
  X(Stop)

/// All with rows, also the further stretches of ropes and those that only C++ can make; they come last.
#define CATENA_ALL_CONSTRAINTS(X) \
  CATENA_CONSTRAINTS(X)           \
  CATENA_GAPS(X)                  \
  X(RopePart)                     \
  X(CustomConstraint)

/// CATENA_FORCES(X) expands X(Type) for every force type that a scene may name.
#define CATENA_FORCES(X) \
  X(Bushing)             \
  X(PointForce)          \
  X(SpringDamper)        \
  X(Torque)              \
  X(TorsionSpring)

/// The same with the types that scenes do not name: the elastic cable and rope, which a scene writes as a cable or rope
/// with a stiffness, the damping of joints, and those that only C++ can make.
#define CATENA_ALL_FORCES(X) \
  CATENA_FORCES(X)           \
  X(ElasticCable)            \
  X(ElasticRope)             \
  X(JointDamper)             \
  X(CustomForce)

namespace catena {

#define CATENA_DECLARE(Type) \
  template <class S>         \
  struct Type;
CATENA_ALL_CONSTRAINTS(CATENA_DECLARE)
CATENA_ALL_FORCES(CATENA_DECLARE)
#undef CATENA_DECLARE

}  // namespace catena
