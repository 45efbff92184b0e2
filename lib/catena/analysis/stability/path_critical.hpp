// Critical points of a path of equilibria: where the matrix of equilibrium becomes singular.
//
//   [ K      Phi_q^T ] [ v  ]   [ 0 ]       limit point: <v, mu; derivative by p> != 0, the parameter turns back
//   [ Phi_q     0    ] [ mu ] = [ 0 ]       branch point: = 0, another path crosses
//
// Between two points whose matrices have different numbers of negative modes: bracketed by the inertia, the location
// by the secant rule for g(s) in  [ A  b ; b^T 0 ] [ u ; g ] = [ 0 ; 1 ],  b = W v, v an approximate null vector: g is
// smooth, and zero where A is singular. Beside forces without a potential: path_circulatory.cpp. Source: W. Govaerts,
// Numerical Methods for Bifurcations of Dynamical Equilibria, 2000, chapter 3.
#pragma once

#include <optional>
#include <vector>

#include "catena/analysis/stability/path_system.hpp"

namespace catena {

struct CriticalPoint {
  bool branch = false;   ///< else a limit point
  bool flutter = false;  ///< neither: two values meet and become a pair, or a pair ends
  double omega = 0;      ///< rad/s, at which they meet; 0 where that is below zero
  double s = 0;          ///< distance from the start of the step
  PathPoint point;
  std::vector<double> mode;  ///< null vector over columns, <v, v> = 1; its decisive_component is positive
  int modes = 1;             ///< how many became singular there
};

/// A step of the path from `start`, along its tangent t at the start, by `s`; points between are found at need.
struct PathStep {
  PathPoint start, tangent;
  double s = 0;
  PathStability modes_before{}, modes_after{};  ///< at both ends
};

/// The critical points in the step, in order. Points that cannot be separated count as one. `complete`: whether they
/// account for the change of the negative modes.
std::vector<CriticalPoint> find_critical_points(PathSystem& system, const PathStep& step, bool& complete);

/// The same beside forces without a potential (path_circulatory.cpp): divergence, limit or branch points, and flutter.
std::vector<CriticalPoint> find_circulatory_points(PathSystem& system, const PathStep& step, bool& complete);

/// Whether another path crosses at a critical point: certainly where the parameter continues in the same sense behind
/// it. Where it turns back, which also happens on the branches of a pitchfork, the component of the derivative by p
/// along the left null vector decides. `part_before`, `part_after`: the parameter's part of the path's direction.
bool crosses_another(PathSystem& system, const PathPoint& point, std::span<const double> left_vector,
                     double part_before, double part_after);

}  // namespace catena
