#include "catena/analysis/dynamics/integrators/dense_output.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"

namespace catena {

// Positions without what they say beyond velocities and accelerations, where that is no more than their rounding: in a
// short step it would be all that the velocities between the ends had, divided by h.
void move_by_ends(const StepEnds& ends, std::size_t n, double s, const ErrorScale& scale, std::span<double> y) {
  const double h = ends.h;
  for (std::size_t p = 0; p < n; ++p) {
    const double y0 = ends.y0[p], y1 = ends.y1[p], d0 = h * ends.slope0[p], d1 = h * ends.slope1[p];
    const double a0 = h * h * ends.slope0[p + n], a1 = h * h * ends.slope1[p + n];
    const double by_rates = (d0 + d1) / 2 + (a0 - a1) / 12, beyond = y1 - y0 - by_rates;
    const double rounding = std::max(scale.rounding_of_place(p), thresholds::few_roundings * std::abs(y1));
    const double way = by_rates + (std::abs(beyond) > rounding ? beyond : 0);
    const double c2 = a0 / 2, A = way - d0 - c2, B = d1 - d0 - a0, C = a1 - a0;
    const double c3 = 10 * A - 4 * B + C / 2, c4 = -15 * A + 7 * B - C, c5 = 6 * A - 3 * B + C / 2;
    y[p] = y0 + s * (d0 + s * (c2 + s * (c3 + s * (c4 + s * c5))));
    y[n + p] = (d0 + s * (2 * c2 + s * (3 * c3 + s * (4 * c4 + s * 5 * c5)))) / h;
  }
}

void DenseOutput::set(const StepEnds& ends, const Stages& stages) {
  for (std::size_t i = 0; i < ends.y0.size(); ++i) {
    const double difference = ends.y1[i] - ends.y0[i], bend = ends.h * ends.slope0[i] - difference;
    r_[0][i] = difference;
    r_[1][i] = bend;
    r_[2][i] = difference - ends.h * ends.slope1[i] - bend;
  }
  for (std::size_t k = 0; k < 4; ++k) stages.combine(dormand_prince_8().interpolant[k], ends.h, {}, r_[3 + k]);
  ready_ = true;
}

void DenseOutput::evaluate(std::span<const double> y0, double s, std::span<double> y) const {
  const double r = 1 - s;
  const auto& c = r_;
  for (std::size_t i = 0; i < y.size(); ++i) {
    y[i] = y0[i] +
           s * (c[0][i] + r * (c[1][i] + s * (c[2][i] + r * (c[3][i] + s * (c[4][i] + r * (c[5][i] + s * c[6][i]))))));
  }
}

}  // namespace catena
