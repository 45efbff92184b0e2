#include "catena/analysis/kinematics/bridge_search.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// A pivot whose least size is below this part of its size at the ends vanishes.
constexpr double vanishing = 1e-6;
// Drivers slower than the first part of their speed at the ends of the bridge may rest nearby; they rest if less than
// the second part is left.
constexpr double slow = 1e-3, resting = 1e-6;

}  // namespace

// False where the matrix is singular to the last digit.
bool BridgeSearch::margins_at(double t, std::vector<BlockMargin>& margins) {
  evaluator_.set_time(t);
  bridge_.evaluate(t, q_, {}, {});
  if (!(solver_.factor_at(q_) > 0)) return false;
  const auto found = solver_.block_margins();
  margins.assign(found.begin(), found.end());
  return true;
}

// The instant between a and b where the block's determinant changes its sign, or else where it is least: nearly so
// first, since a pivot alone may be small elsewhere, then by the pivot, which vanishes more sharply.
double BridgeSearch::refine_instant(std::size_t block, double a, double b) {
  std::vector<BlockMargin> margins;
  bool hit = false, sharp = false;
  const auto margin = [&](double t) {
    hit = hit || !margins_at(t, margins);
    return hit ? 0.0 : sharp ? margins[block].pivot : margins[block].determinant;
  };
  double fa = margin(a), fb = margin(b);
  const double width = 1e-15 * (std::abs(a) + std::abs(b)) + 1e-14 * std::abs(b - a);
  if ((fa < 0) != (fb < 0)) {
    // Regula falsi with halving of a value that stays (Illinois), and a bisection now and then.
    for (int k = 0; k < 80 && std::abs(b - a) > width; ++k) {
      double t = k % 4 == 3 || fb == fa ? (a + b) / 2 : b - fb * (b - a) / (fb - fa);
      if (!(std::min(a, b) < t && t < std::max(a, b))) t = (a + b) / 2;
      const double f = margin(t);
      if (hit || f == 0) return t;
      if ((f < 0) != (fb < 0)) {
        a = b;
        fa = fb;
      } else {
        fa /= 2;
      }
      b = t;
      fb = f;
    }
    return b;
  }
  const double golden = (std::sqrt(5.0) - 1) / 2, rough = 1e-5 * std::abs(b - a);
  for (const double enough : {rough, width}) {
    if (enough == width) a -= rough, b += rough, sharp = true;
    double c = b - golden * (b - a), d = a + golden * (b - a);
    double fc = std::abs(margin(c)), fd = std::abs(margin(d));
    while (std::abs(b - a) > std::max(enough, 4e-16 * std::abs(b))) {
      const bool left = fc < fd;
      (left ? b : a) = left ? d : c;
      (left ? d : c) = left ? c : d;
      (left ? fd : fc) = left ? fc : fd;
      const double t = left ? b - golden * (b - a) : a + golden * (b - a);
      (left ? c : d) = t;
      (left ? fc : fd) = std::abs(margin(t));
      if (hit) return t;
    }
  }
  return (a + b) / 2;
}

std::vector<double> BridgeSearch::singular_instants() {
  std::vector<double> instants, times;
  std::vector<std::vector<BlockMargin>> margins;
  for (int k = 0; k < samples; ++k) {
    double t = from_ + (to_ - from_) * k / (samples - 1);
    std::vector<BlockMargin> found;
    // A sample that falls on the singular instant itself is moved away from it.
    for (int nudge = 0; nudge < 3 && !margins_at(t, found); ++nudge) t += 1e-9 * (to_ - from_);
    if (found.empty()) continue;
    times.push_back(t);
    margins.push_back(std::move(found));
  }
  if (times.size() < 3) return instants;
  const std::size_t blocks = margins.front().size();
  std::vector<BlockMargin> before, after;
  for (std::size_t k = 0; k + 1 < times.size(); ++k) {
    std::vector<char> explained(blocks, 0);
    for (std::size_t b = 0; b < blocks; ++b) {
      if (explained[b] || (margins[k][b].pivot < 0) == (margins[k + 1][b].pivot < 0)) continue;
      const double t = refine_instant(b, times[k], times[k + 1]);
      instants.push_back(t);
      // Other changes at the same instant have the same cause.
      const double near = 1e-7 * (to_ - from_);
      if (!margins_at(t - near, before) || !margins_at(t + near, after)) continue;
      for (std::size_t other = b; other < blocks; ++other) {
        if ((before[other].pivot < 0) != (after[other].pivot < 0)) explained[other] = 1;
      }
    }
  }
  if (instants.empty()) {
    // No sign changed: pivots that come and go, an even number of them or one that only touches zero.
    double least = 1;
    std::size_t block = 0, place = 0;
    for (std::size_t b = 0; b < blocks; ++b) {
      const double ends = std::max(std::abs(margins.front()[b].determinant), std::abs(margins.back()[b].determinant));
      for (std::size_t k = 1; k + 1 < times.size(); ++k) {
        const double part = std::abs(margins[k][b].determinant) / ends;
        if (part < least) least = part, block = b, place = k;
      }
    }
    if (least < 1) {
      const double ends =
          std::max(std::abs(margins.front()[block].determinant), std::abs(margins.back()[block].determinant));
      const double t = refine_instant(block, times[place - 1], times[place + 1]);
      if (!margins_at(t, before) || std::abs(before[block].determinant) < vanishing * ends) instants.push_back(t);
    }
  }
  std::sort(instants.begin(), instants.end());
  return instants;
}

// The instant near t at which the drivers rest: where they turn back the velocity tells it better than a pivot that
// only touches zero, and where they go through the pivot is flat. t itself if they do not rest.
bool BridgeSearch::find_rest(double& t) {
  std::vector<double> nu(at(evaluator_.plan().rows)), reference(nu), q(q_.size());
  const auto nu_at = [&](double instant, std::vector<double>& out) {
    evaluator_.set_time(instant);
    bridge_.evaluate(instant, q, {}, {});
    evaluator_.set_configuration(q);
    evaluator_.nu(out);
    return std::sqrt(std::inner_product(out.begin(), out.end(), out.begin(), 0.0));
  };
  const double most = std::max(nu_at(to_, nu), nu_at(from_, reference));
  if (nu_at(t, nu) > slow * most) return false;
  const auto along = [&](double instant) {
    nu_at(instant, nu);
    return std::inner_product(nu.begin(), nu.end(), reference.begin(), 0.0);
  };
  double a = from_, b = to_, rest = t;
  if (along(b) < 0) {
    while (std::abs(b - a) > 1e-15 * std::abs(to_ - from_) && (a + b) / 2 != a && (a + b) / 2 != b) {
      const double middle = (a + b) / 2;
      (along(middle) > 0 ? a : b) = middle;
    }
    rest = (a + b) / 2;
  } else {
    a = t - 0.05 * (to_ - from_), b = t + 0.05 * (to_ - from_);
    for (int k = 0; k < 80; ++k) {
      const double left = a + (b - a) / 3, right = b - (b - a) / 3;
      (nu_at(left, nu) < nu_at(right, nu) ? b : a) = nu_at(left, nu) < nu_at(right, nu) ? right : left;
    }
    rest = (a + b) / 2;
  }
  if (nu_at(rest, nu) > resting * most || std::abs(rest - t) > 0.05 * std::abs(to_ - from_)) return false;
  t = rest;
  return true;
}

}  // namespace catena
