// Random mechanisms with more equations than they need, whose motion is known by few coordinates (known_motion.hpp).
//
// Every kind comes in random sizes (1e-2 ... 1e2 m), masses and directions of gravity, with springs and dampers or
// without, turned and shifted in the plane. Bodies have centroids off their pins. Most kinds can pass flat positions,
// in which further equations become dependent; redundant_trials.hpp gives them a speed with which they pass. The kinds
// themselves stand in files of their own.
#pragma once

#include "oracles/redundant_cranks.hpp"
#include "oracles/redundant_lift.hpp"
#include "oracles/redundant_links.hpp"
#include "oracles/redundant_planetary.hpp"
#include "oracles/redundant_trusses.hpp"

namespace catena::testing {

struct MechanismKind {
  const char* name;
  void (*make)(RandomMechanism&);
};

inline constexpr MechanismKind redundant_kinds[] = {
    {"bar on cranks", bar_on_cranks},
    {"bar on couplers", bar_on_couplers},
    {"truss that swings", swinging_truss},
    {"truss in flight", flying_truss},
    {"welded pairs", welded_pairs},
    {"doubled joints", doubled_joints},
    {"doubled coupler", doubled_coupler},
    {"block on two guides", block_on_guides},
    {"planetary, 1 dof", [](RandomMechanism& m) { planetary(m, false); }},
    {"planetary, 2 dof", [](RandomMechanism& m) { planetary(m, true); }},
    {"scissor lift", scissor_lift}};
inline constexpr int number_of_kinds = static_cast<int>(std::size(redundant_kinds));

inline KnownMotion redundant_motion(int kind, unsigned seed) {
  RandomMechanism m(seed * 131u + static_cast<unsigned>(kind));
  m.size = std::pow(10.0, m.uniform(-2, 2));
  m.mass = std::pow(10.0, m.uniform(-2, 2));
  m.axis = m.pick(3) == 0 ? m.uniform(-3, 3) : 0;
  m.motion.kind = redundant_kinds[kind].name;
  m.motion.length = m.size;
  m.motion.pace = std::sqrt(9.81 / m.size);
  m.weightless = m.pick(6) == 0;
  if (!m.weightless) m.motion.model->gravity = rotated({0, -9.81}, m.axis);
  m.motion.until = m.uniform(1, 8) / m.motion.pace;
  redundant_kinds[kind].make(m);
  return m.motion;
}

}  // namespace catena::testing
