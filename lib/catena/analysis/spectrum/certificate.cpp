#include "catena/analysis/spectrum/certificate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "catena/analysis/balance/descent_rules.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/spectrum/modes_operator.hpp"
#include "catena/analysis/spectrum/motion_groups.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Stiffnesses below this count as zero, N/m.
constexpr double no_stiffness = 1e-100;
constexpr double rigid_part = 1e6;
// The effect of regularised equations on a stiffness, as a multiple of that of rounding: they yield by 1e-10 of the
// flexibility of the bodies around them, while StiffnessFloor counts 2e-13 of the same terms. Measured on balanced
// arms: up to 10.
constexpr double most_bias = 500;
constexpr int usual_steps = 8, most_steps = 40;

std::size_t largest_in_size(std::span<const double> theta) {
  const auto smaller = [](double a, double b) { return std::abs(a) < std::abs(b); };
  return static_cast<std::size_t>(std::max_element(theta.begin(), theta.end(), smaller) - theta.begin());
}

// The most negative k = 1 / theta, else the smallest positive one: of negative ones the smallest in size is the lowest
// of the spectrum that is resolved.
std::size_t lowest_of(std::span<const double> theta) {
  const double largest = std::abs(theta[largest_in_size(theta)]);
  for (std::size_t k = theta.size(); k-- > 0;) {
    if (theta[k] < -1e-6 * largest) return k;
  }
  return theta.size() - 1;
}

// The lowest k after at most `steps` steps, and its vector; ends when it has settled. `negative`: k < 0 is searched
// for. Zero where there is no freedom, not a number where solutions are none.
double find_lowest(Lanczos& lanczos, int steps, bool negative, std::vector<double>& mode) {
  if (!lanczos.begin_inverted()) return 0;
  std::size_t chosen = 0;
  double best = std::numeric_limits<double>::quiet_NaN(), before = 0;
  for (int step = 0; step < steps && lanczos.advance(step + 1 == steps); ++step) {
    lanczos.find_spectrum();
    chosen = lowest_of(lanczos.theta());
    best = 1 / lanczos.theta()[chosen];
    const bool settled = step > 1 && std::abs(best - before) <= 1e-3 * std::abs(best) && (!negative || best < 0);
    if (settled || lanczos.is_complete()) break;
    before = best;
  }
  if (std::isfinite(best)) mode = lanczos.vector(static_cast<int>(chosen));
  return best;
}

double stiffness_of(const KktMatrix& matrix, std::span<const double> v) {
  std::vector<double> product(v.size());
  matrix.multiply_stiffness(v, product);
  double sum = 0;
  for (std::size_t c = 0; c < v.size(); ++c) sum += product[c] * v[c];
  return sum;
}

// Scales v so that v^T W v = 1.
void normalise(const std::vector<double>& weights, std::vector<double>& v) {
  double square = 0;
  for (std::size_t c = 0; c < v.size(); ++c) square += weights[c] * v[c] * v[c];
  if (!(square > 0)) return;
  for (double& x : v) x /= std::sqrt(square);
}

// The factors of K project a motion that K does not resist onto constraint equations with the compliance eps, which
// yield under the forces mu, K v + Phi_q^T mu = 0: v^T K v = -eps mu^2 < 0, always. The factors of W have no such
// error. The matrix holds the exact K afterwards, and factors with this shift.
void keep_to_constraints(StaticSystem& system, std::span<const double> lambda, double shift, std::vector<double>& v) {
  std::vector<double> work(v.size() + at(system.plan().rows));
  system.fill_weights();
  if (system.factorize().ok()) project_to_null_space(system, v, work);
  system.fill(lambda, Curvature::exact, shift);
  // A pivot cannot vanish here: the same numbers were factored before.
  static_cast<void>(system.factorize());
  if (shift != 0) system.fill(lambda, Curvature::exact, 0);
}

/// The making of one certificate.
class Certifier {
 public:
  Certifier(StaticSystem& system, std::span<const double> lambda)
      : system_(system), lambda_(lambda), weights_(length_weights(system)) {}

  Certificate certify() {
    if (!factorize()) return result_;
    result_.valid = true;
    result_.negative_modes = system_.matrix().negative_modes();
    const bool unstable = result_.negative_modes > 0;
    ModeOperator inverse(system_, weights_, false);
    Lanczos lanczos(inverse);
    const double lowest = find_lowest(lanczos, unstable ? most_steps : usual_steps, unstable, result_.mode);
    if (std::isnan(lowest)) {
      result_.valid = false;
      return result_;
    }
    // Where the constraints leave no freedom the inverse contains only eps: far stiffer than K.
    if (lowest == 0 || std::abs(lowest) > rigid_part * (nothing_ ? floor_ : stiffest_)) {
      result_.mode.clear();
      result_.stable = result_.negative_modes == 0;
      return result_;
    }
    // Whether the softest mode, negative ones included, is larger than the effect of regularised equations and
    // rounding.
    const std::size_t largest = largest_in_size(lanczos.theta());
    std::vector<double> softest = lanczos.vector(static_cast<int>(largest));
    biased_ = std::abs(1 / lanczos.theta()[largest] - shift());
    if (biased_ <= descent::suspicious_part * stiffest_) rounding_.emplace(system_, lambda_, 0);
    const bool doubtful =
        rounding_ && !nothing_ && system_.plan().rows > 0 && biased_ <= most_bias * (*rounding_)(softest);
    weigh_mode(doubtful, std::move(softest));
    if (result_.neutral || doubtful) count_again();
    result_.stable = result_.negative_modes == 0 && !result_.neutral;
    return result_;
  }

