// What an element says of its looks: the vocabulary of its draw(pen).
//
//   template <class Pen>
//   void draw(Pen& pen) const { pen.pin(s_i, s_j); }
//
// An element tells what it is, a pin, a spring, a pair of gears; how those look is decided here and in symbols.hpp, for
// pages and figures alike. A new kind of element that none of these words fits gets a word of its own here. Places are
// local coordinates of body i or j, m; axes need no unit length. One pen serves one element.
#pragma once

#include "catena/drawing/shapes/drawing_builder.hpp"
#include "catena/elements/body_curve.hpp"

namespace catena {

class Pen {
 public:
  /// `driver`: the element's value is a function of time, so that an actuator is drawn in place of a rod.
  Pen(DrawingBuilder& builder, int element, int body_i, int body_j, bool driver)
      : builder_(builder), element_(element), i_(body_i), j_(body_j), driver_(driver) {}

  void pin(const Vec2<double>& s_i, const Vec2<double>& s_j);
  void weld(const Vec2<double>& s_i, const Vec2<double>& s_j);
  /// A block of body j in a straight guide of body i.
  void slide(const Vec2<double>& s_i, const Vec2<double>& axis_i, const Vec2<double>& s_j, const Vec2<double>& axis_j);
  /// A pin of body j in a straight slot of body i.
  void slot(const Vec2<double>& s_i, const Vec2<double>& axis_i, const Vec2<double>& s_j);
  /// A massless rod; a cylinder where it is driven.
  void rod(const Vec2<double>& s_i, const Vec2<double>& s_j);
  void rod_to_ground(const Vec2<double>& s_i, const Vec2<double>& place);
  /// A support that lets the point of body i move across `normal`, a direction of the ground.
  void roller(const Vec2<double>& s_i, const Vec2<double>& normal);
  /// A torque or a prescribed angle: a curved arrow, unless the angle is constant.
  void turn(const Vec2<double>& s_i);
  void turn(const Vec2<double>& s_i, const Vec2<double>& s_j);
  /// A distance along an axis that is prescribed.
  void measured_along(const Vec2<double>& s_i, const Vec2<double>& axis_i, const Vec2<double>& s_j);
  /// What has no picture of its own: a dashed line.
  void tie(const Vec2<double>& s_i, const Vec2<double>& s_j);

  void gears(const Vec2<double>& s_i, double radius_i, const Vec2<double>& s_j, double radius_j, bool internal);
  void belt(const Vec2<double>& s_i, double radius_i, const Vec2<double>& s_j, double radius_j, bool crossed);
  void rack_and_pinion(const Vec2<double>& s_i, const Vec2<double>& axis_i, const Vec2<double>& s_j, double radius,
                       int side);

  /// Curves come before the point that follows them: a straight one is drawn as far as that point goes.
  void curve_on_i(const BodyCurve<double>& curve) { curve_on(i_, curve, 0); }
  void curve_on_j(const BodyCurve<double>& curve) { curve_on(j_, curve, 0); }
  /// A curve that is free on its side `side` alone: the other one is hatched.
  void wall_on_i(const BodyCurve<double>& curve, int side) { curve_on(i_, curve, side); }
  /// A point of body j, or a disc about it, that touches something.
  void follower_on_j(const Vec2<double>& s_j, double radius);
  void face_on_j(const Vec2<double>& s_j, const Vec2<double>& axis_j);

  void spring(const Vec2<double>& s_i, const Vec2<double>& s_j, bool elastic, bool damped);
  void spiral_spring(const Vec2<double>& s_i, const Vec2<double>& s_j);
  void cable(const Vec2<double>& s_i, const Vec2<double>& s_j);
  /// A rope, along the whole way that the model keeps for it; where it keeps none, between two circles, or points
  /// where a radius is zero. The circles are drawn with it.
  void rope(const Vec2<double>& s_i, double radius_i, const Vec2<double>& s_j, double radius_j);
  void bushing(const Vec2<double>& s_i, const Vec2<double>& s_j);
  void force(const Vec2<double>& s_i, bool in_body_axes);
  /// Ends of a slide at these distances along the axis; infinite ones are none.
  void limits(const Vec2<double>& s_i, const Vec2<double>& axis_i, double low, double high);

 private:
  void span(const Vec2<double>& s_i, const Vec2<double>& s_j, DrawnSymbol look);
  /// A symbol at a place of `body`, along an axis of `axis_body`.
  void point(int body, const Vec2<double>& local, int axis_body, const Vec2<double>& axis, DrawnSymbol look);
  void pulley(const RopeNode& node);
  void wheel(int body, const Vec2<double>& centre, DrawnLine rim, double spoke);
  void toothed_wheel(const DrawingBuilder::Wheel& wheel, bool ring);
  void curve_on(int body, const BodyCurve<double>& curve, int side);
  Frame<double> given(int body) const { return builder_.model().frame(body); }

  DrawingBuilder& builder_;
  int element_, i_, j_;
  bool driver_;
};

/// The drawing of a mechanism: every element, then the links of the bodies.
Drawing draw_model(const Model& model);

}  // namespace catena
