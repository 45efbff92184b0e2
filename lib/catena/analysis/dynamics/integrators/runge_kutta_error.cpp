// The errors of a step of RungeKutta in units of what it may have: that of the method, and that of rounding near a
// singular position.
#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/dynamics/integrators/runge_kutta.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

// Weight of the part of an error estimate that the projection will remove: it affects the other stages.
constexpr double forbidden_part = 0.1, forbidden_square = 1000;
// Steps times the rate at which their last stage is drawn to the motion, beyond which its stiffness bounds them, and
// not their error: order 8 is stable up to 6, order 5 up to 3.3. Rows within them are then less exact than they are.
constexpr double stiff = 2.5;

}  // namespace

double RungeKutta::error_size(double h) {
  const std::size_t moving = motion_.moving(), offset = motion_.coordinates();
  const double* v = motion_.qd(std::span<const double>(y_)).data();
  const bool two = tableau().order == 8;
  double high = 0, low = 0;
  for (std::size_t c = 0; c < moving; ++c) {
    const double v_unit = scale_.velocity_unit(c, h, v[c]);
    // Where nothing has moved yet velocities have no scale but that of the positions that they grow into.
    const double q_scale = 1 / scale_.position_unit(c, h), v_scale = v_unit > 0 ? 1 / v_unit : std::abs(h) * q_scale;
    const double q_error = error_.high[c] * q_scale, v_error = error_.high[offset + c] * v_scale;
    const double size = q_error * q_error + v_error * v_error;
    if (!(size <= high)) {
      high = size;
      culprit_ = static_cast<int>(c);
    }
    if (!two) continue;
    const double q_low = error_.low[c] * q_scale, v_low = error_.low[offset + c] * v_scale;
    low = std::max(low, q_low * q_low + v_low * v_low);
  }
  if (!two) return std::abs(h) * std::sqrt(high);
  // Where a cable becomes taut within the step one estimate may be zero by chance.
  if (switches_.cables) return std::abs(h) * std::sqrt(high + low);
  const double denominator = high + 0.01 * low;
  // Beside velocities of next to nothing squares overflow: such an error is large, whatever their ratio.
  if (!std::isfinite(denominator)) return std::numeric_limits<double>::infinity();
  return denominator == 0 ? 0 : std::abs(h) * high / std::sqrt(denominator);
}

// Of order 8 the vector of error_size(), which mixes two estimates: h e / sqrt(1 + 0.01 (low / e)^2). By sizes of the
// accelerations' part, whose entries differ less in size than those of positions. Not numbers where the motion is
// stiff.
void RungeKutta::add_error(std::span<double> error) const {
  const std::size_t moving = motion_.moving(), offset = motion_.coordinates();
  const double h = t_ - t_before_, turn = scale_.length;
  const Tableau& table = dense_.by_ends() ? dormand_prince_5() : dormand_prince_8();  // of the last step
  double factor = 1;
  if (table.order == 8) {
    double high = 0, low = 0;
    for (std::size_t c = 0; c < moving; ++c) {
      const double unit = c % 3 == 2 ? turn : 1;
      high = std::max(high, unit * std::abs(error_.high[offset + c]));
      low = std::max(low, unit * std::abs(error_.low[offset + c]));
    }
    factor = high > 0 ? high / std::hypot(high, 0.1 * low) : 0;
  }
  // The last stage lies at the end of the step, beside the motion. Where it is the end itself, as of order 5 without a
  // projection, accelerations differ by rounding alone.
  const std::vector<double>& last = stage_[static_cast<std::size_t>(table.stages) - 1];
  double q = 0, v = 0, dq = 0, dv = 0, da = 0;
  for (std::size_t c = 0; c < moving; ++c) {
    const double unit = c % 3 == 2 ? turn : 1;
    q = std::max(q, unit * std::abs(y_[c]));
    v = std::max(v, unit * std::abs(y_[offset + c]));
    dq = std::max(dq, unit * std::abs(y_stage_[c] - y_[c]));
    dv = std::max(dv, unit * std::abs(y_stage_[offset + c] - y_[offset + c]));
    da = std::max(da, unit * std::abs(last[offset + c] - slope_[offset + c]));
  }
  const bool lies_beside = dq > thresholds::few_roundings * q || dv > thresholds::few_roundings * v;
  const bool is_stiff = lies_beside && h * da > stiff * (dv + std::sqrt(da * dq));
  factor *= is_stiff ? std::numeric_limits<double>::quiet_NaN() : h;
  for (std::size_t c = 0; c < moving; ++c) {
    error[c] += factor * error_.high[c];
    error[offset + c] += factor * error_.high[offset + c];
  }
}

