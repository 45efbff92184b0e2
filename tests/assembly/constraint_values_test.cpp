// Constraints as a model and its evaluator hold them: far from the origin, in bodies with a frame of the author's own,
// in other units, driven.
#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_distance.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/belt.hpp"
#include "catena/elements/constraints/cam_cam.hpp"
#include "catena/elements/constraints/cam_flat.hpp"
#include "catena/elements/constraints/coupler.hpp"
#include "catena/elements/constraints/displacement.hpp"
#include "catena/elements/constraints/gear.hpp"
#include "catena/elements/constraints/point_on_curve.hpp"
#include "catena/elements/constraints/rack_pinion.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/relative_distance.hpp"
#include "catena/elements/constraints/relative_x.hpp"
#include "catena/elements/constraints/relative_y.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/slot.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "catena/model/model_add.hpp"

namespace catena {
namespace {

int add_body(Model& model, const char* name, const Vec2<double>& position, double angle,
             const Vec2<double>& centroid = {}) {
  BodyValues values;
  values.position = position;
  values.angle = angle;
  values.centroid = centroid;
  return model.add_body(name, values);
}

/// One of each joint between two bodies; `size` is the unit of length, `corner` where the bodies' own frames have their
/// origin in those that the numbers refer to.
void add_joints(Model& model, int a, int b, double size, const Vec2<double>& corner_a = {},
                const Vec2<double>& corner_b = {}) {
  const Vec2<double> p = size * Vec2<double>{0.25, -0.5} - corner_a, q = size * Vec2<double>{-0.125, 0.5} - corner_b;
  const auto shifted = [](BodyCurve<double> curve, const Vec2<double>& by) { return curve += by; };
  const BodyCurve<double> round(Curve<double>::circle(size * Vec2<double>{0.125, 0.25}, size * 0.375));
  model.add("revolute", Revolute<double>{p, q}, a, b);
  if (a != ground) model.add("weld", Weld<double>{p, q}, a, b);  // else it would be eliminated, and b with it
  model.add("x", RelativeX<double>{p, q}, a, b);
  model.add("distance", RelativeDistance<double>{p, q}, a, b);
  model.add("coupler", Coupler<double>{p, q}, a, b);
  model.add("translational", Translational<double>{p, q, {1, 2}}, a, b);
  model.add("displacement", Displacement<double>{p, q, {1, 2}}, a, b);
  model.add("slot", Slot<double>{p, q, {1, 2}}, a, b);
  model.add("gear", Gear<double>{p, q, size * 0.5, size * 0.25}, a, b);
  model.add("belt", Belt<double>{p, q, size * 0.5, size * 0.25}, a, b);
  model.add("rack", RackPinion<double>{p, q, {1, 2}, size * 0.25}, a, b);
  model.add("point", PointOnCurve<double>{p, q, shifted(round, -corner_a)}, a, b);
  model.add("flat", CamFlat<double>{p, q, {1, 2}, shifted(round, -corner_a)}, a, b);
  model.add("cams", CamCam<double>{p, q, shifted(round, -corner_a), shifted(round, -corner_b)}, a, b);
}

struct Values {
  std::vector<double> phi, jacobian, gamma;
};

/// Everything at the given configuration displaced by a little.
Values evaluate(const Model& model, double size) {
  EvaluationWork work;
  Evaluator evaluator(Plan::make(model), model, work);
  const Plan& plan = evaluator.plan();
  std::vector<double> q = evaluator.given_configuration(), qd(q.size());
  for (int b = 0; b < plan.moving; ++b) {
    for (int k = 0; k < 3; ++k) {
      const double unit = (k == 2 ? 1 : size) * (1 + plan.model_body[static_cast<std::size_t>(b)]);
      q[static_cast<std::size_t>(3 * b + k)] += 0.0625 * unit * (k - 1.5);
      qd[static_cast<std::size_t>(3 * b + k)] = unit * (0.5 + k);
    }
  }
  evaluator.set_configuration(q);
  const auto rows = static_cast<std::size_t>(plan.rows);
  Values v{std::vector<double>(rows), std::vector<double>(static_cast<std::size_t>(plan.trash_slot()) + 1),
           std::vector<double>(rows)};
  evaluator.phi(v.phi);
  evaluator.start_jacobian(v.jacobian);
  evaluator.jacobian(v.jacobian);
  v.jacobian.pop_back();
  evaluator.gamma(qd, v.gamma);
  return v;
}

void expect_same(const Values& a, const Values& b, double tolerance) {
  const auto compare = [&](const std::vector<double>& u, const std::vector<double>& v, const char* what) {
    ASSERT_EQ(u.size(), v.size());
    for (std::size_t k = 0; k < u.size(); ++k)
      EXPECT_NEAR(u[k], v[k], tolerance * (1 + std::abs(v[k]))) << what << " " << k;
  };
  compare(a.phi, b.phi, "phi");
  compare(a.jacobian, b.jacobian, "Jacobian");
  compare(a.gamma, b.gamma, "gamma");
}

Model two_bodies(const Vec2<double>& away, double size) {
  Model model;
  const int a = add_body(model, "a", away + size * Vec2<double>{0.5, 0.25}, 0.6);
  const int b = add_body(model, "b", away + size * Vec2<double>{2.0, -0.75}, -0.8);
  add_joints(model, a, b, size);
  return model;
}

// 2^20 sizes from the origin nothing is lost: the positions are exact there, and rows see differences alone.
TEST(ConstraintValues, AreTheSameFarFromTheOrigin) {
  expect_same(evaluate(two_bodies({1048576, -1048576}, 1), 1), evaluate(two_bodies({}, 1), 1), 1e-15);
}

// Also against the ground, whose frame stays at the origin: its points are far away, yet the sums are exact.
TEST(ConstraintValues, AreTheSameFarFromTheOriginOnTheGround) {
  const auto on_ground = [](const Vec2<double>& away) {
    Model model;
    const int b = add_body(model, "b", away + Vec2<double>{2.0, -0.75}, -0.8);
    add_joints(model, ground, b, 1, -away, {});
    return model;
  };
  // The curves lie in the ground's frame, a million sizes out: their own rounding remains.
  expect_same(evaluate(on_ground({1048576, -1048576}), 1), evaluate(on_ground({}), 1), 1e-9);
}

// A body may have its frame anywhere: with the same shape on it nothing changes, the curves included.
TEST(ConstraintValues, DoNotDependOnTheAuthorsFrame) {
  const Vec2<double> corner_a{0.5, -1.0}, corner_b{-0.75, 0.25};
  const Frame<double> a = make_frame(0.5, 0.25, 0.6), b = make_frame(2.0, -0.75, -0.8);
  Model model;
  // The origin of each author's frame is at `corner` in the centroidal one.
  const int body_a = add_body(model, "a", a.point(corner_a), 0.6, -corner_a);
  const int body_b = add_body(model, "b", b.point(corner_b), -0.8, -corner_b);
  add_joints(model, body_a, body_b, 1, corner_a, corner_b);
  expect_same(evaluate(model, 1), evaluate(two_bodies({}, 1), 1), 1e-13);
}

// A machine in millimetres and one in kilometres: rows in metres grow with it, those in radians do not; a step of
// Newton's method is the same in either.
TEST(ConstraintValues, ScaleWithTheMachine) {
  const Model unit = two_bodies({}, 1);
  const Values one = evaluate(unit, 1);
  const auto plan = Plan::make(unit);
  for (const double size : {1.0 / 1024, 1024.0}) {
    Values scaled = evaluate(two_bodies({}, size), size);
    for (std::size_t r = 0; r < scaled.phi.size(); ++r) {
      const double row = plan->row_is_angle[r] ? 1 : size;
      scaled.phi[r] /= row;
      scaled.gamma[r] /= row;
    }
    for (int c = 0; c < plan->columns; ++c) {
      for (int k = plan->jacobian.column_start[static_cast<std::size_t>(c)];
           k < plan->jacobian.column_start[static_cast<std::size_t>(c) + 1]; ++k) {
        const auto r = static_cast<std::size_t>(plan->jacobian.row_index[static_cast<std::size_t>(k)]);
        const bool angle = plan->coordinate[static_cast<std::size_t>(c)] % 3 == 2;
        scaled.jacobian[static_cast<std::size_t>(k)] *= (angle ? 1 : size) / (plan->row_is_angle[r] ? 1 : size);
      }
    }
    expect_same(scaled, one, 1e-12);
  }
}

// Every scalar constraint can be driven: at all times the row says measure - c(t), squared forms as a length.
TEST(ConstraintValues, EveryScalarConstraintIsDriven) {
  Model model;
  const int a = add_body(model, "a", {0.5, 0.25}, 0.6), b = add_body(model, "b", {2.0, -0.75}, -0.8);
  const Vec2<double> p{0.25, -0.5}, q{-0.125, 0.5};
  const double coefficients[] = {1.5, 0.75, -0.25};
  const TimeFunction<double> c = TimeFunction<double>::polynomial(coefficients);
  model.add_driver("ax", AbsoluteX<double>{p}, a, ground, c);
  model.add_driver("ay", AbsoluteY<double>{p}, a, ground, c);
  model.add_driver("aa", AbsoluteAngle<double>{p}, a, ground, c);
  model.add_driver("ad", AbsoluteDistance<double>{p, {3, 1}}, a, ground, c);
  model.add_driver("rx", RelativeX<double>{p, q}, a, b, c);
  model.add_driver("ry", RelativeY<double>{p, q}, a, b, c);
  model.add_driver("ra", RelativeAngle<double>{p, q}, a, b, c);
  model.add_driver("rd", RelativeDistance<double>{p, q}, a, b, c);
  model.add_driver("co", Coupler<double>{p, q}, a, b, c);
  model.add_driver("di", Displacement<double>{p, q, {1, 2}}, a, b, c);
  model.add_driver("sl", Slot<double>{p, q, {1, 2}}, a, b, c);
  EvaluationWork work;
  Evaluator evaluator(Plan::make(model), model, work);
  evaluator.set_configuration(evaluator.given_configuration());
  const auto rows = static_cast<std::size_t>(evaluator.plan().rows);
  ASSERT_EQ(rows, 11u);
  std::vector<double> phi(rows), nu(rows), gamma(rows), rest(static_cast<std::size_t>(evaluator.plan().coordinates()));
  for (const double t : {0.0, 0.3, 1.1}) {
    evaluator.set_time(t);
    evaluator.phi(phi);
    evaluator.nu(nu);
    evaluator.gamma(rest, gamma);
    const Taylor<double> value = c.evaluate(t);
    for (std::size_t r = 0; r < rows; ++r) {
      const int element = evaluator.plan().row_element[r];
      const std::string_view type = model.element_type(element);
      SCOPED_TRACE(::testing::Message() << type << " at " << t);
      const double measured = evaluator.measure(element, {}, {}).value;
      const bool squared = type == "absolute_distance" || type == "relative_distance" || type == "coupler";
      // Scaled by 1/(2 c), c at time zero.
      const double scale = squared ? 0.5 / 1.5 : 1;
      const Taylor<double> prescribed = squared ? value * value : value;
      EXPECT_NEAR(phi[r], scale * ((squared ? measured * measured : measured) - prescribed.f), 1e-14);
      EXPECT_NEAR(nu[r], scale * prescribed.d, 1e-15);
      EXPECT_NEAR(gamma[r], scale * prescribed.dd, 1e-15);
    }
  }
}

TEST(ConstraintValues, ModelsRefuseWhatMakesNoConstraint) {
  Model model;
  const int a = add_body(model, "a", {0, 0}, 0), b = add_body(model, "b", {0, 0}, 0);
  const auto said = [&](const auto& add) -> std::string {
    try {
      add();
    } catch (const ModelError& error) {
      return error.what();
    }
    return "";
  };
  const std::string distance =
      " needs a distance above zero; for zero use a revolute joint or absolute_x and absolute_y";
  EXPECT_EQ(said([&] { model.add("", Coupler<double>{}, a, b); }), "coupler" + distance);
  EXPECT_EQ(said([&] { model.add("", RelativeDistance<double>{}, a, b, 0.0); }), "relative_distance" + distance);
  EXPECT_EQ(said([&] { model.add("", AbsoluteDistance<double>{}, a, ground, -1.0); }), "absolute_distance" + distance);
  EXPECT_EQ(said([&] { model.add("", Slot<double>{}, a, b); }), "slot: axis_i has no direction");
  EXPECT_EQ(said([&] { model.add("", Gear<double>{.radius_i = 1, .radius_j = 2}, a, b); }),
            "gear: its centres coincide in the given configuration");
  EXPECT_EQ(said([&] { model.add("", PointOnCurve<double>{}, a, b); }), "point_on_curve: has no curve");
  EXPECT_TRUE(model.elements.empty());
}

}  // namespace
}  // namespace catena
