#include "catena/analysis/spectrum/modes_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace catena {
namespace {

// First sigma, relative to the upper end of the spectrum.
constexpr double first_shift = 1e-8;
// Where a shift has no factors, for it is an omega^2, others at this part of it further down are tried.
constexpr double step_aside = 0.618;
// Largest ratio of sigma to the lowest omega^2 that is not zero.
constexpr double shift_window = 1e4;
// Where modes are counted: this far below the highest one, relative to it and to the upper end; where the highest is
// zero, below what rounding of the stiffnesses makes of zeros.
constexpr double count_margin = 1e-8, count_rounding = 1e-15, zero_rounding = 1e-12;
// Accuracy of the bracket of the lowest omega^2, as a factor.
constexpr double bracket = 1.05;

// All of the negative thetas, at least `below`, and the `above` largest ones.
std::vector<int> choose(std::span<const double> theta, int below, int above) {
  const int n = static_cast<int>(theta.size());
  int negative = 0;
  while (negative < n && theta[static_cast<std::size_t>(negative)] < 0) ++negative;
  if (negative < below || n - negative < above) return {};
  std::vector<int> chosen;
  for (int k = 0; k < negative && below > 0; ++k) chosen.push_back(k);
  for (int k = n - above; k < n; ++k) chosen.push_back(k);
  return chosen;
}

}  // namespace

ModeSearch::ModeSearch(StaticSystem& system, std::span<const double> lambda, std::vector<double> mass,
                       const StiffnessFloor& floor, const std::function<bool()>& go_on)
    : system_(system), lambda_(lambda), mass_(std::move(mass)), floor_(floor), go_on_(go_on), op_(system, mass_) {
  // K applied to a vector in which every mass takes part: about the root mean square of omega^2.
  system_.fill(lambda_, Curvature::exact, 0);
  std::vector<double> v(mass_.size()), product(mass_.size());
  // Signs without any order: in a regular pattern neighbours may move together, and nothing is stretched.
  unsigned random = 1;
  for (std::size_t c = 0; c < v.size(); ++c) {
    random = random * 1664525u + 1013904223u;
    v[c] = (random >> 31 ? 1 : -1) * op_.typical()[c];
  }
  system_.matrix().multiply_stiffness(v, product);
  double forces = 0, masses = 0;
  for (std::size_t c = 0; c < v.size(); ++c) {
    if (!(mass_[c] > 0)) continue;
    forces += product[c] * product[c] / mass_[c];
    masses += mass_[c] * v[c] * v[c];
  }
  size_ = masses > 0 && forces > 0 ? std::sqrt(forces / masses) : 1;
}

bool ModeSearch::factorize(double& sigma, double margin) {
  for (int k = 0; k < 4; ++k, sigma -= margin) {
    if (op_.factorize(lambda_, sigma)) return true;
  }
  return false;
}

// A sigma with no omega^2 below it, within `bracket` of the lowest one. `upper`: negative, with some below it.
double ModeSearch::lowest_shift(double upper) {
  double some = -upper, none = some;
  do {
    some = none;
    none *= 16;
    double sigma = -none;
    if (!factorize(sigma, step_aside * std::abs(sigma))) break;
  } while (op_.below() > 0);
  while (none > bracket * some) {
    const double middle = std::sqrt(some * none);
    double sigma = -middle;
    const bool below = factorize(sigma, step_aside * std::abs(sigma)) && op_.below() > 0;
    (below ? some : none) = middle;
  }
  return -none;
}

double ModeSearch::better_shift(const std::vector<Mode>& modes, double sigma) const {
  double lowest = 0;
  bool zeros = false;
  for (const Mode& mode : modes) {
    zeros = zeros || mode.omega2 == 0;
    if (mode.omega2 != 0 && (lowest == 0 || std::abs(mode.omega2) < lowest)) lowest = std::abs(mode.omega2);
  }
  const bool too_far = -sigma > shift_window * lowest, too_near = zeros && lowest > -shift_window * sigma;
  return lowest > 0 && (too_far || too_near) ? -0.3 * lowest : sigma;
}

Report ModeSearch::no_factors() const {
  Report report;
  report.status = Status::not_converged;
  report.message =
      "the shifted stiffness could not be factored; likely cause: masses or stiffnesses that differ by more "
      "than rounding allows";
  return report;
}

Report ModeSearch::cancelled() const { return {Status::cancelled, "stopped while modes were looked for", {}}; }

