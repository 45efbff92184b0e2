// Ropes whose way changes: a straight line comes to touch a pulley of the list, or leaves it.
//
//   theta_out - theta_in = b c        c > 0: touched, c < 0: beside;  the way changes where c = 0
//
// b: side of the pulley. c is that of the tangents between the pulley and what is touched before and after it, whether
// the rope touches it or not, and continuous in time. At c = 0 both ways have the same length and, as its gradient
// is made of the same unit vectors, the same rate: only the second derivative jumps. Which way holds is not kept in the
// model but in its elements: lay() writes those of another way over them. Units: m, rad. Source: rope_span.hpp.
#pragma once

#include <numbers>
#include <vector>

#include "catena/model/rope_layout.hpp"

namespace catena {

/// A stretch of a rope that passes a circle.
struct RopeRoute {
  int element = -1;
  bool elastic = false;
  std::vector<RopePulley<double>> nodes{};  ///< ends included
  std::vector<char> off{};                  ///< by node: the rope lies beside it
  RopeMemory memory{};
};

/// Tangents are followed from one place to another up to this, rad: the rest of half a turn keeps the sense apart.
inline constexpr double most_turned_between_places = std::numbers::pi - 0.3;

/// The routes of a model in its given configuration.
std::vector<RopeRoute> rope_routes(const Model& model);

/// Finds which pulleys a route lies beside where its bodies are at `frames`, by node, and forgets what was known.
/// False: as before. Throws ModelError, as lay().
bool find_off(const Model& model, RopeRoute& route, const std::vector<Frame<double>>& frames);

/// Takes over how far a route is wound, as it was found at some place; its pulleys must be as many.
void take_up(RopeRoute& route, const RopeTurns& turns);

/// Goes on with a route from where it was last to where its bodies are now: no tangent turns by half a turn between.
struct RouteStep {
  bool changed = false;  ///< it meets or leaves pulleys
  double turned = 0;     ///< how far the tangents of the way, and those beside against them, have turned at most, rad
};
/// Throws ModelError, as lay().
RouteStep go_on(const Model& model, RopeRoute& route, const std::vector<Frame<double>>& frames);

/// Writes the way of the route over the elements of the model. Throws ModelError, as a phrase about the rope, where it
/// has no straight line.
void lay(Model& model, RopeRoute& route, const std::vector<Frame<double>>& frames);

/// Appends an equation of how much of a route lies behind a node, from the material of that node's circle on: the other
/// part of the rope as it would be if the circle held it. Its length is zero. The number of its element is returned.
int append_behind(Model& model, const RopeRoute& route, int node, const std::vector<Frame<double>>& frames);

/// Writes that part over the equation's elements as the route lies now, behind `node`; these have room for what is
/// behind node `last_of_run`. Throws ModelError, as lay().
void lay_behind(Model& model, const RopeRoute& route, int element, int node, int last_of_run,
                const std::vector<Frame<double>>& frames);

/// How long the way is behind a node that is touched, from where the rope leaves its circle, m.
double length_behind(const Model& model, const RopeRoute& route, int node, const std::vector<Frame<double>>& frames);

/// The tangents of a route: contacts and turning along the motion, from where it was laid.
class RouteWatch {
 public:
  RouteWatch(const Model& model, const RopeRoute& route, const std::vector<Frame<double>>& frames);

  /// c of a pulley that can be left. Not a number where one of its neighbours is inside its circle.
  double contact(int node, const std::vector<Frame<double>>& frames) const;
  /// The least |h|^2 - D^2 of the tangents, m^2: zero where an end or a pulley comes into the circle of the next one.
  double room(const std::vector<Frame<double>>& frames) const;
  /// How far the tangents have turned at most, rad.
  double turned(const std::vector<Frame<double>>& frames) const;
  /// How far the route is wound there.
  RopeTurns turns(const std::vector<Frame<double>>& frames) const;
  /// How far the tangents were at first from where the route's memory has them, at most, rad.
  double moved() const { return moved_; }
  /// The pulleys that can be left.
  const std::vector<int>& pulleys() const { return pulleys_; }

 private:
  struct Tangent {
    int a, b;
    RopeSpan<double> span;
  };
  double theta(const Tangent& tangent, const std::vector<Frame<double>>& frames) const;

  std::vector<Tangent> tangents_;  // first those of the way, from end to end
  std::size_t ways_ = 0;           // how many
  double moved_ = 0;
  std::vector<int> pulleys_, in_, out_, side_;  // by pulley that can be left: its number, its tangents; by node: b
};

}  // namespace catena
