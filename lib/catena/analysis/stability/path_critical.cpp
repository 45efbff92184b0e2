#include "catena/analysis/stability/path_critical.hpp"

#include <algorithm>
#include <cmath>

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/modes_operator.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Of s: accuracy of a critical point.
constexpr double critical_accuracy = 1e-11;
constexpr int power_steps = 3;
// Part of |v_i d_i| that <v, d> must have at a limit point.
constexpr double limit_part = 1e-5;

// The quantities at one place of the step.
struct Trial {
  double s = 0;
  bool found = false, singular = false;
  int modes = 0;
  double g = 0;
  PathPoint point{};
};

class Locator {
 public:
  Locator(PathSystem& system, const PathStep& step) : system_(system), step_(step) {}

  Trial try_at(double s) {
    Trial trial{.s = s, .point = system_.advanced(step_.start, step_.tangent, s)};
    trial.found = system_.correct(trial.point, step_.start, step_.tangent, s) >= 0;
    if (!trial.found) return trial;
    trial.singular = !system_.factorize(trial.point);
    if (trial.singular) return trial;
    const std::optional<PathStability> stability = system_.stability();
    trial.found = stability.has_value();
    if (stability) trial.modes = stability->negative;
    return trial;
  }

  /// Improves the null vector with the factors at hand and returns g.
  double test_function() {
    const std::size_t columns = system_.weight().size();
    given_.assign(columns + at(system_.statics().plan().rows), 0.0);
    x_.resize(given_.size());
    if (mode_.empty()) {
      mode_.resize(columns);
      for (std::size_t c = 0; c < columns; ++c) mode_[c] = std::sin(1.0 + 1.7 * static_cast<double>(c));
      for (int k = 0; k < power_steps; ++k) sharpen();
      border_ = mode_;
    }
    for (std::size_t c = 0; c < columns; ++c) given_[c] = system_.weight()[c] * border_[c];
    system_.solve(given_, x_);
    double own = 0;
    for (std::size_t c = 0; c < columns; ++c) own += given_[c] * x_[c];
    return -1 / own;
  }

  /// mode := null vector, with the factors of a matrix that is nearly singular; multipliers to x_.
  void sharpen() {
    const std::size_t columns = system_.weight().size();
    given_.assign(columns + at(system_.statics().plan().rows), 0.0);
    x_.resize(given_.size());
    for (std::size_t c = 0; c < columns; ++c) given_[c] = system_.weight()[c] * mode_[c];
    system_.solve(given_, x_);
    double square = 0;
    for (std::size_t c = 0; c < columns; ++c) square += system_.weight()[c] * x_[c] * x_[c];
    const double length = std::sqrt(square);
    if (!(length > 0) || !std::isfinite(length)) return;
    for (double& value : x_) value /= length;
    std::copy_n(x_.begin(), columns, mode_.begin());
  }

  /// The parameter's part of the path's direction, -1 ... 1, at the place that was tried last.
  double parameter_part(const PathPoint& point) {
    return system_.product(system_.tangent(point, step_.tangent), system_.along_parameter(1));
  }

  bool is_branch(const PathPoint& point, double part_before, double part_after) {
    const std::vector<double> vector = x_;
    return crosses_another(system_, point, vector, part_before, part_after);
  }

  void forget_mode() { mode_.clear(); }
  const std::vector<double>& mode() const { return mode_; }

 private:
  PathSystem& system_;
  const PathStep& step_;
  std::vector<double> mode_, border_, given_, x_;
};

// The first place in (low, high] where the number of modes is no longer that at `low`.
std::optional<Trial> locate(Locator& locator, Trial low, Trial high) {
  locator.forget_mode();
  const double width = high.s - low.s;
  // Factors are those of the trial evaluated last: g is computed right after each.
  high = locator.try_at(high.s);
  if (!high.found || high.singular) return high.singular ? std::optional(high) : std::nullopt;
  high.g = locator.test_function();
  low = locator.try_at(low.s);
  if (!low.found || low.singular) return low.singular ? std::optional(low) : std::nullopt;
  low.g = locator.test_function();
  Trial before = low, last = high;
  for (int k = 0; k < thresholds::most_bisections && high.s - low.s > critical_accuracy * width; ++k) {
    double s = 0.5 * (low.s + high.s);
    const double secant = last.s - last.g * (last.s - before.s) / (last.g - before.g);
    // Every third trial halves the bracket: the secant alone may close it from one side only.
    const bool use_secant = k % 3 != 2 && std::abs(high.modes - low.modes) == 1 && secant > low.s && secant < high.s;
    if (use_secant) s = secant;
    Trial trial = locator.try_at(s);
    if (!trial.found) return {};
    if (trial.singular) return trial;
    trial.g = locator.test_function();
    const bool settled = use_secant && std::abs(s - last.s) <= critical_accuracy * width;
    before = last;
    last = trial;
    (trial.modes == low.modes ? low : high) = trial;
    if (settled) break;
  }
  return last;
}

}  // namespace

bool crosses_another(PathSystem& system, const PathPoint& point, std::span<const double> left_vector,
                     double part_before, double part_after) {
  if (part_before * part_after > 0) return true;
  std::vector<double> derivative;
  system.parameter_derivative(point, derivative);
  double sum = 0, terms = 0, v = 0, d = 0, travel = 0;
  for (std::size_t k = 0; k < left_vector.size(); ++k) {
    travel += std::abs(left_vector[k]);
    sum += left_vector[k] * derivative[k];
    terms += std::abs(left_vector[k] * derivative[k]);
    v += left_vector[k] * left_vector[k];
    d += derivative[k] * derivative[k];
  }
  const double range = system.along_parameter(1).p;
  return std::abs(sum) <= limit_part * terms || terms <= thresholds::no_overlap * std::sqrt(v * d) ||
         terms * range <= thresholds::no_force * system.statics().force_size() * travel;
}

std::vector<CriticalPoint> find_critical_points(PathSystem& system, const PathStep& step, bool& complete) {
  if (system.is_circulatory()) return find_circulatory_points(system, step, complete);
  std::vector<CriticalPoint> found;
  Locator locator(system, step);
  Trial low{.s = 0, .modes = step.modes_before.negative};
  const Trial high{.s = step.s, .modes = step.modes_after.negative};
  while (low.modes != high.modes && found.size() < 20) {
    const std::optional<Trial> place = locate(locator, low, high);
    if (!place) break;
    CriticalPoint critical;
    critical.s = place->s;
    critical.point = place->point;
    // Near the point the factors exist, even if rounding makes the matrix singular at the point itself.
    const Trial before = locator.try_at(std::max(place->s - beside_point * step.s, low.s));
    const double part_before = before.found && !before.singular ? locator.parameter_part(before.point) : 0;
    Trial after = locator.try_at(std::min(place->s + beside_point * step.s, step.s));
    if (!after.found || after.singular) break;
    const double part_after = locator.parameter_part(after.point);
    locator.test_function();
    locator.sharpen();
    locator.sharpen();
    critical.branch = locator.is_branch(critical.point, part_before, part_after);
    critical.modes = std::abs(after.modes - low.modes);
    critical.mode = locator.mode();
    const double sense = std::copysign(1.0, decisive_component(system.statics().plan(), critical.mode));
    for (double& v : critical.mode) v *= sense;
    if (critical.modes == 0) break;
    found.push_back(std::move(critical));
    low = after;
  }
  complete = low.modes == high.modes;
  return found;
}

}  // namespace catena
