#include "catena/analysis/contact/several_states.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "catena/analysis/contact/contact_switch.hpp"
#include "catena/analysis/run/thresholds.hpp"

namespace catena {
namespace {

using State = ContactProblem::State;

// Three states each of five places: some milliseconds.
constexpr std::size_t most_states = 243;

/// Forces of given states, as the equations have them, and the accelerations that go with them.
class Trial {
 public:
  Trial(const ContactProblem& problem, const StatesOfFriction& states);

  bool fits() const;
  const std::vector<double>& forces() const { return p_.x; }
  /// Along place k: acceleration, and the sizes of the terms that it is a sum of.
  double along(std::size_t k) const { return w_[2 * k + 1].value; }
  double terms(std::size_t k) const { return w_[2 * k + 1].terms; }

 private:
  double limit(std::size_t k) const {
    return p_.place[k].has_normal ? p_.place[k].mu_static * p_.x[2 * k] : p_.place[k].limit;
  }

  ContactProblem p_;  // with these states
  std::vector<ContactProblem::Sum> w_;
};

Trial::Trial(const ContactProblem& problem, const StatesOfFriction& states) : p_(problem) {
  p_.state = states.state;
  p_.direction = states.direction;
  for (std::size_t k = 0; k < p_.place.size(); ++k) {
    const ContactProblem::Place& place = p_.place[k];
    const bool rubs = !place.has_normal && place.has_friction && p_.state[k] == State::slides;
    p_.x[2 * k] = 0;
    p_.x[2 * k + 1] = rubs ? -p_.direction[k] * place.kinetic : 0;
  }
  p_.solve_states();
  for (std::size_t row = 0; row < p_.x.size(); ++row) w_.push_back(p_.sum(row));
}

bool Trial::fits() const {
  const auto is_none = [](const ContactProblem::Sum& w) {
    return std::abs(w.value) <= ContactProblem::rounding_of_sums * w.terms;
  };
  for (std::size_t k = 0; k < p_.place.size(); ++k) {
    const ContactProblem::Place& place = p_.place[k];
    const ContactProblem::Sum &across = w_[2 * k], &along = w_[2 * k + 1];
    if (!std::isfinite(across.value + along.value)) return false;
    const bool open = p_.state[k] == State::open;
    if (place.has_normal && open && across.value < 0 && !is_none(across)) return false;
    if (place.has_normal && !open && (!is_none(across) || p_.x[2 * k] < 0)) return false;
    if (!place.has_friction || open) continue;
    if (p_.state[k] == State::sticks && (!is_none(along) || std::abs(p_.x[2 * k + 1]) > limit(k))) return false;
    if (p_.state[k] == State::slides && place.slip == 0 &&
        !(p_.direction[k] * along.value > thresholds::same_value * along.terms))
      return false;
  }
  return true;
}

/// Whether friction at rest is above that in motion where the place may do both.
bool may_do_both(const ContactProblem& problem, std::size_t k) {
  const ContactProblem::Place& place = problem.place[k];
  if (!place.has_friction || place.slip != 0 || problem.state[k] == State::open) return false;
  return place.has_normal ? place.mu_static > place.mu : place.limit > place.kinetic;
}

// Touching places at rest, whose states are tried.
struct AtRest {
  std::vector<std::size_t> places;
  std::size_t count = 1;  // of combinations
  int sticking = 0;       // as the problem has it
  bool judged = false;    // whether there is something to ask, and not too much
};

AtRest places_at_rest(const ContactProblem& problem) {
  AtRest rest;
  bool slides = false;
  for (std::size_t k = 0; k < problem.place.size(); ++k) {
    const ContactProblem::Place& place = problem.place[k];
    if (place.head >= 0) return rest;
    if (!place.has_friction || place.slip != 0 || problem.state[k] == State::open) continue;
    rest.places.push_back(k);
    rest.sticking += problem.state[k] == State::sticks;
    slides |= problem.state[k] == State::slides && may_do_both(problem, k);
    rest.count = std::min(3 * rest.count, most_states + 1);
  }
  rest.judged = slides && rest.count <= most_states;
  return rest;
}

// Combination `number`; how many places stick in it.
int take_states(const AtRest& rest, std::size_t number, StatesOfFriction& states) {
  int sticking = 0;
  for (const std::size_t k : rest.places) {
    const std::size_t choice = number % 3;
    number /= 3;
    states.state[k] = choice == 0 ? State::sticks : State::slides;
    states.direction[k] = choice == 0 ? 0 : choice == 1 ? 1 : -1;
    sticking += choice == 0;
  }
  return sticking;
}

}  // namespace

void stick_where_possible(ContactProblem& problem) {
  const AtRest rest = places_at_rest(problem);
  const auto is_joint = [](const ContactProblem::Place& place) { return !place.has_normal; };
  // What presses a joint follows from forces that were found with the states at hand.
  if (!rest.judged || std::any_of(problem.place.begin(), problem.place.end(), is_joint)) return;
  int most = rest.sticking;
  StatesOfFriction states{problem.state, problem.direction};
  for (std::size_t number = 0; number < rest.count; ++number) {
    const int sticking = take_states(rest, number, states);
    if (sticking <= most) continue;
    const Trial trial(problem, states);
    if (!trial.fits()) continue;
    most = sticking;
    problem.state = states.state;
    problem.direction = states.direction;
    problem.x = trial.forces();
  }
}

std::optional<StatesOfFriction> other_states(const ContactProblem& problem) {
  const AtRest rest = places_at_rest(problem);
  if (!rest.judged) return {};
  const StatesOfFriction taken{problem.state, problem.direction};
  const Trial found(problem, taken);
  StatesOfFriction other = taken;
  for (std::size_t number = 0; number < rest.count; ++number) {
    if (take_states(rest, number, other) < rest.sticking) continue;
    const Trial trial(problem, other);
    const auto differs = [&](std::size_t k) {
      return std::abs(trial.along(k) - found.along(k)) >
             thresholds::same_value * std::max(trial.terms(k), found.terms(k));
    };
    if (std::any_of(rest.places.begin(), rest.places.end(), differs) && trial.fits()) return other;
  }
  return {};
}

// "a" sticks, "b" slides forwards
std::string ContactSwitch::describe(const std::vector<ContactProblem::State>& states,
                                    const std::vector<int>& directions) const {
  std::string text;
  for (std::size_t a = 0; a < active_.size(); ++a) {
    if (!points_[active_[a]].has_friction() || states[a] == State::open) continue;
    const char* what = states[a] == State::sticks ? "sticks"
                       : directions[a] > 0        ? "slides forwards"
                                                  : "slides backwards";
    text +=
        fmt::format("{}\"{}\" {}", text.empty() ? "" : ", ", model_->element_name(points_[active_[a]].element), what);
  }
  return text;
}

void ContactSwitch::note_other_states(double t, const ContactProblem& problem) {
  if (const std::optional<StatesOfFriction> other = other_states(problem)) note_states(t, problem, *other);
}

void ContactSwitch::note_states(double t, const ContactProblem& taken, const StatesOfFriction& other) {
  if (several_states_.times++ > 0) return;
  several_states_.first = t;
  several_states_.states =
      fmt::format("{}; as well: {}", describe(taken.state, taken.direction), describe(other.state, other.direction));
}

// Joints at rest that slide although the friction which holds them presses them enough for it: found from the forces
// with which all of them stick.
void ContactSwitch::stick_where_pressed(double t, std::span<const double> qd, const ContactLoads& loads,
                                        ContactProblem& problem) {
  ContactProblem held = problem;
  bool any = false;
  for (std::size_t a = 0; a < held.place.size(); ++a) {
    ContactProblem::Place& place = held.place[a];
    if (place.has_normal || place.head >= 0 || place.slip != 0 || problem.state[a] != State::slides) continue;
    place.limit = std::numeric_limits<double>::infinity();
    any = true;
  }
  if (!any || !held.solve() || !press_joints(t, qd, loads, held).ok()) return;
  const auto sticking = [](const ContactProblem& p) {
    return std::count(p.state.begin(), p.state.end(), State::sticks);
  };
  if (sticking(held) <= sticking(problem)) return;
  note_states(t, held, {problem.state, problem.direction});
  problem = std::move(held);
}

}  // namespace catena
