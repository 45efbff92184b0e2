// All force elements of one type, arranged for evaluation; the counterpart of constraint_block.hpp.
#pragma once

#include <array>
#include <vector>

#include "catena/assembly/constraint_block.hpp"
#include "catena/elements/force_element.hpp"

namespace catena {

/// Structure, owned by the plan: bodies are plan bodies, the ground's frame is the last one.
template <class E>
struct ForceBlock {
  using Element = E;
  std::vector<int> entry;  ///< place in the model's vector of this type
  std::vector<int> body_i;
  std::vector<int> body_j;
  int first_value = 0;  ///< in Pose::loads: E::functions an element

  int size() const { return static_cast<int>(entry.size()); }
};

/// The numbers of the block's elements, owned by Equations.
template <class E>
struct ForceData {
  struct Shift {
    Vec2<double> i, j;
  };
  struct Timed {
    int place;  ///< element x functions + k
    int function;
  };
  std::vector<E> element;
  std::vector<Shift> shift;  ///< to the common origin; for one-body types `i` is that origin's place
  std::vector<Timed> timed;
  struct Lawful {
    int place;
    int law;
  };
  std::vector<Lawful> lawful;  ///< ascending places
  std::vector<int> law;        ///< per place: the law that gives it, or -1; empty: none does
  /// Conservative elements that take power from outside: with functions of time or laws, each once, ascending.
  std::vector<int> supplied;
};

template <class E>
struct ForceOperations {
  using Block = ForceBlock<E>;
  using Data = ForceData<E>;

  /// Adds the generalized forces to Q (three a body, plan order, the ground's last).
  static void add_forces(const Block&, const Data&, const MovingPose& at, double* Q);
  /// Generalized forces of one element: [Q_i, Q_j].
  static std::array<double, 6> force(const Block&, const Data&, const MovingPose& at, int e);
  /// The place of one element in its table, if that has ends.
  static std::optional<CurveUse> curve_use(const Block&, const Data&, const Pose& pose, int e);
  /// Sum of the potentials of the conservative elements, J.
  static double potential(const Block&, const Data&, const Pose& pose);
  /// Power lost to damping, W.
  static double dissipation(const Block&, const Data&, const MovingPose& at);
  /// Power, W, that the elements take from outside: of non-conservative ones all but damping, of conservative ones what
  /// their functions of time add to the potential, Q^T qd + dV/dt, and what laws add to their forces: these have none.
  static double load_power(const Block&, const Data&, const MovingPose& at);
  /// Stiffness -dQ/dq of one element .
  static ElementMatrix stiffness(const Block&, const Data&, const MovingPose& at, int e);
  /// The second derivatives of the potentials of all elements, added to their slots; see hessian_slots.hpp.
  static void add_stiffness(const Block&, const Data&, const MovingPose& at, bool convex, const int* slot,
                            double* values);
  /// Damping -dQ/dqd of one element.
  static ElementMatrix damping(const Block&, const Data&, const MovingPose& at, int e);
  /// Derivative of [Q_i, Q_j] by function k of one element.
  static std::array<double, 6> by_function(const Block&, const Data&, const MovingPose& at, int e, int k);
  /// Whether every element of the block has a potential.
  static bool conservative(const Data&);
};

}  // namespace catena
