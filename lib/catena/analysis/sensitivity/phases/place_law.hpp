// What a place of contact presses and rubs with, as functions of its gap, its slip and multipliers of constraints.
//
//   compliant      N = k d^n + c d',  d = -g            lambda_gap = -N / (Psi' / g')
//   rigid, joint   N = -lambda_gap,  radius |(lambda_1, lambda_2)| or of a guide radius (|lambda_1| + |lambda_2| /
//   half) slides         lambda_slide = mu sigma N            sigma: sign of the slip, or tanh(w' / vs)
//
// Forward derivatives take these with derivatives along the parameters (phase_equations.hpp), adjoints by gap, slip and
// multipliers one by one. Psi' / g' = 1 - 2 g / range for a stop with two bounds, and a cable, else 1. Units: m or rad,
// N or N m. Source: contact_loads.hpp.
#pragma once

#include <span>

#include "catena/analysis/contact/motion_phase.hpp"
#include "catena/analysis/sensitivity/phases/design_places.hpp"

namespace catena {

/// What forces of a place follow from: its gap g, g', and its slip w'.
struct PlaceMotion {
  DesignScalar gap, gap_rate, slip;
};

struct PlaceLaw {
  const ContactPoint& point;
  const ContactState& state;
  const DesignPlace& place;
  int gap_row = -1, slide_row = -1;  ///< of the plan; -1: none
  int joint_row = -1;                ///< the first one of the joint whose reaction presses
  bool has_moment = false;           ///< the second one is a moment
  int master_row = -1;               ///< of the slide whose friction that of this place follows (same_slides.hpp)

  /// Whether exact friction sticks; whether friction acts that is not that of sticking.
  bool sticks() const {
    return point.has_friction() && point.is_exact() && state.closed && state.direction == 0 && !state.tied;
  }
  bool slides() const {
    if (!point.has_friction() || !state.closed) return false;
    return state.tied || (point.mu != 0 && (!point.is_exact() || state.direction != 0));
  }

  /// Which parts of its motion its forces follow from.
  bool asks_gap() const { return point.kind == ContactKind::compliant; }
  bool asks_slip() const { return slides() && !point.is_exact(); }
  bool asks_motion() const { return asks_gap() || asks_slip(); }

  DesignScalar compliant_force(const PlaceMotion& motion) const;
  /// The sizes of its terms together.
  double compliant_size(const PlaceMotion& motion) const;
  /// Psi' / g'.
  DesignScalar row_factor(const DesignScalar& gap) const;
  /// Its derivative by the gap.
  double row_bend() const { return place.has_range ? -2 / place.range.v : 0; }
  /// mu sigma; of a joint that others keep from slipping its part of N, or of what it follows, which stays.
  DesignScalar coefficient(const DesignScalar& slip) const;
  /// N; `lambda` by rows of the plan. The motion counts for compliant places alone.
  DesignScalar normal(const PlaceMotion& motion, std::span<const DesignScalar> lambda) const;
  /// What friction that does not stick is a part of: N, or the friction that it follows.
  DesignScalar pressing(const PlaceMotion& motion, std::span<const DesignScalar> lambda) const {
    return master_row < 0 ? normal(motion, lambda) : -lambda[static_cast<std::size_t>(master_row)];
  }
  /// What is zero where a phase of the place ends; see ContactPhases.
  DesignScalar end_value(const PlaceMotion& motion, std::span<const DesignScalar> lambda, PhaseEnd ends) const;
  /// Whether the place is beyond that end by more than rounding; `length` of the mechanism, `speed`: its fastest.
  bool has_passed(const PlaceMotion& motion, std::span<const DesignScalar> lambda, PhaseEnd ends, double length,
                  double speed) const;
  /// Whether the gap alone is zero there.
  bool ends_by_gap(const PlaceMotion& motion, PhaseEnd ends) const;
};

}  // namespace catena
