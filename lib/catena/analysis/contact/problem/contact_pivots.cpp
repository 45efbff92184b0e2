// States of a ContactProblem of many places by pivots (lemke.hpp), in units in which D has ones on its diagonal.
//
//   presses       x_n                  w_n >= 0
//   slides        x_n with x_t = -mu s x_n
//   may stick     x_n                  w_n >= 0
//                 x+, x-               l + w_t >= 0,  l - w_t >= 0             x_t = x+ - x-
//                 l                    m x_n - x+ - x- >= 0                    l is the size of the slip
//   known limit   x_t + limit          l + w_t >= 0
//                 l                    limit - x_t >= 0
//
// m is mu_static at first; places that slip then have mu, with which they may slide or stick, and all is looked for
// again, until no more slip with mu_static. The states at the end are those of what is zero: a gap that does not open
// is closed, a slide that is at rest sticks. The pivots' x is one share of forces; what rounding left of it is taken
// away by the least change.
#include <algorithm>
#include <cmath>
#include <span>

#include "catena/analysis/contact/problem/contact_problem.hpp"
#include "catena/linalg/pivoting/lemke.hpp"

namespace catena {
/// The linear problem of the given choices by place.
class ContactProblem::Pivots {
 public:
  /// A variable of the pivots: x that one unit of it makes, and the row that it is complementary to.
  struct Variable {
    enum class Kind : unsigned char { force, slip } kind = Kind::force;
    std::size_t place = 0;
    double across = 0, along = 0;  ///< of x, in its own units
    std::size_t row = 0;           ///< of w
    double sign = 1;               ///< of w in that row
  };

  Pivots(const ContactProblem& problem, const std::vector<Choice>& choices)
      : problem_(problem), choices_(choices), known_(problem.x.size(), 0.0) {
    for (std::size_t k = 0; k < problem.place.size(); ++k) {
      if (!choices[k].left_out) add(k);
    }
  }
  /// False: there is no solution, or none was found.
  bool solve(std::vector<double>& x) const;

 private:
  void add(std::size_t k);
  double entry(const Variable& row, const Variable& column) const;
  double constant(const Variable& row) const;
  double limit(std::size_t k) const {
    return choices_[k].slipped ? problem_.place[k].kinetic : problem_.place[k].limit;
  }
  double unit(const Variable& of) const { return of.kind == Variable::Kind::slip ? 1 : problem_.unit(of.row); }

