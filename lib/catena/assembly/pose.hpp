// A pose: one configuration of a mechanism at one time, as its elements see it. A plain value: copied, compared by its
// members, moved between threads; whoever evaluates holds one.
//
//   frames                     of plan bodies, relative to their origins (plan.hpp); the last one is the ground's
//   functions                  of time: c, c', c'' of every function of the model
//   values, loads, load_rates  the same where constraints and force elements find them, one after the other
//   contacts                   where curves touch at these frames
//   stretches                  of elastic ropes at these frames
//
// Equations (equations.hpp) makes poses from a time and coordinates, and evaluates at them without changing
// anything. Units: m, rad, s.
#pragma once

#include <limits>
#include <span>
#include <vector>

#include "catena/base/frame.hpp"
#include "catena/base/taylor.hpp"
#include "catena/base/time_function.hpp"
#include "catena/elements/force_element.hpp"

namespace catena {

struct Pose {
  double time = 0;
  /// Functions of time are not evaluated before or after it: beyond its ends the pieces that hold there are continued.
  TimeRange run = {};
  std::vector<Taylor<double>> functions = {};
  std::vector<Taylor<double>> values = {};  ///< of types with functions of time: from ConstraintBlock::first_value on
  std::vector<double> loads = {};           ///< from ForceBlock::first_value on; zero where a law of state gives them
  std::vector<double> load_rates = {};      ///< their time derivatives
  std::vector<Frame<double>> frames = {};
  std::vector<CurvePlace> contacts = {};  ///< of all elements that search, type after type
  /// Where the searches for the next contacts begin: at those of this configuration, unless others are told.
  std::vector<CurvePlace> starts = {};
  std::vector<SharedStretch> stretches = {};  ///< of elastic ropes, as their block lists them
  std::vector<int> turns = {};                ///< whole turns taken out of the angles of moving bodies; empty: none
  /// Equations that do not hold for the time being, ascending, and the places of their entries in Phi_q.
  std::vector<int> left_out = {}, left_out_slots = {};
};

/// A pose in motion: what forces depend on. It refers to what it is made from.
struct MovingPose {
  const Pose& pose;
  const double* qd = nullptr;    ///< three rates a body in plan order, the ground's zeros last; nullptr: at rest
  const double* laws = nullptr;  ///< values of the laws of state by their numbers; nullptr: without what they give
};

}  // namespace catena
