#include "catena/assembly/systems/schur_system.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <random>

#include "catena/assembly/systems/light_turns.hpp"
#include "catena/assembly/systems/row_spread.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

constexpr double schur_regularisation = 1e-12;  // part of the diagonal that is added
constexpr double singular_ratio = 1e-10;        // below this pivot ratio it is ...
constexpr double clearly_more = 10;             // ... until the ratio is so many times this, and without it as well ...
constexpr double rounding_of_pivots = 1e-14;    // ... not below this part of the largest diagonal of a row like it
// Rounds in which a residual that shrinks to a half, at least, comes to rounding.
constexpr int most_massless_rounds = 52;
constexpr double massless_rounding = 1e-15;
constexpr int most_probes = 4;  // random loads: a coordinate that resists all of them is rare, and only costs rounds
constexpr double unequal_masses = 1e5;  // largest to least; from here on light bodies cost digits

// Bodies that are so light to turn (light_turns.hpp) cost digits, and below this pivot ratio their solutions are
// refined with the true equations: where J = 1e-6 ... 1e-3 m a^2, steps of bars on couplers at a tolerance of 1e-12
// stalled from ratios of 3e-4 on, and nowhere since.
constexpr double light_turn = 100, light_ratio = 1e-2;

/// For what remains of solutions that are refined, and for their changes; without it none is.
void make_room(std::size_t coordinates, std::size_t rows, std::initializer_list<std::vector<double>*> of_coordinates,
               std::initializer_list<std::vector<double>*> of_rows) {
  for (std::vector<double>* all : of_coordinates) all->resize(coordinates);
  for (std::vector<double>* all : of_rows) all->resize(rows);
}

bool refines(const std::vector<double>& room, bool always, double pivot_ratio) {
  return !room.empty() && (always || pivot_ratio < light_ratio);
}

}  // namespace

SchurSystem::SchurSystem(std::shared_ptr<const Plan> plan) : plan_(std::move(plan)) {
  const SparsePattern& a = plan_->jacobian;
  const std::size_t coordinates = at(3 * plan_->moving);
  masses_.inverse.assign(coordinates, 1.0);
  scratch_.change.resize(coordinates);
  scratch_.right_hand_side.resize(at(plan_->rows));
  scratch_.correction.resize(at(plan_->rows));
  column_start_.assign(coordinates + 1, 0);
  for (std::size_t k = 0, c = 0; k < coordinates; ++k) {
    if (plan_->column[k] >= 0) c = at(plan_->column[k]) + 1;
    column_start_[k + 1] = a.column_start[c];
  }
}

void SchurSystem::set_masses(std::span<const double> masses, std::span<const double> substitutes) {
  masses_.given.assign(masses.begin(), masses.end());
  masses_.massless.clear();
  double least[2] = {}, largest[2] = {};  // of masses, of moments of inertia
  for (std::size_t c = 0; c < masses.size(); ++c) {
    const std::size_t kind = c % 3 == 2 ? 1 : 0;
    largest[kind] = std::max(largest[kind], masses[c]);
    if (masses[c] > 0 && (least[kind] == 0 || masses[c] < least[kind])) least[kind] = masses[c];
    const double mass = masses[c] > 0 ? masses[c] : substitutes[c];
    masses_.inverse[c] = mass > 0 ? 1 / mass : 0;
    if (!(masses[c] > 0) && mass > 0) masses_.massless.push_back(static_cast<int>(c));
  }
  regularised_ = false;
  unequal_ = largest[0] > unequal_masses * least[0] || largest[1] > unequal_masses * least[1];
  rest_.Q.clear();
  if (!masses_.massless.empty() || unequal_)
    make_room(masses.size(), at(plan_->rows), {&rest_.Q, &rest_.qdd}, {&rest_.gamma, &rest_.lambda});
  constants_known_ = false;
}

