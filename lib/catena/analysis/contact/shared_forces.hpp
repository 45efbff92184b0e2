// Forces of places that hold each other: two feet of one body that both stick, wheels in a notch. Only some sums of
// them follow from the motion; the rest may be anything that friction allows.
//
//   forces (N, T) + Z y, any y      Z: null space of D = J M^-1 J^T on closed gaps and stuck slides
//   margin = max over y of the least of    mu_static N_k - |T_k|  (sticks),   N_k  (presses)
//
// The places hold as long as the margin is not negative: then some share keeps all limits. It is the largest value of a
// concave function with flat facets, which lies where as many of them meet as Z has columns, and one more. The largest
// double where forces may grow without end (a wedge that locks itself). N.
#pragma once

#include <functional>
#include <vector>

#include "catena/analysis/contact/contact_problem.hpp"

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
  /// From forces across and along (for points that do not stick: not asked) of one share.
  double margin(const std::function<double(std::size_t)>& normal,
                const std::function<double(std::size_t)>& along) const;
  /// Whose limits meet at that margin: they keep each other from growing, and go together where it is zero.
  std::vector<GivesWay> giving_way(const std::function<double(std::size_t)>& normal,
                                   const std::function<double(std::size_t)>& along) const;

 private:
  /// A limit: mu N + sign T, or N where it only presses.
  struct Limit {
    std::size_t point;
    double mu, sign;
    std::vector<double> slope;  // by y
  };
  struct Best {
    double margin;
    std::vector<std::size_t> limits;  // that meet there; none where forces may grow without end
  };
  Best best(const std::function<double(std::size_t)>& normal, const std::function<double(std::size_t)>& along) const;

  std::vector<std::size_t> places_;
  std::vector<Limit> limits_;
  std::size_t freedom_ = 0;  // columns of Z
};

}  // namespace catena
