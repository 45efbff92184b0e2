// Parts of a step in which what contacts press with is smooth, for derivatives that follow from its stages.
//
//   N = k d^n       N_p = k n d^(n-1) d_p        N ~ s^n, N_p ~ s^(n-1) at a time s from where the place touches
//
// Where n is no whole number the derivatives of N in time grow beyond bounds at touch-down and lift-off. A step of the
// motion is as short as N itself asks for; N_p is rougher by one order, and at a fixed instant, as rows and integrals
// are, it is so however the instant of touching moves. A step is therefore halved until no depth is more than twice
// another within a part: there d^(n-1) is a series that converges like 1 / 5.8^j (the ellipse about [1, 2] that ends
// at 0), of which stages of order 8 leave some 1e-8. The parts next to d = 0 are halved until they leave 1e-9 of what
// the step makes of d_p, (1/2)^(n halvings). All of it is multiplied by what N is of the motion in one step.
//
// Units: s, m or rad. Source: for graded steps at singular ends, H. Brunner, Collocation Methods for Volterra Integral
// and Related Functional Differential Equations (2004), chapter 6.
#pragma once

#include <vector>

#include "catena/analysis/contact/contact_points.hpp"
#include "catena/analysis/run/row_observer.hpp"
#include "catena/analysis/sensitivity/phases/design_places.hpp"

namespace catena {

/// A place that presses with a power of its depth that is no whole number.
struct PowerPlace {
  int element = -1;
  double exponent = 1;
};

/// Those of a phase. `places`: by group of parameters.
std::vector<PowerPlace> power_places(const ContactModel& contacts, const std::vector<ContactState>& states,
                                     const std::vector<std::vector<DesignPlace>>& places);

/// The ends of the parts in order, the last one that of the stretch; nothing where it cannot be looked at.
std::vector<double> smooth_parts(const MotionStretch& stretch, const std::vector<PowerPlace>& places);

}  // namespace catena
