// A small mechanism whose parts are all different, in a state that meets no constraint: columns only read it.
#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <vector>

#include "catena/columns/column_set.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_distance.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "catena/model/model_add.hpp"

namespace catena::testing {

inline constexpr ColumnSources everything{
    .analysis = "test", .timed = false, .velocity = true, .acceleration = true, .multipliers = true, .work = true};

/// crank (centroid away from the author's origin) pinned to the ground at P0, rod pinned to the crank, one of each
/// absolute constraint, two drivers, a weld between rod and tool.
struct TwoBodies {
  Model model;
  std::shared_ptr<const Plan> plan;
  EvaluationWork work;
  std::unique_ptr<Evaluator> evaluator;
  std::vector<double> q, qd, qdd, lambda;
  std::vector<double> driver_work;
  double t = 0.7;

  TwoBodies() {
    model.gravity = {0.5, -9.81};
    const int crank = model.add_body(
        "crank", {.mass = 2.0, .inertia = 0.3, .position = {0.1, 0.2}, .angle = 0.4, .centroid = {0.25, -0.05}});
    const int rod = model.add_body("rod", {.mass = 1.5, .inertia = 0.2, .position = {0.9, 0.8}, .angle = -1.1});
    const int tool = model.add_body("tool", {.mass = 0.5, .inertia = 0.1, .position = {1.4, 0.1}, .angle = 0.6});
    model.add_point(crank, "tip", {0.6, 0.1});
    model.add_point(ground, "pivot", {0.1, 0.2});
    model.add("A", Revolute<double>{{0.1, 0.2}, {0.0, 0.0}}, ground, crank);
    model.add("B", Revolute<double>{{0.6, 0.1}, {-0.4, 0.02}}, crank, rod);
    model.add("G", Revolute<double>{{0.3, 0.0}, {1.0, 0.3}}, rod, ground);
    model.add("W", Weld<double>{{0.4, 0.1}, {-0.2, 0.3}}, rod, tool);
    model.add("X", AbsoluteX<double>{{0.3, 0.4}}, rod);
    model.add("D", AbsoluteDistance<double>{{0.3, -0.2}, {2.0, -1.0}}, rod, ground, 1.3);
    const double ramp[] = {0.2, 3.0, -0.5};
    model.add_driver("drive", RelativeAngle<double>{}, ground, crank, TimeFunction<double>::polynomial(ramp));
    const double stretch[] = {0.8, 0.4};
    model.add_driver("reach", AbsoluteDistance<double>{{0.1, 0.2}, {-1.0, 0.5}}, tool, ground,
                     TimeFunction<double>::polynomial(stretch));
    model.add("", AbsoluteAngle<double>{}, tool);
    make_plan();
  }

  void make_plan(const PlanOptions& options = {}) {
    plan = Plan::make(model, options);
    evaluator = std::make_unique<Evaluator>(plan, model, work);
    q = evaluator->given_configuration();
    qd.assign(q.size(), 0.0);
    qdd = qd;
    for (int k = 0; k < 3 * plan->moving; ++k) {
      q[static_cast<std::size_t>(k)] += 0.1 * std::sin(1.0 + k);
      qd[static_cast<std::size_t>(k)] = std::cos(2.0 * k);
      qdd[static_cast<std::size_t>(k)] = 2 * std::sin(3.0 * k + 1);
    }
    for (int r = 0; r < plan->rows; ++r) lambda.push_back(1 + std::sin(5.0 * r));
    driver_work.assign(model.elements.size(), 0.0);
  }

  Snapshot snapshot() {
    evaluator->set_time(t);
    evaluator->set_configuration(q);
    Snapshot s{*evaluator};
    s.t = t;
    s.q = q;
    s.qd = qd;
    s.qdd = qdd;
    s.lambda = lambda;
    s.driver_work = driver_work;
    return s;
  }

  /// Values of the named columns `dt` later, along q + qd dt + qdd dt^2 / 2.
  std::vector<double> values(const std::vector<std::string>& names, double dt = 0) {
    TwoBodies later(*this, dt);
    const ColumnSet columns = ColumnSet::resolve(model, *plan, names, everything);
    std::vector<double> out(columns.size());
    columns.evaluate(later.snapshot(), out);
    return out;
  }
  double value(const std::string& name, double dt = 0) { return values({name}, dt).at(0); }

  /// First and second time derivative of a column by central differences.
  double slope(const std::string& name) { return (value(name, 1e-5) - value(name, -1e-5)) / 2e-5; }

 private:
  TwoBodies(const TwoBodies& now, double dt)
      : model(now.model),
        plan(now.plan),
        q(now.q),
        qd(now.qd),
        qdd(now.qdd),
        lambda(now.lambda),
        driver_work(now.driver_work),
        t(now.t + dt) {
    evaluator = std::make_unique<Evaluator>(plan, model, work);
    for (std::size_t k = 0; k < q.size(); ++k) {
      q[k] += qd[k] * dt + qdd[k] * dt * dt / 2;
      qd[k] += qdd[k] * dt;
    }
  }
};

}  // namespace catena::testing
