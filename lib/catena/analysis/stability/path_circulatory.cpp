// Critical points of a path beside forces without a potential.
//
//   divergence   a real omega2 passes zero: the matrix of equilibrium is singular, with left null vector w and right v,
//                limit point: w^T F_p != 0, branch point: = 0
//   flutter      two omega2 meet and become a pair, or a pair ends; the matrix is regular
//
// Located by the spectrum along the step (spectrum_crossings.hpp).
#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/modes_operator.hpp"
#include "catena/analysis/spectrum/spectrum_crossings.hpp"
#include "catena/analysis/stability/path_critical.hpp"

namespace catena {
namespace {

/// The points of one step.
class StepPoints {
 public:
  StepPoints(PathSystem& system, const PathStep& step) : system_(system), step_(step) {}

  bool point_at(double s, PathPoint& point) {
    point = system_.advanced(step_.start, step_.tangent, s);
    return system_.correct(point, step_.start, step_.tangent, s) >= 0;
  }
  bool spectrum_at(double s, CirculatoryModes& found) {
    PathPoint point;
    return point_at(s, point) && system_.spectrum(point, found);
  }
  /// The parameter's part of the path's direction at s, -1 ... 1; 0 where that is not known. The factors are those at
  /// s.
  double parameter_part(double s) {
    PathPoint point;
    if (!point_at(s, point) || !system_.factorize(point)) return 0;
    return system_.product(system_.tangent(point, step_.tangent), system_.along_parameter(1));
  }

 private:
  PathSystem& system_;
  const PathStep& step_;
};

/// Length 1 in <v, v>, the decisive component positive.
void normalise_mode(const PathSystem& system, const Plan& plan, std::vector<double>& mode) {
  double square = 0;
  for (std::size_t c = 0; c < mode.size(); ++c) square += system.weight()[c] * mode[c] * mode[c];
  const double factor = std::copysign(1 / std::sqrt(square), decisive_component(plan, mode));
  for (double& v : mode) v *= factor;
}

}  // namespace

bool PathSystem::spectrum(const PathPoint& x, CirculatoryModes& found) {
  if (!move_to(x)) return false;
  const auto motions = motions_in_masses(system_, *spectrum_tangent_, lack_of_masses_);
  return motions->are_small() && motions->find(x.lambda, 0, found);
}

std::vector<double> PathSystem::left_null_vector() {
  std::vector<double> given(given_.size(), 0.0), w(given_.size());
  for (std::size_t c = 0; c < weight_.size(); ++c) w[c] = std::sin(1.0 + 1.7 * static_cast<double>(c));
  for (int k = 0; k < thresholds::null_vector_steps; ++k) {
    for (std::size_t c = 0; c < weight_.size(); ++c) given[c] = weight_[c] * w[c];
    tangent_->solve_to_rounding(given, w, true);
    double square = 0;
    for (std::size_t c = 0; c < weight_.size(); ++c) square += weight_[c] * w[c] * w[c];
    for (double& value : w) value /= std::sqrt(square);
  }
  return w;
}

std::vector<CriticalPoint> find_circulatory_points(PathSystem& system, const PathStep& step, bool& complete) {
  StepPoints points(system, step);
  complete = false;
  SpectrumSample low, high;
  high.s = step.s;
  if (!points.spectrum_at(0, low.found) || !points.spectrum_at(step.s, high.found)) return {};
  const bool sees_flutter = system.lack_of_masses().empty();
  const SpectrumAt at_place = [&](double s, CirculatoryModes& found) { return points.spectrum_at(s, found); };
  std::vector<CriticalPoint> result;
  for (SpectrumCrossing& crossing : find_crossings(at_place, low, high, complete)) {
    if (crossing.flutter && !sees_flutter) continue;
    CriticalPoint critical;
    critical.s = crossing.s;
    if (!points.point_at(crossing.s, critical.point)) {
      complete = false;
      return result;
    }
    critical.flutter = crossing.flutter;
    critical.omega = crossing.flutter ? std::sqrt(std::max(crossing.omega2, 0.0)) : 0;
    critical.modes = std::abs(crossing.flutter ? crossing.pairs : crossing.values);
    if (!crossing.flutter) {
      const double before = points.parameter_part(std::max(crossing.s - beside_point * step.s, 0.0));
      const double after = points.parameter_part(std::min(crossing.s + beside_point * step.s, step.s));
      critical.branch = crosses_another(system, critical.point, system.left_null_vector(), before, after);
    }
    critical.mode = std::move(crossing.mode);
    normalise_mode(system, system.statics().plan(), critical.mode);
    result.push_back(std::move(critical));
  }
  return result;
}

}  // namespace catena