void SchurSystem::leave_out(SparseVectors directions) {
  // Until the next factorization the diagonal is that of S + C, too.
  const auto add_squares = [&](double sign) {
    for (std::size_t n = 0; n < left_out_.index.size() && analyzed_; ++n) {
      diagonal_values_[at(left_out_.index[n])] += sign * left_out_.value[n] * left_out_.value[n];
    }
  };
  add_squares(-1);
  left_out_ = std::move(directions);
  add_squares(1);
  regularised_ = false;
  place_left_out();
}

template <class V>
void SchurSystem::add_left_out(std::span<const V> lambda, std::span<V> out) const {
  for (int k = 0; k < left_out_.count(); ++k) {
    const std::span<const int> rows = left_out_.indices(k);
    const std::span<const double> c = left_out_.values(k);
    V sum{};
    for (std::size_t a = 0; a < c.size(); ++a) sum += c[a] * lambda[at(rows[a])];
    for (std::size_t a = 0; a < c.size(); ++a) out[at(rows[a])] += c[a] * sum;
  }
}

void SchurSystem::solve_rows(std::span<double> x, Counters& counters) {
  std::copy(x.begin(), x.end(), scratch_.right_hand_side.begin());
  solve_refined<double>(x, scratch_.right_hand_side, scratch_, counters);
}

std::vector<double> SchurSystem::row_sizes() const {
  std::vector<double> sizes = diagonal_values_;
  for (std::size_t n = 0; n < left_out_.index.size(); ++n) {
    sizes[at(left_out_.index[n])] -= left_out_.value[n] * left_out_.value[n];
  }
  for (double& size : sizes) size = std::sqrt(std::max(size, 0.0));
  return sizes;
}

void SchurSystem::assemble(std::span<const Column> columns, const int* slot, std::span<double> values) const {
  const double* jacobian = jacobian_.data();
  for (const Column& column : columns) {
    const double inverse_mass = masses_.inverse[at(column.coordinate)];
    for (int x = column.first; x < column.last; ++x) {
      const double factor = inverse_mass * jacobian[x];
      for (int y = column.first; y <= x; ++y) values[at(*slot++)] += factor * jacobian[y];
    }
  }
}

void SchurSystem::fill(double regularised_part) {
  const std::span<double> values = factors_.values();
  std::copy(constant_values_.begin(), constant_values_.end(), values.begin());
  assemble(places_.varying, places_.varying_slot.data(), values);
  const int* slot = left_out_slot_.data();
  for (int k = 0; k < left_out_.count(); ++k) {
    const std::span<const double> c = left_out_.values(k);
    for (std::size_t a = 0; a < c.size(); ++a) {
      for (std::size_t b = 0; b <= a; ++b) values[at(*slot++)] += c[a] * c[b];
    }
  }
  for (std::size_t k = 0; k < places_.diagonal.size(); ++k) {
    double& value = values[at(places_.diagonal[k])];
    // An equation between bodies that cannot move must not stop the others.
    if (value == 0) value = 1;
    diagonal_values_[k] = value;
    value *= 1 + regularised_part;
  }
}

bool SchurSystem::factor_values(Counters& counters) {
  const FactorResult result = factors_.factorize(counters);
  smallest_ratio_ = 1;
  weakest_row_ = -1;
  if (!result.ok()) {
    smallest_ratio_ = 0;
    weakest_row_ = result.index;
    return result.status == FactorStatus::singular;
  }
  const std::span<const double> pivot = factors_.pivots();
  const std::span<const int> order = factors_.order();
  std::size_t weakest = 0;
  double smallest = 2;
  for (std::size_t k = 0; k < pivot.size(); ++k) {
    const double ratio = pivot[k] / diagonal_values_[at(order[k])];
    if (ratio < smallest) {
      smallest = ratio;
      weakest = k;
    }
  }
  smallest_ratio_ = std::max(smallest, 0.0);
  weakest_row_ = order[weakest];
  return true;
}

