// Properties that every driven mechanism has, on random ones of all joint types, with redundant joints added.
#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>
#include <vector>

#include "analysis/random_mechanisms.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/elements/constraints/coupler.hpp"
#include "catena/elements/constraints/gear.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/relative_distance.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/slot.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {
namespace {

// The same mechanisms at every run, unless RC_PARAMS asks for others ("seed=7 max_success=1000").
[[maybe_unused]] const int same_every_time = setenv("RC_PARAMS", "seed=1 max_success=200", 0);

struct Motion {
  AnalysisReport report;
  double rcond = 1;  // the least over the rows
  std::vector<double> t;
  std::vector<std::vector<double>> q, qd, qdd;  // per row: by body in the recipe's order, absolute
};

Motion follow(const Recipe& recipe, const Setting& setting, std::span<const double> times) {
  Motion motion;
  auto model = build(recipe, setting);
  Kinematics kinematics(model);
  RowFunction take([&](const Snapshot& s) {
    std::vector<double> q, qd, qdd;
    for (std::size_t k = 0; k < recipe.place.size(); ++k) {
      const int b = s.evaluator.plan().plan_body[static_cast<std::size_t>(model->find_body("b" + std::to_string(k)))];
      const auto place = static_cast<std::size_t>(3 * b);
      const Vec origin = s.evaluator.origin(b);
      q.insert(q.end(), {s.q[place] + origin.x, s.q[place + 1] + origin.y, s.q[place + 2]});
      qd.insert(qd.end(), {s.qd[place], s.qd[place + 1], s.qd[place + 2]});
      qdd.insert(qdd.end(), {s.qdd[place], s.qdd[place + 1], s.qdd[place + 2]});
    }
    motion.t.push_back(s.t);
    motion.q.push_back(std::move(q));
    motion.qd.push_back(std::move(qd));
    motion.qdd.push_back(std::move(qdd));
    motion.rcond = std::min(motion.rcond, kinematics.solver().rcond());
    return true;
  });
  motion.report =
      kinematics.run(TimeGrid::list({times.begin(), times.end()}), {.velocity = true, .acceleration = true}, take);
  return motion;
}

/// Largest entry, lengths divided by `length`.
double size_of(const std::vector<double>& x, double length) {
  double largest = 0;
  for (std::size_t k = 0; k < x.size(); ++k) largest = std::max(largest, std::abs(x[k]) / (k % 3 == 2 ? 1 : length));
  return largest;
}

std::vector<double> difference(const std::vector<double>& a, const std::vector<double>& b) {
  std::vector<double> x(a);
  for (std::size_t k = 0; k < x.size(); ++k) x[k] -= b[k];
  return x;
}

/// A mechanism that moves all the way; many random ones reach a dead point.
bool moves(const Motion& motion) { return motion.report.ok() && motion.rcond > 1e-6; }

/// How many of the mechanisms that moved had joints of each kind.
class Tally {
 public:
  void count(const Recipe& recipe) {
    std::array<bool, Joint::kinds> has{};
    for (const Joint& joint : recipe.joints) has[static_cast<std::size_t>(joint.kind)] = true;
    for (std::size_t k = 0; k < has.size(); ++k) counts_[k] += has[k];
  }
  void expect_of_each(int least) const {
    for (std::size_t k = 0; k < counts_.size(); ++k) EXPECT_GE(counts_[k], least) << "kind of joint " << k;
  }

