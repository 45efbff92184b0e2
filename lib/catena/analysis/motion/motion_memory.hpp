// The numbers from which a motion continues: everything that a new Dynamics object of the same model, also in another
// process on the same machine, needs to make the same steps and rows, bit for bit, as any other that starts from these
// numbers.
//
// It holds no history of an integrator. A run that can be resumed later drops its own history where it pauses and
// continues from these numbers as well: see Pauses in dynamics_with_events.hpp. Units: SI.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "catena/analysis/motion/impulses.hpp"
#include "catena/elements/element.hpp"
#include "catena/linalg/patterns/sparse_vectors.hpp"
#include "catena/model/rope_turns.hpp"

namespace catena {

/// Energies at an event, for a motion that goes on with other constraints. Units: J.
struct WorkSoFar {
  double supplied = 0, dissipated = 0;  ///< by loads and drivers; by damping
  double initial_energy = 0, energy = 0;
  std::vector<double> by_driver;  ///< by number of the element
  bool summed_up = false;         ///< whether it was
};

/// Quantities that an integrator has observed along the motion.
struct IntegratorMemory {
  double step = 0;                                                   ///< proposed for the next one, s
  double rate = 0, root_energy = 0, root_of_start = 0, radians = 0;  ///< see ErrorScale
  double usual_ratio = 1e-300;                                       ///< largest pivot ratio so far
};

/// Record of an event: `event` its place in the list, `row` the number of the row given at that instant, both from 0.
struct EventRecord {
  std::string name;
  int event = 0;
  double t = 0;
  std::int64_t row = 0;
};

/// State of the search for events.
struct EventMemory {
  std::vector<int> released;  ///< constraints that do not hold, by number of the element
  std::vector<int> turned;    ///< by element: turns by which a value was moved when it was engaged; empty: none
  std::vector<int> sides;     ///< by event: see EventWatch
  std::vector<double> largest;
  std::vector<EventRecord> records;
  std::vector<int> held{};  ///< what events of motions before have left held: SystemState::held
};

/// A rope met a pulley, or left it.
struct RopeEvent {
  int element = 0, met = 0;  ///< 1: it met one, 0: it left one
  double t = 0;
};

struct MotionMemory {
  double t = 0;
  std::vector<double> y;      ///< [q, qd, work] in the order of the plan, relative to its origins; see Motion
  std::vector<double> turns;  ///< by moving body: whole turns that its angle in y lacks
  double initial_energy = 0;
  double energy = 0;                     ///< what was in motion at most, J: see BalanceWatch
  double length = 0;                     ///< what errors of places are compared with, m: see Motion
  std::int64_t next_row = 0, steps = 0;  ///< of the grid; made so far, rejected ones included
  std::int64_t rows_given = 0;           ///< those at events included
  SparseVectors left_out;                ///< directions among the rows: see RedundantRows
  IntegratorMemory integrator;
  WorkSoFar earlier;  ///< what was summed up before the last event that acted
  EventMemory events;
  std::vector<Jolt> jolts;  ///< so far
  std::vector<RopeTurns> ropes{};
  std::vector<CurvePlace> curves{};      ///< where contacts on curves are
  std::vector<RopeEvent> rope_events{};  ///< so far
};

}  // namespace catena
