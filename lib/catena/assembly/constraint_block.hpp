// All constraints of one type, arranged for evaluation: sorted by body, values beside each other, slots ready.
//
// The plan owns the block's structure (bodies, equations, slots), Equations owns the numbers (element parameters), a
// pose what changes with time and configuration. The operations are functions of the three alone. They are instantiated
// once per element type, in a source file of its own; see instantiate.hpp.
#pragma once

#include <array>
#include <span>
#include <vector>

#include "catena/assembly/pose.hpp"
#include "catena/elements/element.hpp"

namespace catena {

/// Structure: element e of the block occupies the rows first_row + e rows ... ; bodies are plan bodies.
template <class E>
struct ConstraintBlock {
  using Element = E;
  int first_row = 0;
  std::vector<int> entry;   ///< place in the model's vector of this type
  std::vector<int> body_i;  ///< frame of body i; the ground's frame is the last one
  std::vector<int> body_j;
  std::vector<int> slot;           ///< varying_entries<E>() slots an element into the values of Phi_q
  std::vector<int> constant_slot;  ///< slots of the entries +1 and -1, written once
  std::vector<double> constant;
  std::vector<int> joined_row;  ///< of elements that join others, which have no rows of their own
  int first_contact = 0;        ///< in Pose::contacts, of the elements that search on curves: as the model lists them
  int first_value = 0;          ///< in Pose::values, of types with functions of time: one an element of the block

  int size() const { return static_cast<int>(entry.size()); }
  int row(int e) const {
    if constexpr (Joining<E>) {
      return joined_row[static_cast<std::size_t>(e)];
    } else {
      return first_row + e * E::rows;
    }
  }
};

/// The numbers of the block's elements, from the model.
template <class E>
struct ConstraintData {
  /// Frames are relative to each body's own origin; these shifts bring those of i and j to a common one.
  struct Shift {
    Vec2<double> i, j;
  };
  struct Timed {
    int element;
    int function;
  };
  std::vector<E> element;
  std::vector<Shift> shift;   ///< for absolute types `i` is the origin's place in the ground frame
  std::vector<double> scale;  ///< 1/(2c) for squared forms, else empty
  std::vector<Timed> timed;   ///< elements whose value is a function of time
};

/// Phi_qi and Phi_qj of one element's published equations, dense, for reactions.
template <class E>
struct LocalJacobian {
  std::array<double, jacobian_size<E>> entries{};  ///< row-major, 3 columns a body
  double scale = 1;                                ///< solver's rows = scale x these
};

/// A measured quantity with its first two time derivatives.
struct Measured {
  double value = 0, rate = 0, second = 0;
};

/// Second derivatives of one element: 6 x 6, row-major, rows and columns [x_i y_i phi_i x_j y_j phi_j].
using ElementMatrix = std::array<double, 36>;

template <class E>
struct ConstraintOperations {
  using Block = ConstraintBlock<E>;
  using Data = ConstraintData<E>;

  /// out[row] = scale x Phi.
  static void phi(const Block&, const Data&, const Pose& pose, double* out);
  /// The varying entries of Phi_q into their slots.
  static void jacobian(const Block&, const Data&, const Pose& pose, double* values);
  /// out[row] = -Phi_t for the timed elements; other rows are left alone.
  static void nu(const Block&, const Data&, const Pose& pose, double* out);
  /// out[row] = gamma at the body velocities qd (three a body, plan order).
  static void gamma(const Block&, const Data&, const Pose& pose, const double* qd, double* out);
  /// sum_r lambda_r scale d2Phi_r/dq2 of one element; lambda: multipliers of the solver's rows, size rows of the plan.
  static ElementMatrix hessian(const Block&, const Data&, const Pose& pose, const double* lambda, int e);
  /// The second derivatives of all elements, weighted with lambda, added to their slots; see hessian_slots.hpp.
  static void add_hessians(const Block&, const Data&, const Pose& pose, const double* lambda, bool convex,
                           const int* slot, double* values);
  /// nullptr, or why the equations of one element are undefined at this configuration, as a phrase.
  static const char* trouble(const Block&, const Data&, const Pose& pose, int e);
  /// The place of one element on its curve, if that has ends.
  static std::optional<CurveUse> curve_use(const Block&, const Data&, const Pose& pose, int e);
  /// Phi_q of one element.
  static LocalJacobian<E> local_jacobian(const Block&, const Data&, const Pose& pose, int e);
  /// Measured quantity of one element: exact derivatives along q(t) with the given qd and qdd (nullptr: zero).
  static Measured measure(const Block&, const Data&, const Pose& pose, const double* qd, const double* qdd, int e);
};

}  // namespace catena