// Lanczos' method about one shift, then, where that one was far from the lowest omega^2, about a better one.
Report ModeSearch::find_most(int count, double& sigma, bool& complete, std::vector<Mode>& modes) {
  const int most = std::min(static_cast<int>(mass_.size()), Lanczos::most_vectors(count));
  for (int attempt = 0; attempt < 2; ++attempt) {
    if (!factorize(sigma, step_aside * std::abs(sigma))) return no_factors();
    const int below = op_.below();
    const bool many = below > count;
    int negative = many ? 0 : below;
    if (many) {
      sigma = lowest_shift(sigma);
      if (!factorize(sigma, step_aside * std::abs(sigma))) return no_factors();
    }
    Lanczos lanczos(op_), again(op_);
    Lanczos* found = &lanczos;
    const auto wanted = [&](std::span<const double> theta) { return choose(theta, negative, count - negative); };
    bool settled = lanczos.run(wanted, most, go_on_);
    if (is_cancelled()) return cancelled();
    if (!settled && !lanczos.exhausted() && negative > 0) {
      // Unstable modes far from zero: searched with a shift at their end of the spectrum.
      sigma = lowest_shift(sigma);
      if (!factorize(sigma, step_aside * std::abs(sigma))) return no_factors();
      negative = 0;
      found = &again;
      settled = again.run(wanted, most, go_on_);
      if (is_cancelled()) return cancelled();
    }
    if (!settled && !found->exhausted()) {
      return {Status::not_converged,
              fmt::format("the lowest {} modes did not settle within {} steps of Lanczos' method; likely cause: "
                          "many modes of nearly the same frequency; ask for more of them or for fewer",
                          count, found->steps()),
              {}};
    }
    complete = found->exhausted();
    if (found->steps() > 0) modes = modes_of(*found, sigma, count);
    refine_values(modes, sigma);
    const double better = better_shift(modes, sigma);
    if (attempt > 0 || many || found == &again || better == sigma) break;
    sigma = better;
  }
  return {};
}

// The proof: as many as the inertia counts. Equal frequencies may hide from one start vector.
Report ModeSearch::find_missing(int count, double sigma, std::vector<Mode>& modes) {
  for (int round = 0; round <= count; ++round) {
    std::sort(modes.begin(), modes.end(), lower);
    modes.resize(std::min(modes.size(), static_cast<std::size_t>(count)));
    const double top = modes.back().omega2;
    double mu = top - count_margin * std::abs(top) - (top == 0 ? zero_rounding : count_rounding) * size_;
    const int found =
        static_cast<int>(std::count_if(modes.begin(), modes.end(), [&](const Mode& mode) { return mode.omega2 < mu; }));
    if (!factorize(mu, top - mu)) return no_factors();
    const int missing = op_.below() - found;
    if (missing == 0) break;
    if (missing < 0 || round == count) {
      return {Status::not_converged,
              fmt::format("{} modes below omega^2 = {:.6g} were found, but the inertia counts {}", found, mu,
                          found + missing),
              {}};
    }
    if (!factorize(sigma, step_aside * std::abs(sigma))) return no_factors();
    std::vector<std::vector<double>> locked;
    for (const Mode& mode : modes) locked.push_back(mode.shape);
    Lanczos others(op_, std::move(locked));
    const int more = std::min(missing, count);
    others.run([&](std::span<const double> theta) { return choose(theta, 0, more); }, Lanczos::least_vectors, go_on_);
    if (is_cancelled()) return cancelled();
    if (others.steps() == 0) continue;
    std::vector<Mode> extra = modes_of(others, sigma, more);
    refine_values(extra, sigma);
    for (Mode& mode : extra) modes.push_back(std::move(mode));
  }
  return {};
}

Report ModeSearch::find(int count, std::vector<Mode>& modes) {
  modes.clear();
  if (mass_.empty() || count == 0) return {};
  double sigma = -first_shift * size_;
  bool complete = false;
  if (Report found = find_most(count, sigma, complete, modes); !found.ok()) return found;
  if (!complete) {
    if (Report proved = find_missing(count, sigma, modes); !proved.ok()) return proved;
  }
  std::sort(modes.begin(), modes.end(), lower);
  unstable_ = static_cast<int>(std::count_if(modes.begin(), modes.end(), [](const Mode& m) { return m.omega2 < 0; }));
  if (unstable_ == count && !complete) {
    double zero = -zero_rounding * size_;
    if (factorize(zero, zero_rounding * size_)) unstable_ = std::max(unstable_, op_.below());
  }
  return {};
}

}  // namespace catena