// The error of the work of loads, of what dampers take and of what each driver does, in units of what the balance of
// energy may miss: where a load changes in time and moves nothing, and where drivers move bodies, no other error says
// so, be the force a spring to a driven wheel. Nothing is asked of drivers beside singular positions, where their loads
// have no bound, nor where the balance tells what the only one does. In a step with a switch both estimates of order 8
// together bound the error, as neither does alone: it is 2.9 and 3.1 times both at most if a power bends or jumps
// anywhere; of order 5 the trapezoid rule takes the place of the other one.
double RungeKutta::error_of_work(double h) const {
  const std::size_t usual = ErrorScale::judged(motion_.works()).size();
  const bool is_told = projects() && !energy_.leaves_drivers(motion_);
  const bool of_drivers = !is_told && !trials_.project_stages() && !dips();
  const std::span<const double> first(stage_[0]), last(stage_[static_cast<std::size_t>(tableau().stages) - 1]);
  double largest = 0;
  for (std::size_t place = 0; place < (of_drivers ? motion_.works() : usual); ++place) {
    const std::size_t k = 2 * motion_.coordinates() + place;
    const auto sum = [&](const StageSum& weights) { return std::abs(h * stage_.sum(weights, k)); };
    const bool bends = place < usual ? switches_.laws : switches_.any();
    double error = sum(tableau().error);
    if (tableau().order == 8) {
      const double low = sum(tableau().error_low);
      if (bends)
        error = 3 * std::hypot(error, low);
      else if (error > 0)
        error *= error / std::hypot(error, 0.1 * low);  // squares of powers that have hardly begun are zero
    } else if (bends) {
      error = std::max(error, ErrorScale::error_of_switch(h, first[k], last[k], y_new_[k] - y_[k]));
    }
    if (error == 0) continue;
    largest = std::max(largest, scale_.size_of_work(error, {h, y_[k], y_new_[k]}, motion_.equations().applied_forces(),
                                                    motion_.qd(last)));
  }
  return largest;
}

// The error without most of the part that the projection at the step's end will remove.
double RungeKutta::filtered_error(double h, double raw) {
  const std::size_t moving = motion_.moving(), offset = motion_.coordinates();
  EquationsOfMotion& equations = motion_.equations();
  for (std::vector<double>* error : {&error_.high, &error_.low}) {
    if (error == &error_.low && tableau().order == 5) break;
    equations.remove_forbidden(std::span(*error).first(moving));
    equations.remove_forbidden(std::span(*error).subspan(offset, moving));
  }
  // With projected stages the errors across the constraints enter only squared.
  const double spoilt =
      trials_.project_stages() ? forbidden_square * raw * raw * scale_.tolerance() : forbidden_part * raw;
  return std::min(raw, std::max(error_size(h), spoilt));
}

// The error compared with the motion at the step's end, where that is faster.
double RungeKutta::compared_with_end(double h, double error) {
  const std::size_t last = static_cast<std::size_t>(tableau().stages) - 1;
  const std::span<const double> y(y_new_), k(stage_[last]);
  return scale_.compare_with_end(motion_.qd(y).first(motion_.moving()), motion_.qd(k).first(motion_.moving()), error,
                                 [&] { return error_size(h); });
}

// What rounding of places makes of the accelerations of stages beside a singular position, as the error of velocities:
// at a sine d, of which the pivot ratio is the square, eps / d^3 of an acceleration. The largest is rate^2 x length.
double RungeKutta::rounding_of_velocity(double h) const {
  return std::numeric_limits<double>::epsilon() * ratios_.roughness() * std::abs(h) * scale_.rate() /
         scale_.tolerance();
}

// The same as the error of the step: where velocities are mended by the balance of energy, that of places, which have
// moved with the wrong ones meanwhile.
double RungeKutta::rounding_of_crossing(double h) const {
  return rounding_of_velocity(h) * (watches_energy() ? std::min(1.0, scale_.rate() * std::abs(h)) : 1);
}

}  // namespace catena
