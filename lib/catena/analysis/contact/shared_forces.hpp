// Forces of places that hold each other: two feet of one body that both stick, wheels in a notch. Only some sums of
// them follow from the motion; the rest may be anything that friction allows.
//
//   forces (N, T) + Z y, any y      Z: null space of D = J M^-1 J^T on closed gaps and stuck slides
//   margin = max over y of the least of    limits a_l + c_l y:    mu_static N_k -+ T_k  (sticks),   N_k  (presses)
//          = min over w of sum w_l a_l     w >= 0, sum w_l = 1, sum w_l c_l = 0    (duality of linear programs)
//
// The places hold as long as the margin is not negative: then some share keeps all limits. The polytope of w depends on
// Z alone; it is found once a phase, and each margin is looked for from the corner of the one before
// (vertex_minimum.hpp). The limits of the corner that is the least keep each other from growing: they give way
// together. Without a corner forces may grow without end (a wedge that locks itself): the margin is then the largest
// double. N.
#pragma once

#include <cmath>
#include <limits>
#include <vector>

#include "catena/analysis/contact/problem/contact_problem.hpp"
#include "catena/linalg/pivoting/vertex_minimum.hpp"

namespace catena {

/// A place that holds no longer: it slides with this sign, or opens (0).
struct GivesWay {
  std::size_t point = 0;
  int direction = 0;
};

class SharedForces {
 public:
  /// Of a solved problem, whose places are points by `point`. Places that share nothing are not among places().
  SharedForces(const ContactProblem& problem, const std::vector<std::size_t>& point);

  /// Points whose forces are not unique; empty: none.
  const std::vector<std::size_t>& places() const { return places_; }
  /// From forces of one share: what presses point k, normal(k), and along it where it sticks, along(k). Not a number
  /// where it was not found.
  template <class Normal, class Along>
  double margin(Normal&& normal, Along&& along) {
    if (shares_.empty()) return std::numeric_limits<double>::max();
    left_.clear();
    for (const Limit& limit : limits_)
      left_.push_back(limit.mu * normal(limit.point) + (limit.sign != 0 ? limit.sign * along(limit.point) : 0));
    return shares_.least(left_).value_or(std::numeric_limits<double>::quiet_NaN());
  }
  /// Those whose limits meet at that margin; none where it was not found.
  template <class Normal, class Along>
  std::vector<GivesWay> giving_way(Normal&& normal, Along&& along) {
    std::vector<GivesWay> places;
    if (shares_.empty()) return places;
    if (std::isnan(margin(normal, along))) return places;
    // T = -mu N, the limit of sign 1, goes with a slip forwards.
    for (const std::size_t limit : shares_.support())
      places.push_back({limits_[limit].point, static_cast<int>(limits_[limit].sign)});
    return places;
  }

 private:
  /// mu N + sign T, or N where it only presses.
  struct Limit {
    std::size_t point;
    double mu, sign;
  };

  std::vector<std::size_t> places_;
  std::vector<Limit> limits_;
  VertexMinimum shares_;      // of w, with the corner of the last margin
  std::vector<double> left_;  // a_l of the last margin, kept for its memory
};

}  // namespace catena
