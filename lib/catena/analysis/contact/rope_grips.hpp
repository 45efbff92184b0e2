// Friction of ropes on pulleys that they slide over, in motion (capstan, Euler and Eytelwein).
//
//   T_out = T_in e^(-sigma E)      E = sum mu c      while it slides, sigma = sign of u'
//   e^-E <= T_out / T_in <= e^E                      while it sticks, u = const
//   u = L - (length of the rope behind the pulley, as if the pulley held it)
//   f = T_out - T_in acts along u
//
// Symbols: T_in, T_out tensions on the sides of the ends i and j, N; c >= 0 angle of contact, rad; mu coefficient; u:
// how far the rope has moved over the material of the pulley towards the end i, m. Of a rope without stiffness
// neighbouring pulleys that do not move relative to each other slip together: they are one grip; and those that do not
// move relative to an end cannot slip while it is taut: no grip stands for them, what they add does no work, and counts
// as nothing. Of an elastic rope each is a grip (elastic_grips.hpp). Source: Euler (1762), Eytelwein (1808).
#pragma once

#include <memory>
#include <vector>

#include "catena/assembly/evaluate.hpp"
#include "catena/model/rope_routes.hpp"

namespace catena {

/// The pulleys of one grip as a rope lies over them: E from the directions of its straight lines.
struct GripLines {
  struct Line {
    int i, j;  ///< bodies of the model
    RopeSpan<double> span;
    double factor;  ///< E is the sum of factors times directions
  };
  std::vector<Line> lines{};
  bool touches() const { return !lines.empty(); }
  /// E and its rate; below zero where a step reaches beyond the instant at which the rope leaves: no kink is in it.
  Taylor<double> exponent(const Evaluator& evaluator, std::span<const double> qd) const;
};

/// A grip of a route: its pulleys are the nodes `first` to `last`.
struct RopeGrip {
  int first = 0, last = 0;
  int slide = -1;  ///< the element of u, in the expanded model; -1: u is constant, all behind moves with the pulley
};

/// A rope with friction on pulleys.
struct GrippedRope {
  int route = -1;  ///< number among rope_routes()
  int element = -1;
  bool elastic = false;
  int whole = -1;  ///< of an elastic one, the element of u at its end i: what it lacks to being taut
  std::vector<RopeGrip> grips{};
};

/// Those of a model, and appends the equations of their grips to `expanded`, a copy of it, where there are any.
std::vector<GrippedRope> gripped_ropes(const Model& model, std::shared_ptr<Model>& expanded);

/// Writes the equations of a rope's grips as its route lies, and gives their lines by grip. Throws ModelError, as
/// lay().
std::vector<GripLines> lay_grips(Model& model, const GrippedRope& rope, const RopeRoute& route,
                                 const std::vector<Frame<double>>& frames);

/// What the springs of an elastic rope's parts between its grips yield, m/N: in a row the whole, each as long as its
/// part of the way, which ends in the middle of an arc.
std::vector<double> part_yields(const Model& model, const GrippedRope& rope, const RopeRoute& route,
                                const std::vector<Frame<double>>& frames);

/// Whether a rope of the model has friction on a pulley; the first one's element, else -1.
int first_gripped_rope(const Model& model);

}  // namespace catena
