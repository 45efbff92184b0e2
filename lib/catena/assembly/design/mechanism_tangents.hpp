// The derivatives of a motion's equations along any number of directions at once: those of AdjointMechanism not
// transposed.
//
//   R = Q(q, qd) - M qdd - Phi_q^T lambda          loads += R_q dq + R_qd dqd + R_p
//   Phi'' along the motion (q, qd, qdd)            bends += (Phi_q)'' dq + 2 (Phi_q)' dqd + Phi''_p
//   Phi'                                           rates += (Phi_q)' dq + Phi'_p               Phi: phi += Phi_p
//
// dq, dqd: a row of `width` numbers a coordinate, one a direction, in groups of four. The matrices of an element are
// evaluated once, those of pins from closed forms, and applied to all directions; by parameters only what they reach is
// differentiated. For the models of AdjointMechanism. Units as in evaluate.hpp. Source: apps/manual/sensitivity.md.
#pragma once

#include "catena/assembly/design/adjoint_mechanism.hpp"
#include "catena/linalg/kernels/lanes.hpp"

namespace catena {

// The parameters of a group are as many directions as one pack holds.
static_assert(parameters_at_once == Lanes::count);

/// Where derivatives go; empty spans: they are not wanted. Sizes: coordinates, or rows, times the width.
struct TangentSums {
  std::span<double> loads{}, phi{}, rates{}, bends{};
};

class MechanismTangents : public AdjointMechanism {
 public:
  explicit MechanismTangents(const Evaluator& evaluator);

  /// The coordinates whose rows of dq and dqd add_along() reads, ascending: of pins the angles alone.
  const std::vector<int>& read_coordinates() const { return read_; }
  /// Along directions, at the motion that was set. `lambda` of the solver's rows; without `sums.loads` it may be empty.
  void add_along(const Evaluator& evaluator, std::span<const double> lambda, std::span<const double> dq,
                 std::span<const double> dqd, std::size_t width, const TangentSums& sums);
  /// By the parameters of a group, which are the directions from number `first` on; `mechanism` is set to the time, and
  /// the side of it, where reached.asks_mechanism().
  void add_parameters(const DesignMechanism& mechanism, const Reached& reached, std::span<const double> lambda,
                      std::span<const double> qdd, std::size_t first, std::size_t width, const TangentSums& sums) const;

 private:
  struct Directions {
    std::span<const double> dq, dqd;
    std::size_t width;
  };
  void add_constraint_parameters(const DesignMechanism& mechanism, const Reached& reached,
                                 std::span<const double> lambda, std::size_t first, std::size_t width,
                                 const TangentSums& sums) const;
  void add_force_parameters(const DesignMechanism& mechanism, const Reached& reached, std::size_t first,
                            std::size_t width, std::span<double> loads) const;
  void add_pin_parameters(const Reached& reached, std::span<const double> lambda, std::size_t first, std::size_t width,
                          const TangentSums& sums) const;
  /// A body's end of a pin: what its turning and the rate of it weigh in the pin's rows and in the body's own moment.
  struct PinWeights {
    std::size_t row, angle;
    Vec2<double> turn, rate;
    double load;
  };
  struct PinKernel;
  struct PinParametersKernel;
  template <class Block, class List>
  void add_pins(const Block& block, const List& list, std::span<const double> lambda, const Directions& along,
                const TangentSums& sums);
  /// The same to (Phi_q)'' and the loads, or, with `rates`, to (Phi_q)' alone; empty spans as in TangentSums.
  template <class Block, class List>
  void add_pins(const Block& block, const List& list, std::span<const double> lambda, const Directions& along,
                std::span<double> rows, std::span<double> loads, bool rates);
  template <class Block, class List>
  void add_constraints(const Block& block, const List& list, std::span<const double> lambda, const Directions& along,
                       const TangentSums& sums) const;
  template <class Block, class List>
  void add_forces(const Evaluator& evaluator, const Block& block, const List& list, const Directions& along,
                  std::span<double> loads) const;

  std::vector<int> read_;
  bool any_force_ = false;
  std::vector<PinWeights> pin_weights_;
};

}  // namespace catena
