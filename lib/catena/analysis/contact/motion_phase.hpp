// What happens where a motion goes on with other equations, as those see it that follow a motion with derivatives.
//
// A phase is a stretch of motion in which the same equations hold and every contact does one thing. Between two phases
// lies an instant at which velocities may jump, several times in a row where several events act:
//
//   M (qd+ - qd-) + Phi_q^T p = F + J^T x       F: a blow; x: impulses of the places that were hit
//   Phi_q qd+ = nu, then gaps  w+ = -e w-       of places that come back, w+ = 0 of those that stay
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "catena/analysis/contact/contact_points.hpp"
#include "catena/analysis/events/strike.hpp"

namespace catena {

/// A place that was hit, or had an impulse, in an impact.
struct ImpactPlace {
  std::size_t place = 0;  ///< number among the points of the contact model
  bool was_hit = false;   ///< its gap closed with a speed
  bool presses = false;   ///< it has an impulse
  bool rebounds = false;  ///< comes back with its restitution; else it stays
  bool sticks = false;    ///< friction stopped its slip
  int direction = 0;      ///< of the slip, where it has friction and slides
};

/// A sudden change of velocities.
struct VelocityJump {
  std::optional<Strike> strike{};  ///< that acts first
  int event = -1;                  ///< of the list, that struck
  bool meets_constraints = false;  ///< velocities are moved onto the constraints before anything is hit
  std::vector<int> released{};     ///< elements without equations then, contacts aside
  std::vector<ImpactPlace> places{};
  bool other_law = false;  ///< Poisson's restitution, or a reduced one, took the place of Newton's
  bool settles = false;    ///< what was left of a motion that rocks ever faster was taken away
};

/// What ends a phase of a place: a gap or a reaction, the force of a compliant place, a slide that comes to rest or
/// begins, places that hold each other no longer, an elastic rope that becomes slack or taut.
enum class PhaseEnd : unsigned char { contact, pressing, slide, shares, stretch };
struct WatchedPlace {
  std::size_t place = 0;
  PhaseEnd ends = PhaseEnd::contact;
};

/// A phase that begins, and how.
struct MotionPhase {
  double t = 0;
  int ended_by = -1;          ///< the transition of the phase before that led here, among its watched places; -1: none
  std::vector<int> events{};  ///< of the list, that acted
  bool functions_jump = false;  ///< functions of time did, or their rates
  std::vector<VelocityJump> jumps{};
  std::vector<int> released{};          ///< elements without equations in this phase, contacts included
  std::vector<ContactState> states{};   ///< of the places
  std::vector<WatchedPlace> watched{};  ///< what may end it, by number of the transition
};

class PhaseWitness {
 public:
  virtual ~PhaseWitness() = default;
  /// Called before the first stretch of the phase.
  virtual void begin(const MotionPhase& phase) = 0;
};

}  // namespace catena
