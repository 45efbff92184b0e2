// The sizes of the terms that equations are sums of: eps times them is the rounding of a residual.
//
//   terms_r = sum over columns c of |Phi_q|_rc moduli_c + (fastest turn of the row's bodies) sum of |Phi_q|_rc
//   |rates_c|
//
// An angle counts in all equations in metres with the longest arm that its body has in any, and with the mean distance
// of its attachments: an equation has the other component of an arm as well, which Phi_q does not show. The second sum,
// of accelerations alone, is that of centripetal and Coriolis terms. Units: m, m/s, m/s^2 or rad, rad/s, rad/s^2.
#pragma once

#include <span>
#include <vector>

#include "catena/assembly/evaluate.hpp"

namespace catena {

class RowTerms {
 public:
  explicit RowTerms(const Evaluator& evaluator) : plan_(evaluator.plan()), radius_(evaluator.attachment_radii()) {}

  /// Of magnitudes by coordinate; `rates` may be empty. Valid until the next call.
  std::span<double> sum(std::span<const double> jacobian, std::span<const double> moduli,
                        std::span<const double> rates = {});

 private:
  template <class Add>
  void visit(std::span<const double> jacobian, Add&& add) const;

  const Plan& plan_;
  std::vector<double> radius_;  // per plan body
  std::vector<double> terms_, fastest_;
};

/// Magnitudes of which places are made: of coordinates and of their origin in the ground frame, angles 1 rad at least.
/// By coordinate of moving bodies; `moduli` has as many as q.
void place_moduli(const Evaluator& evaluator, std::span<const double> q, std::vector<double>& moduli);

}  // namespace catena
