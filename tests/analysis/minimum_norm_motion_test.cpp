// The motion of least velocities where drivers leave freedom: closed forms, dense algebra, invariance, lock-up.
#include "catena/analysis/kinematics/minimum_norm_motion.hpp"

#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>

#include "analysis/linkages.hpp"
#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/model/model_add.hpp"
#include "references/dense.hpp"

namespace catena::testing {
namespace {

/// Rows of a run: t, and coordinates of all bodies in plan order with velocities and accelerations.
struct Rows {
  AnalysisReport report;
  std::vector<double> t;
  std::vector<std::vector<double>> q, qd, qdd;
};

template <class Analysis>
Rows follow(Analysis& analysis, const TimeGrid& grid) {
  Rows rows;
  RowFunction take([&](const Snapshot& s) {
    rows.t.push_back(s.t);
    const std::size_t bodies = s.q.size() - 3;
    rows.q.emplace_back(s.q.begin(), s.q.begin() + static_cast<std::ptrdiff_t>(bodies));
    rows.qd.emplace_back(s.qd.begin(), s.qd.begin() + static_cast<std::ptrdiff_t>(bodies));
    rows.qdd.emplace_back(s.qdd.begin(), s.qdd.begin() + static_cast<std::ptrdiff_t>(bodies));
    return true;
  });
  rows.report = analysis.run(grid, {.velocity = true, .acceleration = true}, take);
  return rows;
}

/// How an arm is built: in another unit of length, without masses, with every joint twice.
struct Setting {
  double scale = 1;
  bool masses = true, doubled = false;
};

/// An arm of pinned rods of random lengths whose end is led along a Lissajous curve.
std::shared_ptr<Model> arm(unsigned seed, int links, const Setting& setting = {}) {
  auto model = std::make_shared<Model>();
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> any(0, 1);
  Vec2<double> end{0, 0};
  int last = ground;
  for (int k = 0; k < links; ++k) {
    const double length = setting.scale * (0.3 + any(random)), angle = 0.3 + 2 * any(random) - (k % 2 ? 2 : 0);
    const Vec2<double> next = end + length * Vec2<double>{std::cos(angle), std::sin(angle)};
    const std::string name = "link" + std::to_string(k);
    const double mass = 0.5 + 5 * any(random);
    int body = -1;
    if (setting.masses) {
      body = model->add_body(
          name, {.mass = mass, .inertia = mass * length * length / 12, .position = 0.5 * (end + next), .angle = angle});
    } else {
      body = model->add_body(name, {.position = 0.5 * (end + next), .angle = angle});
    }
    model->add_point(body, "from", {-length / 2, 0});
    model->add_point(body, "to", {length / 2, 0});
    for (int copy = 0; copy < (setting.doubled ? 2 : 1); ++copy) {
      const std::string pin_name = "pin" + std::to_string(k) + (copy ? "again" : "");
      last == ground ? pin(*model, pin_name, {0, 0}, body, "from") : pin(*model, pin_name, last, "to", body, "from");
    }
    end = next;
    last = body;
  }
  const auto about = [&](double start, double omega) {
    const std::array<TimeFunction<double>, 2> terms = {TimeFunction<double>(start),
                                                       TimeFunction<double>::harmonic(0.15 * setting.scale, omega)};
    return TimeFunction<double>::sum({terms.begin(), terms.end()});
  };
  model->add_driver("x", AbsoluteX<>{*model->find_point(last, "to")}, last, ground, about(end.x, 1.3));
  model->add_driver("y", AbsoluteY<>{*model->find_point(last, "to")}, last, ground, about(end.y, 2.1));
  return model;
}

// A body whose point P is led along x: phi' = -a sin phi s' / (rho^2 + a^2 sin^2 phi), which integrates to
// (rho^2 / a) ln tan(phi / 2) - a cos phi + s = const, rho = a being the distance of the only attachment.
TEST(MinimumNormMotion, FollowsTheClosedFormOfATowedBody) {
  const double a = 0.4, start = 2.0;
  auto model = std::make_shared<Model>();
  const int body = model->add_body("trailer", {.position = {-a * std::cos(start), 1}, .angle = start});
  model->add_driver("tow", AbsoluteX<>{{a, 0}}, body, ground, ramp(0, 0.5));
  MinimumNormMotion analysis(model);
  const Rows rows = follow(analysis, TimeGrid::range(0, 4, 0.5));
  ASSERT_TRUE(rows.report.ok()) << rows.report.message;
  const auto invariant = [&](double phi, double s) { return a * std::log(std::tan(phi / 2)) - a * std::cos(phi) + s; };
  for (std::size_t k = 0; k < rows.t.size(); ++k) {
    EXPECT_NEAR(invariant(rows.q[k][2], 0.5 * rows.t[k]), invariant(start, 0), 1e-12);
    EXPECT_EQ(rows.qd[k][1], 0);
    EXPECT_EQ(rows.q[k][1], 0);
  }
  EXPECT_LT(rows.q.back()[2], 0.1);
  EXPECT_EQ(rows.report.dof, 2);
}

// Against the dense pseudo-inverse of Phi_q W^-1/2, with masses, without them, with joints doubled.
TEST(MinimumNormMotion, VelocitiesAreThePseudoInverseOfDenseAlgebra) {
  for (unsigned seed = 1; seed <= 30; ++seed) {
    const int links = 3 + static_cast<int>(seed % 4);
    const Setting setting{.scale = 1, .masses = seed % 3 != 0, .doubled = seed % 2 == 0};
    MinimumNormMotion analysis(arm(seed, links, setting));
    const double t = 0.37;
    const Rows rows = follow(analysis, TimeGrid::instant(t));
    ASSERT_TRUE(rows.report.ok()) << rows.report.message;
    ASSERT_EQ(rows.report.dof, links - 2);
    Evaluator& evaluator = analysis.evaluator();
    const Plan& plan = analysis.plan();
    std::vector<double> values(static_cast<std::size_t>(plan.trash_slot()) + 1),
        nu(static_cast<std::size_t>(plan.rows));
    evaluator.start_jacobian(values);
    evaluator.jacobian(values);
    evaluator.nu(nu);
    Eigen::MatrixXd jacobian = Eigen::MatrixXd::Zero(plan.rows, plan.columns);
    Eigen::VectorXd root(plan.columns);
    const std::vector<double> radius = evaluator.attachment_radii();
    for (int c = 0; c < plan.columns; ++c) {
      const auto& body =
          evaluator.model().bodies[static_cast<std::size_t>(plan.model_body[static_cast<std::size_t>(c / 3)])];
      const double rho = radius[static_cast<std::size_t>(c / 3)];
      root[c] = std::sqrt(setting.masses ? (c % 3 == 2 ? body.inertia : body.mass) : c % 3 == 2 ? rho * rho : 1);
      for (int k = plan.jacobian.column_start[static_cast<std::size_t>(c)];
           k < plan.jacobian.column_start[static_cast<std::size_t>(c) + 1]; ++k) {
        const auto place = static_cast<std::size_t>(k);
        jacobian(plan.jacobian.row_index[place], c) = values[place] / root[c];
      }
    }
    const Eigen::VectorXd expected = LeastSquares<double>(jacobian)
                                         .solve(Eigen::Map<const Eigen::VectorXd>(nu.data(), plan.rows))
                                         .cwiseQuotient(root);
    for (int c = 0; c < plan.columns; ++c) {
      EXPECT_NEAR(rows.qd[0][static_cast<std::size_t>(c)], expected[c], 1e-11 * (1 + expected.cwiseAbs().maxCoeff()));
    }
  }
}

TEST(MinimumNormMotion, PositionsVelocitiesAndAccelerationsBelongTogether) {
  constexpr double weights[] = {4.0 / 5, -1.0 / 5, 4.0 / 105, -1.0 / 280};
  const double h = 0.004;
  for (unsigned seed = 1; seed <= 12; ++seed) {
    const Setting setting{.scale = std::pow(10.0, static_cast<double>(seed % 5) - 2), .masses = seed % 2 == 0};
    MinimumNormMotion analysis(arm(seed, 4, setting));
    std::vector<double> times;
    for (int k = -4; k <= 4; ++k) times.push_back(0.5 + k * h);
    const Rows rows = follow(analysis, TimeGrid::list(times));
    ASSERT_TRUE(rows.report.ok()) << rows.report.message;
    const auto check = [&](const auto& value, const auto& rate) {
      for (std::size_t n = 0; n < value[4].size(); ++n) {
        const double unit = n % 3 == 2 ? 1 : setting.scale;
        double slope = 0;
        for (std::size_t k = 1; k <= 4; ++k) slope += weights[k - 1] * (value[4 + k][n] - value[4 - k][n]) / h;
        EXPECT_NEAR(slope / unit, rate[4][n] / unit, 1e-10 * (1 + std::abs(rate[4][n] / unit))) << seed << " " << n;
      }
    };
    check(rows.q, rows.qd);
    check(rows.qd, rows.qdd);
  }
}

TEST(MinimumNormMotion, DoesNotDependOnRowsUnitsOrDoubledJoints) {
  for (unsigned seed = 1; seed <= 10; ++seed) {
    MinimumNormMotion reference_analysis(arm(seed, 5));
    const Rows reference = follow(reference_analysis, TimeGrid::instant(3));
    ASSERT_TRUE(reference.report.ok()) << reference.report.message;
    const auto compare = [&](const Setting& setting, const TimeGrid& grid) {
      MinimumNormMotion analysis(arm(seed, 5, setting));
      const Rows rows = follow(analysis, grid);
      ASSERT_TRUE(rows.report.ok()) << rows.report.message;
      for (std::size_t n = 0; n < reference.q[0].size(); ++n) {
        const double unit = n % 3 == 2 ? 1 : setting.scale;
        EXPECT_NEAR(rows.q.back()[n] / unit, reference.q[0][n], 1e-10) << seed;
        EXPECT_NEAR(rows.qd.back()[n] / unit, reference.qd[0][n], 1e-9) << seed;
        EXPECT_NEAR(rows.qdd.back()[n] / unit, reference.qdd[0][n], 1e-8) << seed;
      }
    };
    compare({}, TimeGrid::range(0, 3, 0.01));
    compare({.scale = 1e-3}, TimeGrid::instant(3));
    compare({.scale = 1e3}, TimeGrid::instant(3));
    compare({.doubled = true}, TimeGrid::range(0, 3, 1));
  }
}

// Beside a driven mechanism what nothing drives stays, and what is driven moves as kinematics has it.
TEST(MinimumNormMotion, LeavesAloneWhatNothingDrives) {
  const FourBar bars;
  const TimeFunction<double> angle = ramp(1, 2);
  auto driven = driven_four_bar(bars, angle);
  auto model = driven_four_bar(bars, angle);
  const int pendulum = add_rod(*model, "pendulum", {1, 1}, {1.3, 0.8});
  pin(*model, "hang", {1, 1}, pendulum, "from");
  model->add_body("stone", {.mass = 1, .inertia = 1, .position = {2, 2}, .angle = 0.5});
  Kinematics kinematics(driven);
  MinimumNormMotion analysis(model);
  const TimeGrid grid = TimeGrid::range(0, 4, 0.5);
  const Rows expected = follow(kinematics, grid), rows = follow(analysis, grid);
  ASSERT_TRUE(expected.report.ok());
  ASSERT_TRUE(rows.report.ok()) << rows.report.message;
  EXPECT_EQ(rows.report.dof, 4);
  for (std::size_t k = 0; k < rows.t.size(); ++k) {
    for (std::size_t n = 0; n < 9; ++n) {
      EXPECT_NEAR(rows.q[k][n], expected.q[k][n], 1e-12);
      EXPECT_NEAR(rows.qd[k][n], expected.qd[k][n], 1e-11);
      EXPECT_NEAR(rows.qdd[k][n], expected.qdd[k][n], 1e-10);
    }
    for (std::size_t n = 9; n < rows.q[k].size(); ++n) {
      EXPECT_NEAR(rows.q[k][n], rows.q[0][n], 1e-15);
      EXPECT_NEAR(rows.qd[k][n], 0, 1e-15);
      EXPECT_NEAR(rows.qdd[k][n], 0, 1e-15);
    }
  }
}

TEST(MinimumNormMotion, LocatesWhereAnArmIsStretchedOut) {
  for (const bool doubled : {false, true}) {
    auto model = std::make_shared<Model>();
    const Vec2<double> place[] = {{0, 0}, {0.5, 0.6}, {1.2, 0.5}, {1.5, 0}};
    int last = ground;
    for (int k = 0; k < 3; ++k) {
      const int body = add_rod(*model, "link" + std::to_string(k), place[k], place[k + 1]);
      for (int copy = 0; copy < (doubled ? 2 : 1); ++copy) {
        const std::string name = "pin" + std::to_string(k) + (copy ? "again" : "");
        last == ground ? pin(*model, name, {0, 0}, body, "from") : pin(*model, name, last, "to", body, "from");
      }
      last = body;
    }
    const Vec2<double> end = *model->find_point(last, "to");
    model->add_driver("x", AbsoluteX<>{end}, last, ground, ramp(1.5, 0.3));
    model->add("y", AbsoluteY<>{end}, last, ground, 0.0);
    MinimumNormMotion analysis(model);
    const Rows rows = follow(analysis, TimeGrid::range(0, 10, 1));
    EXPECT_EQ(rows.report.status, Status::lock_up) << rows.report.message;
    const double reach = std::hypot(0.5, 0.6) + std::hypot(0.7, 0.1) + std::hypot(0.3, 0.5);
    const std::string& message = rows.report.message;
    const double found = std::stod(message.substr(message.find("t = ") + 4));
    EXPECT_NEAR(found, (reach - 1.5) / 0.3, 1e-9) << message;
    EXPECT_NE(message.find("\"x\""), std::string::npos) << message;
    // The last row is where the arm is stretched out.
    ASSERT_EQ(rows.t.size(), 3u);
    EXPECT_NEAR(rows.t.back(), found, 1e-11);
  }
}

// A parallelogram that passes its flat positions, with a link hung from its coupler that nothing drives: it stays a
// parallelogram, and the link ends where it ends with other rows.
TEST(MinimumNormMotion, GoesOnAlongItsBranchWhereBranchesMeet) {
  for (double scale : {1e-2, 1.0, 1e3}) {
    for (double start : {0.3, 0.7, 1.3, 2.9}) {
      std::vector<double> ends;
      for (double every : {0.05, 0.37, 20.0}) {
        const FourBar f{0.7 * scale, 2 * scale, 0.7 * scale, 2 * scale};
        auto model = driven_four_bar(f, ramp(start, 1));
        const int loose = add_rod(*model, "loose", {2 * scale, scale}, {3 * scale, scale});
        model->add("P", Revolute<>{{0.2 * scale, 0.1 * scale}, *model->find_point(loose, "from")},
                   model->find_body("coupler"), loose);
        MinimumNormMotion analysis(model);
        const Rows rows = follow(analysis, TimeGrid::range(0, 20, every));
        ASSERT_TRUE(rows.report.ok()) << start << " " << every << ": " << rows.report.message;
        const auto place = [&](const char* name) {
          return static_cast<std::size_t>(
              3 * analysis.plan().plan_body[static_cast<std::size_t>(model->find_body(name))] + 2);
        };
        for (std::size_t k = 0; k < rows.t.size(); ++k) {
          const double off = std::remainder(rows.q[k][place("rocker")] - start - rows.t[k], 2 * std::numbers::pi);
          EXPECT_NEAR(off, 0, 1e-10) << start << " " << every << " t = " << rows.t[k];
        }
        ends.push_back(rows.q.back()[place("loose")]);
      }
      EXPECT_NEAR(ends[1], ends[0], 1e-9);
      EXPECT_NEAR(ends[2], ends[0], 1e-9);
    }
  }
}

TEST(MinimumNormMotion, NamesDriversThatContradictEachOther) {
  auto model = arm(3, 4);
  const int last = model->find_body("link3");
  const double x = model->frame(last).point(*model->find_point(last, "to")).x;
  model->add_driver("other", AbsoluteX<>{*model->find_point(last, "to")}, last, ground, ramp(x, -1));
  MinimumNormMotion analysis(model);
  const Rows rows = follow(analysis, TimeGrid::range(0, 1, 0.1));
  EXPECT_EQ(rows.report.status, Status::inconsistent);
  EXPECT_NE(rows.report.message.find("\"x\""), std::string::npos) << rows.report.message;
  EXPECT_NE(rows.report.message.find("\"other\""), std::string::npos) << rows.report.message;
  EXPECT_EQ(rows.report.message.find("\"y\""), std::string::npos) << rows.report.message;
}

}  // namespace
}  // namespace catena::testing