  const ContactProblem& problem_;
  const std::vector<Choice>& choices_;
  std::vector<double> known_;
  std::vector<Variable> variables_;
};

void ContactProblem::Pivots::add(std::size_t k) {
  using Kind = Variable::Kind;
  const Place& p = problem_.place[k];
  const std::size_t n = 2 * k, t = n + 1;
  const int slip = choices_[k].slip;
  const bool rubs = p.has_friction && problem_.D(t, t) > 0;
  if (p.has_normal) {
    if (!(problem_.D(n, n) > 0)) return;
    const double along = p.has_friction ? -p.mu * slip : 0;
    variables_.push_back({Kind::force, k, 1, along, n, 1});
    if (!rubs || slip != 0) return;
    variables_.push_back({Kind::force, k, 0, 1, t, 1});
    variables_.push_back({Kind::force, k, 0, -1, t, -1});
    variables_.push_back({Kind::slip, k, 0, 0, t, 1});
  } else if (p.has_friction && slip != 0) {
    known_[t] = -slip * p.kinetic;
  } else if (rubs) {
    known_[t] = -limit(k);
    variables_.push_back({Kind::force, k, 0, 1, t, 1});
    variables_.push_back({Kind::slip, k, 0, 0, t, 1});
  }
}

// Units: of a force 1 / sqrt(D), of w its inverse, so that forces have rows of size one; slips are rates already.
double ContactProblem::Pivots::entry(const Variable& row, const Variable& column) const {
  using Kind = Variable::Kind;
  const bool same = row.place == column.place;
  const Place& p = problem_.place[row.place];
  if (row.kind == Kind::slip) {
    if (!same || column.kind == Kind::slip) return 0;
    const double mu = choices_[row.place].slipped ? p.mu : p.mu_static;
    const double of_limit = column.across * mu - std::abs(column.along);
    return of_limit * unit(column) / problem_.unit(row.row);
  }
  if (column.kind == Kind::slip) return same && row.row == column.row ? 1 : 0;
  const double w =
      problem_.D(row.row, 2 * column.place) * column.across + problem_.D(row.row, 2 * column.place + 1) * column.along;
  return row.sign * w * unit(row) * unit(column);
}

double ContactProblem::Pivots::constant(const Variable& row) const {
  if (row.kind == Variable::Kind::slip) {
    const Place& p = problem_.place[row.place];
    return p.has_normal ? 0 : 2 * limit(row.place) / problem_.unit(row.row);
  }
  double w = problem_.b[row.row];
  for (std::size_t c = 0; c < known_.size(); ++c) w += problem_.D(row.row, c) * known_[c];
  return row.sign * w * unit(row);
}

bool ContactProblem::Pivots::solve(std::vector<double>& x) const {
  const std::size_t size = variables_.size();
  std::vector<double> M(size * size), q(size), z(size);
  for (std::size_t r = 0; r < size; ++r) {
    q[r] = constant(variables_[r]);
    for (std::size_t c = 0; c < size; ++c) M[r * size + c] = entry(variables_[r], variables_[c]);
  }
  const bool found = lemke(M, q, z);
  x = known_;
  for (std::size_t c = 0; c < size; ++c) {
    const Variable& of = variables_[c];
    if (of.kind == Variable::Kind::slip) continue;
    x[2 * of.place] += of.across * unit(of) * z[c];
    x[2 * of.place + 1] += of.along * unit(of) * z[c];
  }
  return found;
}

// States that go with x, of places that are not left out.
void ContactProblem::read_states(const std::vector<Choice>& choices) {
  for (std::size_t k = 0; k < place.size(); ++k) {
    const Place& p = place[k];
    const std::size_t n = 2 * k, t = n + 1;
    state[k] = State::open;
    direction[k] = 0;
    if (choices[k].left_out || (p.has_normal && !(D(n, n) > 0))) continue;
    const Sum across = p.has_normal ? sum(n) : Sum{}, along = p.has_friction ? sum(t) : Sum{};
    if (across.value > rounding_of_sums * across.terms && !(x[n] > 0)) continue;
    if (!p.has_normal && !p.has_friction) continue;
    state[k] = State::slides;
    if (!p.has_friction) continue;
    direction[k] = choices[k].slip != 0 ? choices[k].slip : along.value > 0 ? 1 : -1;
    if (choices[k].slip != 0 || std::abs(along.value) > rounding_of_sums * along.terms) continue;
    state[k] = State::sticks;
    direction[k] = 0;
  }
}

// What rounding left of the rates that the states ask to be zero.
void ContactProblem::refine() {
  std::vector<Unknown> unknowns;
  std::vector<double> known(x.size(), 0.0);
  for (std::size_t k = 0; k < place.size(); ++k) {
    const std::size_t n = 2 * k, t = n + 1;
    if (state[k] == State::open) continue;
    known[n] = x[n];
    known[t] = x[t];
    if (place[k].has_normal) {
      unknowns.push_back({n, {{n, 1.0}}});
      if (place[k].has_friction && state[k] == State::slides) {
        unknowns.back().parts.emplace_back(t, -place[k].mu * direction[k]);
        known[t] = -place[k].mu * direction[k] * x[n];
      }
    } else if (state[k] == State::slides) {
      known[t] = -place[k].kinetic * direction[k];
    }
    if (state[k] == State::sticks) unknowns.push_back({t, {{t, 1.0}}});
  }
  solve_unknowns(unknowns, known);
}

// False: there is no solution, or none was found.
bool ContactProblem::pivot(std::vector<Choice> choices) {
  for (bool more = true; more;) {
    if (!Pivots(*this, choices).solve(x)) return false;
    read_states(choices);
    more = false;
    for (std::size_t k = 0; k < place.size(); ++k) {
      const Place& p = place[k];
      const bool falls = p.has_normal ? p.mu != p.mu_static : p.kinetic != p.limit;
      if (state[k] != State::slides || !p.has_friction || !falls || choices[k].slip != 0 || choices[k].slipped)
        continue;
      choices[k].slipped = more = true;
    }
  }
  const auto is_good = [this] { return fits(size()) && keeps_states(); };
  const std::vector<double> pivoted = x;
  // The least of all shares where that is one, else the pivots' own.
  solve_states();
  const bool least = is_good();
  if (!least) {
    x = pivoted;
    refine();
    if (!is_good()) return false;
  }
  // Closed places that nothing presses in the least of all shares, as between boxes that fall together, are open: their
  // force would be rounding, and end at once. In other shares those that slide are: in motion they would get a share,
  // and friction with it.
  const std::vector<State> states = state;
  const std::vector<int> directions = direction;
  const std::vector<double> forces = x;
  for (std::size_t k = 0; k < place.size(); ++k) {
    const bool rubs = place[k].has_friction && states[k] == State::slides;
    const bool presses = size_of(2 * k, forces[2 * k]) > rounding_of_sums * size();
    if (states[k] == State::open || !place[k].has_normal || presses || !(least || rubs)) continue;
    state[k] = State::open;
    direction[k] = 0;
    x[2 * k] = x[2 * k + 1] = 0;
  }
  if (state == states) return true;
  refine();
  if (is_good()) return true;
  state = states;
  direction = directions;
  x = forces;
  return true;
}

bool ContactProblem::is_ruled_out() const { return state == ruled_out_state_ && direction == ruled_out_direction_; }

// All places at once; first with what is preferred to what was ruled out, together and one by one.
bool ContactProblem::pivot() {
  std::vector<Choice> given(place.size());
  for (std::size_t k = 0; k < place.size(); ++k) {
    given[k].slip = place[k].slip;
    const double rate = b[2 * k + 1];  // of what is carried altogether
    if (place[k].slip == 0 && place[k].has_friction && is_carried(k, rate)) given[k].slip = rate > 0 ? 1 : -1;
  }
  std::vector<std::size_t> give_way;
  for (std::size_t k = 0; k < preferred_state_.size() && !ruled_out_state_.empty(); ++k) {
    if (preferred_state_[k] != ruled_out_state_[k] || preferred_direction_[k] != ruled_out_direction_[k])
      give_way.push_back(k);
  }
  const auto try_giving_way = [&](std::span<const std::size_t> which) {
    std::vector<Choice> choices = given;
    for (const std::size_t k : which)
      choices[k] = {.slip = preferred_direction_[k], .left_out = preferred_state_[k] == State::open};
    return pivot(std::move(choices)) && !is_ruled_out();
  };
  if (!give_way.empty() && try_giving_way(give_way)) return true;
  for (std::size_t n = 0; n < give_way.size() && give_way.size() > 1; ++n) {
    if (try_giving_way(std::span(give_way).subspan(n, 1))) return true;
  }
  return pivot(given) && !is_ruled_out();
}

}  // namespace catena
