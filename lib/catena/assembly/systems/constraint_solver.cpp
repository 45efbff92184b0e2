#include "catena/assembly/systems/constraint_solver.hpp"

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include "catena/assembly/systems/light_turns.hpp"
#include "catena/assembly/systems/row_spread.hpp"
#include "catena/base/at.hpp"
#include "catena/linalg/rank/dependence.hpp"

namespace catena {
namespace {

// Largest to least, and lightness to turn (light_turns.hpp): from here on light bodies cost digits.
constexpr double unequal_masses = 1e5, light_turn = 100;

/// For what remains of solutions that are refined, and for their changes; without it none is.
void make_room(std::size_t coordinates, std::size_t rows, std::initializer_list<std::vector<double>*> of_coordinates,
               std::initializer_list<std::vector<double>*> of_rows) {
  for (std::vector<double>* all : of_coordinates) all->resize(coordinates);
  for (std::vector<double>* all : of_rows) all->resize(rows);
}

}  // namespace

ConstraintSolver::ConstraintSolver(std::shared_ptr<const Plan> plan) : plan_(std::move(plan)) {
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

void ConstraintSolver::set_metric(std::span<const double> masses, std::span<const double> substitutes) {
  masses_.given.assign(masses.begin(), masses.end());
  masses_.massless.clear();
  double least[2] = {}, largest[2] = {};  // of masses, of moments of inertia
  for (std::size_t c = 0; c < masses.size(); ++c) {
    const std::size_t kind = c % 3 == 2 ? 1 : 0;
    largest[kind] = std::max(largest[kind], masses[c]);
    if (masses[c] > 0 && (least[kind] == 0 || masses[c] < least[kind])) least[kind] = masses[c];
    const double mass = masses[c] > 0 ? masses[c] : substitutes.empty() ? 0 : substitutes[c];
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

void ConstraintSolver::leave_out(SparseVectors directions) {
  // Until the next factorization the diagonal is that of S, too.
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

std::vector<double> ConstraintSolver::row_sizes() const {
  std::vector<double> sizes = diagonal_values_;
  for (std::size_t n = 0; n < left_out_.index.size(); ++n) {
    sizes[at(left_out_.index[n])] -= left_out_.value[n] * left_out_.value[n];
  }
  for (double& size : sizes) size = std::sqrt(std::max(size, 0.0));
  return sizes;
}

void ConstraintSolver::assemble(std::span<const Column> columns, const int* slot, std::span<double> values) const {
  const double* jacobian = jacobian_;
  for (const Column& column : columns) {
    const double inverse_mass = masses_.inverse[at(column.coordinate)];
    for (int x = column.first; x < column.last; ++x) {
      const double factor = inverse_mass * jacobian[x];
      for (int y = column.first; y <= x; ++y) values[at(*slot++)] += factor * jacobian[y];
    }
  }
}

void ConstraintSolver::fill(double regularised_part) {
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
  for (std::size_t k = 0; compliance_ && k < places_.diagonal.size(); ++k)
    values[at(places_.diagonal[k])] += compliance_[k];
  for (std::size_t k = 0; k < places_.diagonal.size(); ++k) {
    double& value = values[at(places_.diagonal[k])];
    // An equation between bodies that cannot move must not stop the others.
    if (value == 0) value = 1;
    diagonal_values_[k] = value;
    value *= 1 + regularised_part;
  }
}

bool ConstraintSolver::factor_values(double regularised_part, Counters& counters) {
  fill(regularised_part);
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

bool ConstraintSolver::prepare(Counters& counters) {
  if (!analyzed_ && !analyze(counters)) return false;
  std::fill(constant_values_.begin(), constant_values_.end(), 0.0);
  assemble(places_.constant, places_.constant_slot.data(), constant_values_);
  constants_known_ = true;
  const std::span<const double> jacobian(jacobian_, at(plan_->jacobian.entries()));
  if (rest_.Q.empty() && largest_turn(*plan_, masses_.given, jacobian) > light_turn)
    make_room(masses_.given.size(), at(plan_->rows), {&rest_.Q, &rest_.qdd}, {&rest_.gamma, &rest_.lambda});
  return true;
}

inline bool ConstraintSolver::begin(const double* jacobian, const double* compliance, Counters& counters) {
  jacobian_ = jacobian;
  compliance_ = compliance;
  return constants_known_ || plan_->rows == 0 || prepare(counters);
}

bool ConstraintSolver::factor_once(double part, Counters& counters) {
  return plan_->rows == 0 || (factor_values(part, counters) && factors_.is_factorized());
}

bool ConstraintSolver::factorize_damped(std::span<const double> jacobian, double damping, Counters& counters) {
  return begin(jacobian.data(), nullptr, counters) && factor_once(damping, counters);
}

bool ConstraintSolver::factorize_compliant(std::span<const double> jacobian, std::span<const double> compliance,
                                           Counters& counters) {
  return begin(jacobian.data(), compliance.data(), counters) && factor_once(0, counters);
}

bool ConstraintSolver::factorize(std::span<const double> jacobian, Counters& counters) {
  if (!begin(jacobian.data(), nullptr, counters)) return false;
  if (plan_->rows == 0) return true;
  // Equations that depended on each other at the last factorization probably still do.
  const bool before = regularised_;
  if (!factor_values(before ? dependence::regularisation : 0, counters)) return false;
  if (before && !(smallest_ratio_ < dependence::clearly_more * dependence::formal)) {
    // What is added to a large diagonal shows in the pivots of small ones: whether the equations are regular is seen
    // without it, as far as rounding of the large ones allows.
    if (!factor_values(0, counters)) return false;
    const double spread = row_spread(diagonal_values_, plan_->row_is_angle);
    regularised_ = smallest_ratio_ < std::max(dependence::formal, dependence::rounding_of_pivots * spread);
    if (regularised_ && !factor_values(dependence::regularisation, counters)) return false;
  }
  if (smallest_ratio_ < dependence::formal && !regularised_) {
    regularised_ = true;
    if (!factor_values(dependence::regularisation, counters)) return false;
  }
  // A pivot that is negative even so is rounding beside very unequal weights: refinement has to do with it.
  if (regularised_) smallest_ratio_ = std::min(smallest_ratio_, dependence::formal);
  return factors_.is_factorized();
}

}  // namespace catena
