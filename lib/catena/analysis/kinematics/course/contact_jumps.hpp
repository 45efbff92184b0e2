// Whether places of contact on curves move with a mechanism, or jump: where a cam is hollow the place that is followed
// may cease to be one, and the search goes on elsewhere.
//
//   d_1 = s(middle) - s(begin)      d_2 = s(end) - s(middle)      of a step, each by the shorter way round
//
// The difference of both, and that of a way from the one which the step before foretells, fall with the square of the
// step where a place moves smoothly; of a place that jumps they stay the jump, however short the step is. Jumps of less
// than a thousandth of a curve are passed: they are those beside a cusp of the distance, D = s^4 + a s^2 + b s, where
// two places that compete for a point lie sqrt(|a|) apart, D changes by a^2, and the motion by next to rounding. Units:
// of the curve's parameter.
#pragma once

#include <span>
#include <vector>

#include "catena/elements/element.hpp"
#include "catena/model/model.hpp"

namespace catena {

class ContactJumps {
 public:
  explicit ContactJumps(const Model& model);

  /// Whether some place went another way than it did before: `h` is the length of the step, s. Nothing foretells the
  /// first step, which must be short.
  bool may_jump(std::span<const CurvePlace> begin, std::span<const CurvePlace> end, double h) const;
  /// The element whose place jumps in a step; -1: none.
  int jumping(std::span<const CurvePlace> begin, std::span<const CurvePlace> middle,
              std::span<const CurvePlace> end) const;
  /// Another motion begins.
  void forget() { speed_i_.clear(), speed_j_.clear(); }
  /// The step was made: the next places are foretold by it.
  void accept(std::span<const CurvePlace> begin, std::span<const CurvePlace> end, double h);

 private:
  /// Lengths of the curves of an element, in their parameters; zero: it has none there.
  struct Ranges {
    double i = 0, j = 0;
  };
  std::vector<Ranges> ranges_;             // by element
  std::vector<double> speed_i_, speed_j_;  // by place, in the last step
};

}  // namespace catena