bool SchurSystem::factorize(std::span<const double> jacobian, Counters& counters) {
  jacobian_ = jacobian;
  if (plan_->rows == 0) return true;
  if (!analyzed_ && !analyze(counters)) return false;
  if (!constants_known_) {
    std::fill(constant_values_.begin(), constant_values_.end(), 0.0);
    assemble(places_.constant, places_.constant_slot.data(), constant_values_);
    constants_known_ = true;
    if (rest_.Q.empty() && largest_turn(*plan_, masses_.given, jacobian) > light_turn)
      make_room(masses_.given.size(), at(plan_->rows), {&rest_.Q, &rest_.qdd}, {&rest_.gamma, &rest_.lambda});
  }
  // Equations that depended on each other at the last factorization probably still do.
  const bool before = regularised_;
  fill(before ? schur_regularisation : 0);
  if (!factor_values(counters)) return false;
  if (before && !(smallest_ratio_ < clearly_more * singular_ratio)) {
    // What is added to a large diagonal shows in the pivots of small ones: whether the equations are regular is seen
    // without it, as far as rounding of the large ones allows.
    fill(0);
    if (!factor_values(counters)) return false;
    const double spread = row_spread(diagonal_values_, plan_->row_is_angle);
    regularised_ = smallest_ratio_ < std::max(singular_ratio, rounding_of_pivots * spread);
    if (regularised_) {
      fill(schur_regularisation);
      if (!factor_values(counters)) return false;
    }
  }
  if (smallest_ratio_ < singular_ratio && !regularised_) {
    fill(schur_regularisation);
    regularised_ = true;
    if (!factor_values(counters) || !(smallest_ratio_ > 0)) return false;
  }
  if (regularised_) smallest_ratio_ = std::min(smallest_ratio_, singular_ratio);
  return true;
}

template <class V>
void SchurSystem::add_product(std::span<const V> x, std::span<V> out) const {
  const double* jacobian = jacobian_.data();
  const int* row = plan_->jacobian.row_index.data();
  for (std::size_t c = 0; c + 1 < column_start_.size(); ++c) {
    const V factor = x[c];
    for (int k = column_start_[c]; k < column_start_[c + 1]; ++k) out[at(row[k])] += jacobian[k] * factor;
  }
}

void SchurSystem::multiply_add(std::span<const double> x, std::span<double> out) const { add_product(x, out); }

template <class V>
void SchurSystem::spread(std::span<const V> lambda, std::span<V> x) const {
  const double* jacobian = jacobian_.data();
  const int* row = plan_->jacobian.row_index.data();
  for (std::size_t c = 0; c + 1 < column_start_.size(); ++c) {
    V sum{};
    for (int k = column_start_[c]; k < column_start_[c + 1]; ++k) sum += jacobian[k] * lambda[at(row[k])];
    x[c] = masses_.inverse[c] * sum;
  }
}

template <class V, class S>
void SchurSystem::solve_refined(std::span<V> lambda, std::span<const V> b, S& scratch, Counters& counters) {
  eliminate(lambda, scratch, counters);
  if (smallest_ratio_ >= refinement_ratio) return;
  const std::span<V> change = scratch.change, correction = scratch.correction;
  spread<V>(lambda, change);
  std::fill(correction.begin(), correction.end(), V{});
  add_product<V>(change, correction);
  add_left_out<V>(lambda, correction);
  for (std::size_t k = 0; k < correction.size(); ++k) correction[k] = b[k] - correction[k];
  eliminate(correction, scratch, counters);
  for (std::size_t k = 0; k < correction.size(); ++k) lambda[k] += correction[k];
}

void SchurSystem::solve_motion(std::span<const double> Q, std::span<const double> gamma, std::span<double> qdd,
                               std::span<double> lambda, Counters& counters) {
  solve_with_masses(Q, gamma, qdd, lambda, scratch_, counters);
  if (refines(rest_.Q, !masses_.massless.empty() || unequal_, smallest_ratio_))
    refine_motion(Q, gamma, qdd, lambda, counters);
}

