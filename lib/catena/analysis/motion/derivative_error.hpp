// What a step of a motion misses in its derivatives, and where it is taken in parts for them.
//
// A motion's steps are as long as its own error allows: one at rest, or in which a mode is not excited, takes long ones
// whatever its frequencies are, and its derivatives excite them. They have an estimate of their own, the largest of all
// parameters,
//
//   e = E5^2 / sqrt(E5^2 + E3^2 / 100)        E = max(|E_q| / Q, |E_qd| / V)
//   Q = max |q_p|        V = max(|qd_p|, sqrt(Q |qdd_p|), h |qdd_p|)        |.|: the largest of all coordinates
//
// of the errors E5 and E3 of orders 5 and 3 that are embedded in the step; sizes are those at its begin and end. Both
// parts are needed: that of velocities alone passes zero where an oscillation turns back. A step that misses too much
// is taken in parts of the same length, and a part that still does in parts again, so that where forces bend the parts
// next to the bend are short ones alone. On the way back y^ is judged by the same errors transposed
// (sensitivity/motion_adjoint.hpp). Sources: analysis/motion/tableau.hpp; E. Hairer, S. Norsett, G. Wanner, "Solving
// Ordinary Differential Equations I", section II.10.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include "catena/analysis/motion/tableau.hpp"

namespace catena {

/// What derivatives are to be as exact as.
struct DerivativeAim {
  double tolerance = std::numeric_limits<double>::infinity();  ///< of the motion; infinite: steps are taken as they are
  std::vector<double> sizes{};                                 ///< of the parameters; empty: 1

  bool divides() const { return tolerance < std::numeric_limits<double>::infinity(); }
  /// What e may be.
  double allowed() const;
  /// The least Q and V of a parameter: what is missed of derivatives below is rounding.
  double least(std::size_t p) const;
};

/// What the accelerations of the stages weigh in E_qd / h and in E_q / h^2.
struct EmbeddedError {
  StageSum of_qd, of_q;
};
const EmbeddedError& embedded_error_high();
const EmbeddedError& embedded_error_low();

/// The largest of all coordinates over a step.
struct StepSizes {
  double q = 0, qd = 0, qdd = 0;
};
/// E from E_qd / h and E_q / h^2, the largest of all coordinates. `least`: Q and V at least.
double relative_error(double h, double of_q, double of_qd, const StepSizes& sizes, double least);
/// e.
inline double error_of_step(double high, double low) {
  return high > 0 ? high * high / std::sqrt(high * high + 0.01 * low * low) : 0;
}

/// Into how many parts a step is divided that misses so many times what it may: e is of order 8.
int parts_for(double excess);

/// Whether parts of a step from that instant may be as short as h: their stages are to be at instants that differ. What
/// a bend of forces leaves in a part falls with its length, and is below any tolerance before.
bool is_long_enough(double h, double from);

/// Puts parts in the place of step k, counted from 1; k is the last part then, and what is kept by the number of a
/// step moves with it.
template <class Step, class Kept>
void replace_by_parts(std::vector<Step>& steps, std::map<std::size_t, Kept>& kept, std::size_t& k,
                      const std::vector<Step>& parts) {
  const auto place = steps.erase(steps.begin() + static_cast<std::ptrdiff_t>(k - 1));
  steps.insert(place, parts.begin(), parts.end());
  std::map<std::size_t, Kept> moved;
  for (auto& [number, one] : kept) moved.emplace(number < k ? number : number + parts.size() - 1, std::move(one));
  kept = std::move(moved);
  k += parts.size() - 1;
}

/// When the way back looks at e, which costs about as much as a step: what y^ is made of changes slowly, and every 16th
/// is looked at, as many as a step has stages, with one that may miss too much by its length.
class BackChecks {
 public:
  /// Whether in a step of length h, with so many measures that have begun.
  bool is_due(double h, std::size_t begun) const;
  /// A step was taken of which e was looked at: so many times what it may be; or it was not.
  void note(double h, std::size_t begun, double excess);
  void note_unchecked() { ++since_; }
  /// The next step is looked at.
  void ask() { excess_ = std::numeric_limits<double>::infinity(); }

 private:
  double length_ = 1, excess_ = std::numeric_limits<double>::infinity();
  std::size_t since_ = 0, begun_ = 0;
};

}  // namespace catena
