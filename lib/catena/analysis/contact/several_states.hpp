// Whether other states of friction fit as well as those that were found, where friction at rest is above that in
// motion.
//
//   sticks: w_t = 0, |x_t| <= mu_static x_n      slides from rest: x_t = -mu s x_n, s w_t >= 0
//
// Of two blocks on each other, pulled from rest, the upper one may slide on the lower one, which friction on the floor
// then holds, or take it along: with mu_static > mu both meet all equations and limits, and nothing but what happened
// before decides. The same without such coefficients where friction itself presses a joint: a guide that is held may be
// pressed enough to hold, and one that slides too little (Painleve). What can be held is at rest (contact_problem.hpp),
// so that only states in which no fewer places stick are others. Looked at are touching places that were at rest, open
// ones stay open; up to `most_states` combinations, with the least forces where places share some. Dense algebra; only
// where a place at rest comes to slide.
#pragma once

#include <optional>
#include <vector>

#include "catena/analysis/contact/problem/contact_problem.hpp"

namespace catena {

struct StatesOfFriction {
  std::vector<ContactProblem::State> state;
  std::vector<int> direction;
};

/// Gives a solved problem the states, and forces, in which the most places stick; not where joints rub, which
/// ContactSwitch looks at with what presses them.
void stick_where_possible(ContactProblem& problem);
/// Other states of a solved problem in which no fewer places stick; nothing where there are none.
std::optional<StatesOfFriction> other_states(const ContactProblem& problem);

}  // namespace catena
