#include "cases/driven_problems.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanisms.hpp"

namespace bench {

using namespace catena;
using Real = long double;
using Vector = Vec2<Real>;

namespace {

constexpr Real pace = 1.5L;  // rad/s of the harmonic drivers in mechanisms.cpp

Real turned_by(double angle, Real exact) {
  return std::abs(std::remainder(static_cast<Real>(angle) - exact, 2 * std::numbers::pi_v<Real>));
}

/// The joint of a dyad: `coupler` from the tip, `rocker` from the pivot, to the left of the line between them.
Vector joint_of(const Vector& tip, const Vector& pivot, Real coupler, Real rocker) {
  const Vector d = pivot - tip;
  const Real distance = std::hypot(d.x, d.y);
  const Real turn = std::acos((coupler * coupler + distance * distance - rocker * rocker) / (2 * coupler * distance));
  const Real angle = std::atan2(d.y, d.x) + turn;
  return tip + coupler * Vector{std::cos(angle), std::sin(angle)};
}

/// The pivots follow from the given configuration, the joints from the crank on.
double error_of_dyads(std::span<const double> q, int dyads, double t) {
  const Real coupler = 0.25L, rocker = 0.2L;
  const Real crank = (dyads > 100 ? 0.3 / std::sqrt(dyads) : 0.1) * std::sin(pace * static_cast<Real>(t));
  Vector given{0.1L, 0}, tip = Real(0.1L) * Vector{std::cos(crank), std::sin(crank)};
  Real worst = turned_by(q[2], crank);
  for (int k = 1; k <= dyads; ++k) {
    // As the model has them, in double precision.
    const Vector pivot{given.x + 0.2, given.y - 0.15 + (k % 2 ? 0.02 : 0)};
    given = Real(0.5L) * (pivot + joint_of(given, pivot, coupler, rocker));
    const Vector joint = joint_of(tip, pivot, coupler, rocker);
    const std::size_t bar = 3 * static_cast<std::size_t>(2 * k - 1);
    worst = std::max(worst, turned_by(q[bar + 2], std::atan2((joint - tip).y, (joint - tip).x)));
    worst = std::max(worst, turned_by(q[bar + 5], std::atan2((joint - pivot).y, (joint - pivot).x)));
    tip = Real(0.5L) * (pivot + joint);
  }
  return static_cast<double>(worst);
}

double error_of_scissor(std::span<const double> q, int stages, double t) {
  const Real angle = 0.4L + 0.3L * std::sin(pace * static_cast<Real>(t));
  Real worst = 0;
  for (int k = 0; k < stages; ++k) {
    for (int arm = 0; arm < 2; ++arm) {
      const std::size_t at = 3 * static_cast<std::size_t>(2 * k + arm);
      worst = std::max(worst, turned_by(q[at + 2], arm == 0 ? angle : -angle));
      // The height of a stage adds up over those below.
      worst = std::max(worst, std::abs(q[at + 1] - (k + 0.5L) * std::sin(angle)) / (k + 1));
    }
  }
  return static_cast<double>(worst);
}

double error_of_gears(std::span<const double> q, int gears, double t) {
  const Real first = 0.5L * std::sin(pace * static_cast<Real>(t));
  Real worst = 0;
  for (int k = 0; k < gears; ++k) {
    const Real exact = k % 2 ? -1.5L * first : first;  // radii 0.06 and 0.04 m in turn
    worst = std::max(worst, turned_by(q[3 * static_cast<std::size_t>(k) + 2], exact));
  }
  return static_cast<double>(worst);
}

double error_of_cams(std::span<const double> q, int cams, double t) {
  const Real turn = 0.5L * std::sin(pace * static_cast<Real>(t));
  Real worst = 0;
  for (int k = 0; k < cams; ++k) {
    const double phase = 0.7 * k, offset = 0.01, radius = 0.03;
    const double x = offset * std::cos(phase), y = offset * std::sin(phase);
    const Real lift = x * std::sin(turn) + y * std::cos(turn) + radius;
    worst = std::max(worst, std::abs(q[3 * static_cast<std::size_t>(2 * k + 1) + 1] - lift));
  }
  return static_cast<double>(worst);
}

// Rounding beside the tolerance: a unit in the last place of places of n links, 2e-16 n, over their length; the
// four-bars in a row pass errors of their cranks on, shrunk and grown, about a hundred of them at a time.
constexpr DrivenProblem problems[] = {
    {"four-bars in a row", dyad_ladder, error_of_dyads, "worst angle, rad", 2, 1e-10},
    {"scissor lift", scissor_lift, error_of_scissor, "worst angle or height a stage, rad or m", 2, 1e-10},
    {"gears in a row", gear_train, error_of_gears, "worst angle, rad", 1, 1e-10},
    {"cams on a shaft", camshaft, error_of_cams, "worst lift, m", 2, 1e-10},
};

}  // namespace

std::span<const DrivenProblem> driven_problems() { return problems; }

}  // namespace bench