void SchurSystem::solve_motion(std::span<const Lanes> Q, std::span<const Lanes> gamma, std::span<Lanes> qdd,
                               std::span<Lanes> lambda, SchurLanes& scratch, Counters& counters) {
  if (!refines(rest_.Q, !masses_.massless.empty() || unequal_, smallest_ratio_)) {
    scratch.right_hand_side.resize(scratch_.right_hand_side.size());
    scratch.correction.resize(scratch_.correction.size());
    scratch.change.resize(scratch_.change.size());
    return solve_with_masses(Q, gamma, qdd, lambda, scratch, counters);
  }
  // How often a solution is refined depends on it: one after the other.
  scratch.own_Q.resize(Q.size());
  scratch.own_gamma.resize(gamma.size());
  scratch.own_qdd.resize(qdd.size());
  scratch.own_lambda.resize(lambda.size());
  const auto take = [](std::span<const Lanes> all, int lane, std::vector<double>& own) {
    for (std::size_t k = 0; k < own.size(); ++k) own[k] = all[k][lane];
  };
  const auto give = [](const std::vector<double>& own, int lane, std::span<Lanes> all) {
    for (std::size_t k = 0; k < own.size(); ++k) all[k].set(lane, own[k]);
  };
  for (int lane = 0; lane < Lanes::count; ++lane) {
    take(Q, lane, scratch.own_Q);
    take(gamma, lane, scratch.own_gamma);
    solve_motion(scratch.own_Q, scratch.own_gamma, scratch.own_qdd, scratch.own_lambda, counters);
    give(scratch.own_qdd, lane, qdd);
    give(scratch.own_lambda, lane, lambda);
  }
}

template <class V, class S>
void SchurSystem::solve_with_masses(std::span<const V> Q, std::span<const V> gamma, std::span<V> qdd,
                                    std::span<V> lambda, S& scratch, Counters& counters) {
  const std::size_t coordinates = masses_.inverse.size();
  for (std::size_t c = 0; c < coordinates; ++c) qdd[c] = masses_.inverse[c] * Q[c];
  if (plan_->rows == 0) return;
  const std::span<V> right_hand_side = scratch.right_hand_side;
  for (std::size_t k = 0; k < right_hand_side.size(); ++k) right_hand_side[k] = -gamma[k];
  add_product<V>(qdd, right_hand_side);
  std::copy(right_hand_side.begin(), right_hand_side.end(), lambda.begin());
  solve_refined<V>(lambda, right_hand_side, scratch, counters);
  const double* jacobian = jacobian_.data();
  const int* row = plan_->jacobian.row_index.data();
  for (std::size_t c = 0; c < coordinates; ++c) {
    V sum{};
    for (int k = column_start_[c]; k < column_start_[c + 1]; ++k) sum += jacobian[k] * lambda[at(row[k])];
    qdd[c] -= masses_.inverse[c] * sum;
  }
}

// The unbalanced force at massless coordinates, rest_.Q, compared with the largest force of all: those of
// inertia too, of the small masses as well (accelerations are -rest_.qdd), since nothing else may act in a
// motion without loads.
double SchurSystem::find_massless_residual(std::span<const double> Q, std::span<const double> lambda) {
  double largest = 0, left = 0;
  for (std::size_t c = 0; c < rest_.Q.size(); ++c) {
    double sum = std::abs(Q[c]);
    if (masses_.inverse[c] > 0) sum += std::abs(rest_.qdd[c]) / masses_.inverse[c];
    for (int k = column_start_[c]; k < column_start_[c + 1]; ++k) {
      sum += std::abs(jacobian_[at(k)] * lambda[at(plan_->jacobian.row_index[at(k)])]);
    }
    largest = std::max(largest, sum * std::sqrt(masses_.inverse[c]));
  }
  for (int c : masses_.massless) {
    const double part = std::abs(rest_.Q[at(c)]) * std::sqrt(masses_.inverse[at(c)]);
    if (part > left) {
      left = part;
      worst_massless_ = c;
    }
  }
  return left > 0 ? left / largest : 0;
}

