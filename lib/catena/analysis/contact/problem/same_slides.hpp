// Joints with friction that stick although others hold what they hold: a four-bar at rest with friction in several
// pins, a pin beside a closed stop of its angle. The equations of their slides depend on each other, so that the
// friction of each, and with it what presses the joints, is not unique. Of joints whose slides are the same motion, w_k
// = s_k w_m, only the sum counts, and all use the same part p of their limits, so that they give way together:
//
//   sum s_k T_k = F        T_k = p sign(s_k) L_k,  p = F / sum |s_k| L_k,  L_k = mu_static N_k
//   s_k = D_km / D_mm, where D_km^2 = D_kk D_mm
//
// The one that can hold most, m, holds by its row. The others follow it, T_k = (T_k / T_m) T_m, with the ratio that was
// found; all are watched, as limits change with what presses. Where slides depend on each other otherwise, as those of
// five pins of a mechanism with two freedoms, the forces are those with the least sum sqrt(D_kk) T_k^2 / L_k: of slides
// that are one motion it gives the same shares, and none is at its limit while little is to be held. Where that passes
// a limit, any forces that keep all of them are taken. What depends on others keeps its part T_k / N_k, as beside a
// closed stop. When one gives way, what holds is decided again for all. N, N m.
#pragma once

#include <cstddef>
#include <vector>

#include "catena/analysis/contact/problem/contact_problem.hpp"

namespace catena {

/// Whether places a and b have one slide.
bool slide_as_one(const ContactProblem& problem, std::size_t a, std::size_t b);
bool is_sticking_joint(const ContactProblem& problem, std::size_t a);

/// Joints that stick and whose slides are one motion; the one that can hold most first, with s = 1.
struct SameSlide {
  std::vector<std::size_t> places;
  std::vector<double> ratios;  ///< s
};
std::vector<SameSlide> same_slides(const ContactProblem& problem);

/// Joints that depend on each other share what they hold by their limits. D stays the same.
class LimitShares {
 public:
  /// Of a solved problem.
  void share(ContactProblem& problem);

 private:
  std::vector<std::size_t> joints_;  ///< that stuck the last time
  bool unique_ = true;               ///< their forces are
};

}  // namespace catena
