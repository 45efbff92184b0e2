// What a mechanism looks like, as plain values: the one description from which pages and figures are drawn.
//
// A drawing is a list of shapes. Each shows a symbol, a few lines in coordinates (u, v) of its own, at a place that
// moves with the bodies:
//
//   r(u, v) = origin + u e_u + v e_v
//
//   anchor    origin    e_u                                  e_v
//   body      r_i       x' axis of body i, m                 y' axis of body i, m
//   point     r_P       s A_j axis                           R e_u
//   span      r_P       r_Q - r_P                            s R (r_Q - r_P) / |r_Q - r_P|
//   centres   r_P       (r_Q - r_P) / |r_Q - r_P|, m         R e_u, m
//   rope      0         x axis of the ground, m              its y axis, m: corners from rope_points.hpp
//
// P is fixed in body i at point_i, Q in body j at point_j; the ground's frame is that of body -1. s is the size of
// symbols in m, which the figure chooses, so that pins look alike on a watch and on a crane; R turns by a quarter.
// Where P and Q coincide a span has no direction: e_v then points upwards. Lengths m, angles rad.
#pragma once

#include <string>
#include <vector>

#include "catena/base/vec2.hpp"
#include "catena/model/body.hpp"
#include "catena/model/rope_path.hpp"

namespace catena {

/// What a line stands for; pages and figures give every role its colour and its place above or below others, in this
/// order from the lowest. The area of a wheel lies below everything, so that it hides no cam and no arm; its rim is a
/// gear.
enum class Role { wheel, support, guide, curve, link, belt, gear, cable, spring, rod, joint, driver, measure };
inline constexpr int roles = 13;

/// The name of a role in the data of pages.
const char* role_name(Role role);

/// Points joined by straight lines, or a circle.
struct DrawnLine {
  Role role = Role::joint;
  std::vector<Vec2<double>> points{};  ///< of a circle: its centre
  double radius = 0;                   ///< of a circle, in the unit of v; 0: no circle
  bool closed = false;
  bool filled = false;
  double width = 0;  ///< in sizes of symbols; 0: a thin line

  friend bool operator==(const DrawnLine&, const DrawnLine&) = default;
};

struct DrawnSymbol {
  std::vector<DrawnLine> lines;
};

enum class Anchor { body, point, span, centres, rope };

/// One symbol at its place.
struct DrawnShape {
  Anchor anchor = Anchor::body;
  int symbol = 0;
  int element = -1;  ///< number in the model; -1: a body itself
  int body_i = ground, body_j = ground;
  Vec2<double> point_i{}, point_j{};  ///< of the anchor `point`, point_j is the axis
  int rope = -1;                      ///< of the anchor `rope`: number of its way
};

/// A force whose arrow follows its functions of time.
struct DrawnLoad {
  int element = -1;
  int body = ground;
  Vec2<double> point{};
  bool in_body_axes = false;
};

/// A straight guide whose ends follow from how far the motion goes along it.
struct DrawnGuide {
  int shape = 0;    ///< a span between its ends, both on body i
  int member = -1;  ///< a span of body i itself, from point_i along the whole guide; -1: none
  int body_i = ground, body_j = ground;
  Vec2<double> point_i{}, axis_i{}, point_j{};
  bool observed = false;
  double low = 0, high = 0, first = 0;  ///< reach of point_j along the axis so far and its first place, m
  double module = 0;                    ///< of the teeth of a rack, m; 0: none
  double side = 1;                      ///< on which side of the axis the body of a rack lies
};

struct Drawing {
  std::vector<DrawnSymbol> symbols;
  std::vector<DrawnShape> shapes;  ///< those drawn first come first
  std::vector<DrawnLoad> loads;
  std::vector<DrawnGuide> guides;
  std::vector<RopePath> ropes;
  double typical_length = 0;  ///< median length of the links, m; 0: there are none
};

}  // namespace catena
