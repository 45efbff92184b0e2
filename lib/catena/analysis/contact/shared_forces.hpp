// Forces of places that hold each other: two feet of one body that both stick, wheels in a notch. Only some sums of
// them follow from the motion; the rest may be anything that friction allows.
//
//   forces (N, T) + Z y, any y      Z: null space of D = J M^-1 J^T on closed gaps and stuck slides
//   margin = max over y of the least of    limits a_l + c_l y:    mu_static N_k -+ T_k  (sticks),   N_k  (presses)
//          = min over w of sum w_l a_l     w >= 0, sum w_l = 1, sum w_l c_l = 0    (duality of linear programs)
//
// The places hold as long as the margin is not negative: then some share keeps all limits. The corners w of the second
// form depend on Z alone; they are found once a phase, and each margin is the least of so many sums. The limits of the
// corner that is the least keep each other from growing: they give way together. Without a corner forces may grow
// without end (a wedge that locks itself): the margin is then the largest double. N.
#pragma once

#include <limits>
#include <utility>
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
  /// From forces of one share: what presses point k, normal(k), and along it where it sticks, along(k).
  template <class Normal, class Along>
  double margin(Normal&& normal, Along&& along) const {
    return least(normal, along).first;
  }
  /// Those whose limits meet at that margin.
  template <class Normal, class Along>
  std::vector<GivesWay> giving_way(Normal&& normal, Along&& along) const {
    std::vector<GivesWay> places;
    if (const Corner* corner = least(normal, along).second) {
      // T = -mu N, the limit of sign 1, goes with a slip forwards.
      for (const auto& [limit, weight] : *corner)
        places.push_back({limits_[limit].point, static_cast<int>(limits_[limit].sign)});
    }
    return places;
  }

 private:
  /// mu N + sign T, or N where it only presses.
  struct Limit {
    std::size_t point;
    double mu, sign;
  };
  using Corner = std::vector<std::pair<std::size_t, double>>;  // limits and their weights w > 0

  void find_corners(const std::vector<std::vector<double>>& slope);
  template <class Normal, class Along>
  std::pair<double, const Corner*> least(Normal&& normal, Along&& along) const {
    std::pair<double, const Corner*> found(std::numeric_limits<double>::max(), nullptr);
    for (const Corner& corner : corners_) {
      double sum = 0;
      for (const auto& [number, weight] : corner) {
        const Limit& limit = limits_[number];
        sum += weight * (limit.mu * normal(limit.point) + (limit.sign != 0 ? limit.sign * along(limit.point) : 0));
      }
      if (sum < found.first) found = {sum, &corner};
    }
    return found;
  }

  std::vector<std::size_t> places_;
  std::vector<Limit> limits_;
  std::vector<Corner> corners_;
};

}  // namespace catena