 private:
  std::array<int, Joint::kinds> counts_{};
};

/// The outcomes of mechanisms that cannot move are statuses, never anything else.
void expect_a_reason(const Motion& motion) {
  if (motion.report.ok()) return;
  const Status status = motion.report.status;
  RC_LOG() << motion.report.message << "\n";
  RC_ASSERT(status == Status::lock_up || status == Status::bifurcation || status == Status::singular ||
            status == Status::under_driven);
  RC_ASSERT(!motion.report.message.empty());
}

// Derivatives of positions and velocities by differences of order eight over nine rows.
TEST(KinematicsProperty, PositionsVelocitiesAndAccelerationsAreConsistent) {
  Tally tally;
  const bool passed = rc::check([&tally] {
    const auto seed = *rc::gen::arbitrary<unsigned>();
    const int groups = *rc::gen::inRange(0, 8);
    const Recipe recipe = RandomMechanism(seed, groups).recipe();
    const double h = 0.004, middle = 0.1;
    std::vector<double> times;
    for (int k = 0; k < 9; ++k) times.push_back(middle + (k - 4) * h);
    const Motion motion = follow(recipe, {}, times);
    expect_a_reason(motion);
    if (!moves(motion)) return;
    tally.count(recipe);
    constexpr double weights[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
    constexpr double weights_of_six[] = {3.0 / 4, -3.0 / 20, 1.0 / 60, 0};
    const double length = recipe.extent();
    const bool splines = std::any_of(recipe.joints.begin(), recipe.joints.end(),
                                     [](const Joint& joint) { return joint.curve.size() > 1; });
    const auto check = [&](const auto& value, const auto& rate) {
      std::vector<double> slope(value[4].size(), 0.0), slope_of_six(slope);
      double seen = 0, wildest = 0;
      for (std::size_t k = 1; k <= 4; ++k) {
        for (std::size_t n = 0; n < slope.size(); ++n) {
          slope[n] += weights[k - 1] * (value[4 + k][n] - value[4 - k][n]) / h;
          slope_of_six[n] += weights_of_six[k - 1] * (value[4 + k][n] - value[4 - k][n]) / h;
        }
      }
      for (const auto& row : value) seen = std::max(seen, size_of(row, length));
      for (const auto& row : rate) wildest = std::max(wildest, size_of(row, length));
      // What the differences themselves miss: less than what those of order six do, and, where a contact passes a knot
      // of its spline (whose third derivative jumps, so that accelerations have a kink), less than the kink itself,
      // which fourth differences show.
      double truncation = size_of(difference(slope, slope_of_six), length);
      for (std::size_t r = 2; splines && r + 2 < rate.size(); ++r) {
        std::vector<double> kink(rate[r].size());
        for (std::size_t n = 0; n < kink.size(); ++n) {
          kink[n] = rate[r - 2][n] + rate[r + 2][n] - 4 * (rate[r - 1][n] + rate[r + 1][n]) + 6 * rate[r][n];
        }
        truncation = std::max(truncation, size_of(kink, length));
      }
      const double allowed = 1e-9 * (wildest + 1e-6) / motion.rcond + 1e-15 * seen / h / motion.rcond + truncation;
      RC_ASSERT(size_of(difference(slope, rate[4]), length) <= allowed);
    };
    check(motion.q, motion.qd);
    check(motion.qd, motion.qdd);
  });
  EXPECT_TRUE(passed);
  tally.expect_of_each(5);
}

// The same mechanism in other axes, other units, another order, with joints doubled: the same motion.
TEST(KinematicsProperty, MotionDoesNotDependOnAxesUnitsOrderOrRepetition) {
  Tally tally;
  const bool passed = rc::check([&tally] {
    const auto seed = *rc::gen::arbitrary<unsigned>();
    const int groups = *rc::gen::inRange(0, 6);
    const Recipe recipe = RandomMechanism(seed, groups).recipe();
    const std::array<double, 3> times = {0, 0.11, 0.3};
    const Motion reference = follow(recipe, {}, times);
    expect_a_reason(reference);
    if (!moves(reference) || reference.rcond < 1e-4) return;
    tally.count(recipe);
    const double length = recipe.extent();
    const Setting settings[] = {
        {.turn = 1.1},
        {.shift = {3 * length, -5 * length}},
        {.scale = 1e3},
        {.scale = 1e-3},
        {.order = seed | 1u},
        {.doubled = true},
        {.turn = -2.3, .scale = 0.0254, .shift = {length, length}, .order = seed | 1u, .doubled = true}};
    for (const Setting& setting : settings) {
      const Motion other = follow(recipe, setting, times);
      RC_LOG() << "turn " << setting.turn << " scale " << setting.scale << " order " << setting.order << " doubled "
               << setting.doubled << ": " << other.report.message << "\n";
      RC_ASSERT(other.report.ok());
      for (std::size_t row = 0; row < times.size(); ++row) {
        const double unit = setting.scale * length;
        // Rounding of places, which grows with their distance from the origin, changes rates by their gradient, as
        // large as motion itself shows it to be: dv = (qdd / qd) dq, and once more for accelerations.
        const double steepness =
            size_of(reference.qdd[row], length) / std::max(size_of(reference.qd[row], length), 0.01);
        const double rounding = 1e-13 * (1 + size_of(other.q[row], unit)) / reference.rcond;
        const auto compare = [&](const std::vector<double>& a, const std::vector<double>& b, int derivative) {
          std::vector<double> expected(a);
          for (std::size_t k = 0; k < a.size(); k += 3) {
            const Vec v =
                setting.scale * turned({a[k], a[k + 1]}, setting.turn) + (derivative == 0 ? setting.shift : Vec{});
            expected[k] = v.x;
            expected[k + 1] = v.y;
            if (derivative == 0) expected[k + 2] += setting.turn;
          }
          const double allowed =
              1e-11 * (1 + size_of(expected, unit)) / reference.rcond + rounding * std::pow(steepness, derivative);
          RC_ASSERT(size_of(difference(expected, b), unit) <= allowed);
        };
        compare(reference.q[row], other.q[row], 0);
        compare(reference.qd[row], other.qd[row], 1);
        compare(reference.qdd[row], other.qdd[row], 2);
      }
    }
  });
  EXPECT_TRUE(passed);
  tally.expect_of_each(5);
}

}  // namespace
}  // namespace catena::testing