// Adds the solution for the residual of the true equations: Q - M qdd - Phi_q^T lambda and gamma - Phi_q qdd. One round
// where masses are only unequal; with massless coordinates until nothing is gained any more, and one at least: where no
// force acts on them they are in balance at once, but the small masses have cost the accelerations their digits.
void SchurSystem::refine_motion(std::span<const double> Q, std::span<const double> gamma, std::span<double> qdd,
                                std::span<double> lambda, Counters& counters) {
  double first_change = 0;
  massless_residual_ = 0;
  for (int round = 0;; ++round) {
    for (std::size_t c = 0; c < rest_.Q.size(); ++c) {
      double rest = 0;
      if (masses_.inverse[c] > 0) {
        rest = Q[c] - masses_.given[c] * qdd[c];
        for (int k = column_start_[c]; k < column_start_[c + 1]; ++k) {
          rest -= jacobian_[at(k)] * lambda[at(plan_->jacobian.row_index[at(k)])];
        }
      }
      rest_.Q[c] = rest;
    }
    for (std::size_t c = 0; c < rest_.Q.size(); ++c) rest_.qdd[c] = -qdd[c];
    if (!masses_.massless.empty()) {
      const double before = massless_residual_;
      massless_residual_ = find_massless_residual(Q, lambda);
      const bool shrinks = round == 0 || massless_residual_ < 0.5 * before;
      const bool done = !(massless_residual_ > massless_rounding) || !shrinks || round == most_massless_rounds;
      if (done && round > 0) return;
    }
    std::copy(gamma.begin(), gamma.end(), rest_.gamma.begin());
    multiply_add(rest_.qdd, rest_.gamma);
    add_left_out<double>(lambda, rest_.gamma);
    solve_with_masses<double>(rest_.Q, rest_.gamma, rest_.qdd, rest_.lambda, scratch_, counters);
    double change = 0, whole = 0;
    for (std::size_t c = 0; c < rest_.Q.size(); ++c) {
      change = std::max(change, std::abs(rest_.qdd[c]));
      whole = std::max(whole, std::abs(qdd[c]));
      qdd[c] += rest_.qdd[c];
    }
    for (std::size_t k = 0; k < rest_.lambda.size(); ++k) lambda[k] += rest_.lambda[k];
    if (round == 0) first_change = change;
    // Every round reduces its change by the same factor.
    if (masses_.massless.empty() && (round > 2 || !(change * first_change > 1e-15 * whole * whole))) return;
  }
}

std::vector<double> SchurSystem::massless_shares(Counters& counters) {
  std::vector<double> shares(masses_.massless.size(), 0.0), loads(masses_.inverse.size()), qdd(loads),
      lambda(at(plan_->rows));
  const std::vector<double> gamma(lambda);
  std::mt19937 random(1);
  for (int probe = 0; probe < most_probes; ++probe) {
    for (int c : masses_.massless) loads[at(c)] = (random() & 1 ? 1 : -1) / std::sqrt(masses_.inverse[at(c)]);
    solve_with_masses<double>(loads, gamma, qdd, lambda, scratch_, counters);
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const std::size_t c = at(masses_.massless[k]);
      shares[k] = std::max(shares[k], std::abs(qdd[c]) / std::sqrt(masses_.inverse[c]));
    }
  }
  return shares;
}

void SchurSystem::least_change(std::span<const double> b, std::span<double> x, std::span<double> lambda,
                               Counters& counters) {
  std::copy(b.begin(), b.end(), lambda.begin());
  std::copy(b.begin(), b.end(), scratch_.right_hand_side.begin());
  solve_refined<double>(lambda, scratch_.right_hand_side, scratch_, counters);
  spread<double>(lambda, x);
}

void SchurSystem::least_change_rough(std::span<const double> b, std::span<double> x, std::span<double> lambda,
                                     Counters& counters) {
  std::copy(b.begin(), b.end(), lambda.begin());
  factors_.solve(lambda, counters);
  spread<double>(lambda, x);
}

}  // namespace catena