 private:
  double shift() const { return shifted_ ? floor_ : 0; }

  /// The exact K; where a pivot vanishes exactly something is neutral, and K is shifted: beside it the factors exist.
  bool factorize() {
    system_.fill(lambda_, Curvature::exact, 0);
    bool factored = system_.factorize().ok();
    stiffest_ = std::max(system_.matrix().largest_stiffness(), system_.force_size() / system_.length());
    // Where there are neither stiffnesses nor forces, any motion is free: found with a stiffness of 1 N/m in place of
    // zero.
    nothing_ = !(stiffest_ > no_stiffness);
    floor_ = nothing_ ? 1 : neutral_part * stiffest_;
    shifted_ = !factored || nothing_;
    if (!shifted_) return true;
    system_.fill(lambda_, Curvature::exact, floor_);
    return system_.factorize().ok();
  }

  /// The Rayleigh quotient with the true matrix, and its rounding. The vector must meet the constraints exactly: the
  /// deviation that the regularised factors allow would count with the whole stiffness.
  void weigh_mode(bool doubtful, std::vector<double> softest) {
    KktMatrix& matrix = system_.matrix();
    if (doubtful) {
      result_.mode = std::move(softest);
      keep_to_constraints(system_, lambda_, shift(), result_.mode);
      normalise(weights_, result_.mode);
    } else {
      std::vector<double> work(at(system_.plan().columns + system_.plan().rows));
      project_to_null_space(system_, result_.mode, work);
      if (shifted_) system_.fill(lambda_, Curvature::exact, 0);
    }
    const double quotient = result_.softest_stiffness = stiffness_of(matrix, result_.mode);
    result_.curvature_floor = neutral_part * matrix.absolute_quadratic(result_.mode);
    if (rounding_) result_.curvature_floor = std::max(result_.curvature_floor, (*rounding_)(result_.mode));
    result_.neutral = std::abs(quotient) <= result_.curvature_floor;
    result_.neutral_modes = result_.neutral ? 1 : 0;
  }

  /// The inertia may count modes made negative by regularised equations or rounding: they are counted again without
  /// these.
  void count_again() {
    KktMatrix& matrix = system_.matrix();
    if (std::optional<FreeMotions> free = find_free_motions(system_, lambda_, neutral_part)) {
      result_.negative_modes = free->negative;
      // Beside negative modes the softest one of regularised equations says nothing.
      result_.neutral_modes = free->negative > 0 ? free->count : std::max(free->count, result_.neutral_modes);
      result_.neutral = result_.neutral_modes > 0;
      result_.free_bodies = std::move(free->bodies);
      if (free->negative > 0) {
        result_.mode = std::move(free->lowest);
        normalise(weights_, result_.mode);
        result_.softest_stiffness = stiffness_of(matrix, result_.mode);
      }
    } else {
      const double quotient = result_.softest_stiffness;
      system_.fill(lambda_, Curvature::exact, std::max(floor_, 2 * biased_));
      if (system_.factorize().ok()) result_.negative_modes = matrix.negative_modes();
      system_.fill(lambda_, Curvature::exact, 0);
      if (!result_.neutral && quotient < 0) result_.negative_modes = std::max(result_.negative_modes, 1);
    }
    if (result_.neutral && result_.free_bodies.empty())
      result_.free_bodies = names_of_moving(system_, lambda_, {result_.mode});
  }

  StaticSystem& system_;
  std::span<const double> lambda_;
  std::vector<double> weights_;
  Certificate result_;
  double stiffest_ = 0, floor_ = 0;  // N/m: of the system; what counts as none
  double biased_ = 0;                // N/m: of the softest mode, without the shift
  bool nothing_ = false, shifted_ = false;
  std::optional<StiffnessFloor> rounding_;
};

}  // namespace

Certificate certify(StaticSystem& system, std::span<const double> lambda) {
  if (system.plan().columns > 0) return Certifier(system, lambda).certify();
  Certificate result;
  result.valid = result.stable = true;
  return result;
}

std::string describe_mode(const Evaluator& evaluator, std::span<const double> mode, std::span<const double> radius) {
  const Plan& plan = evaluator.plan();
  int body = -1;
  double largest = 0, motion[3] = {0, 0, 0};
  for (int b = 0; b < plan.moving; ++b) {
    double v[3] = {0, 0, 0};
    for (int k = 0; k < 3; ++k) {
      const int c = plan.column[at(3 * b + k)];
      if (c >= 0) v[k] = mode[at(c)];
    }
    const double size = std::hypot(v[0], v[1]) + radius[at(b)] * std::abs(v[2]);
    if (size > largest * (1 + 1e-6)) {
      largest = size;
      body = b;
      std::copy(v, v + 3, motion);
    }
  }
  if (body < 0) return "nothing";
  const double travel = std::hypot(motion[0], motion[1]), turn = radius[at(body)] * std::abs(motion[2]);
  const std::string_view name = evaluator.model().body_name(plan.model_body[at(body)]);
  if (turn > travel) return fmt::format("body \"{}\" turning", name);
  // Either sense of a mode is as good: the one with the larger positive component is shown.
  const double sign = (std::abs(motion[0]) >= std::abs(motion[1]) ? motion[0] : motion[1]) < 0 ? -1 : 1;
  const auto shown = [&](double v) { return std::abs(v) < 1e-6 * travel ? 0.0 : sign * v / travel; };
  return fmt::format("body \"{}\" along ({:.3g}, {:.3g})", name, shown(motion[0]), shown(motion[1]));
}

}  // namespace catena
