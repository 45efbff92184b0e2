#include "catena/analysis/contact/several_states.hpp"

#include <fmt/format.h>

#include <Eigen/QR>
#include <algorithm>
#include <cmath>

#include "catena/analysis/contact/contact_switch.hpp"

namespace catena {
namespace {

using State = ContactProblem::State;

// Three states each of five places: some milliseconds.
constexpr std::size_t most_states = 243;
// Of the terms of a sum: below it a difference is rounding; motions that differ by less are the same.
constexpr double rounding_of_sums = 1e-9, same_motion = 1e-6;

/// Forces of given states, as the equations have them, and the accelerations that go with them.
class Trial {
 public:
  Trial(const ContactProblem& problem, const StatesOfFriction& states) : p_(problem), s_(states) { solve(); }

  bool fits() const;
  const std::vector<double>& forces() const { return x_; }
  /// Along place k: acceleration, and the sizes of the terms that it is a sum of.
  double along(std::size_t k) const { return w_[2 * k + 1]; }
  double terms(std::size_t k) const { return terms_[2 * k + 1]; }

 private:
  void solve();
  double limit(std::size_t k) const {
    return p_.place[k].has_normal ? p_.place[k].mu_static * x_[2 * k] : p_.place[k].limit;
  }

  const ContactProblem& p_;
  const StatesOfFriction& s_;
  std::vector<double> x_, w_, terms_;
};

void Trial::solve() {
  const std::size_t n = p_.b.size();
  Eigen::VectorXd known = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(n));
  std::vector<std::pair<std::size_t, double>> unknown;  // row, and the friction that one unit makes
  for (std::size_t k = 0; k < p_.place.size(); ++k) {
    const ContactProblem::Place& place = p_.place[k];
    if (s_.state[k] == State::open) continue;
    const bool slides = place.has_friction && s_.state[k] == State::slides;
    if (place.has_normal) unknown.emplace_back(2 * k, slides ? -place.mu * s_.direction[k] : 0);
    if (s_.state[k] == State::sticks) unknown.emplace_back(2 * k + 1, 0);
    if (slides && !place.has_normal) known[static_cast<Eigen::Index>(2 * k + 1)] = -s_.direction[k] * place.kinetic;
  }
  const auto size = static_cast<Eigen::Index>(unknown.size());
  Eigen::MatrixXd matrix(size, size);
  Eigen::VectorXd right(size);
  for (Eigen::Index r = 0; r < size; ++r) {
    const std::size_t row = unknown[static_cast<std::size_t>(r)].first;
    right(r) = -p_.b[row];
    for (std::size_t c = 0; c < n; ++c) right(r) -= p_.D(row, c) * known[static_cast<Eigen::Index>(c)];
    for (Eigen::Index c = 0; c < size; ++c) {
      const auto& [column, friction] = unknown[static_cast<std::size_t>(c)];
      matrix(r, c) = p_.D(row, column) + (friction != 0 ? friction * p_.D(row, column + 1) : 0);
    }
  }
  x_.assign(known.begin(), known.end());
  if (size > 0) {
    const Eigen::VectorXd forces = matrix.completeOrthogonalDecomposition().solve(right);
    for (Eigen::Index c = 0; c < size; ++c) {
      const auto& [column, friction] = unknown[static_cast<std::size_t>(c)];
      x_[column] += forces(c);
      if (friction != 0) x_[column + 1] += friction * forces(c);
    }
  }
  w_ = p_.b;
  terms_.assign(n, 0.0);
  for (std::size_t r = 0; r < n; ++r) {
    terms_[r] = std::max(std::abs(p_.b[r]), p_.b_terms[r]);
    for (std::size_t c = 0; c < n; ++c) {
      w_[r] += p_.D(r, c) * x_[c];
      terms_[r] += std::abs(p_.D(r, c) * x_[c]);
    }
  }
}

bool Trial::fits() const {
  for (std::size_t k = 0; k < p_.place.size(); ++k) {
    const ContactProblem::Place& place = p_.place[k];
    const std::size_t n = 2 * k, t = n + 1;
    if (!std::isfinite(w_[n] + w_[t])) return false;
    if (place.has_normal) {
      const bool open = s_.state[k] == State::open;
      if (open ? w_[n] < -rounding_of_sums * terms_[n] : std::abs(w_[n]) > rounding_of_sums * terms_[n] || x_[n] < 0)
        return false;
    }
    if (!place.has_friction || s_.state[k] == State::open) continue;
    if (s_.state[k] == State::sticks && (std::abs(w_[t]) > rounding_of_sums * terms_[t] || std::abs(x_[t]) > limit(k)))
      return false;
    if (s_.state[k] == State::slides && place.slip == 0 && !(s_.direction[k] * w_[t] > same_motion * terms_[t]))
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
      return std::abs(trial.along(k) - found.along(k)) > same_motion * std::max(trial.terms(k), found.terms(k));
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
  const std::optional<StatesOfFriction> other = other_states(problem);
  if (!other || several_states_.times++ > 0) return;
  several_states_.first = t;
  several_states_.states = fmt::format("{}; as well: {}", describe(problem.state, problem.direction),
                                       describe(other->state, other->direction));
}

}  // namespace catena
