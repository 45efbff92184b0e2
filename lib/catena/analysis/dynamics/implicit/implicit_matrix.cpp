#include "catena/analysis/dynamics/implicit/implicit_matrix.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

#include "catena/base/at.hpp"

namespace catena {
namespace {

// Compliance of a row, as a part of what the bodies' own resistance lets it give way: below the digits that Newton's
// method needs of its matrix, above rounding.
constexpr double compliance_part = 1e-10;
// Differences of velocities, in the largest of them: damping is linear in most cases, which leaves rounding of forces,
// 1e-12 of them then.
constexpr double velocity_difference = 1e-4;
// Of places, for contacts, in length scales or rad: the root of epsilon balances rounding and curvature.
constexpr double place_difference = 1.5e-8;

/// Place of an entry, which is there.
int place_of(const SparsePattern& pattern, int row, int column) {
  const auto begin = pattern.row_index.begin() + pattern.column_start[at(column)];
  const auto end = pattern.row_index.begin() + pattern.column_start[at(column) + 1];
  return static_cast<int>(std::lower_bound(begin, end, row) - pattern.row_index.begin());
}

// The matching that KLU orders by fills the matrix of a chain: of forty rods 94 % of all instructions were its own.
Kernel kernel() { return is_compiled_in(Kernel::umfpack) ? Kernel::umfpack : Kernel::automatic; }

}  // namespace

ImplicitMatrix::ImplicitMatrix(const Motion& motion)
    : motion_(motion),
      plan_(motion.equations().plan()),
      columns_(at(plan_.columns)),
      rows_(at(plan_.rows)),
      tangent_(motion.equations().evaluator().shared_plan(), SaddleBlock::elements),
      counters_(motion.equations().evaluator().counters) {
  std::vector<int> rows(rows_);
  std::iota(rows.begin(), rows.end(), 0);
  tangent_.arrange(rows, true);
  const SparsePattern& pattern = tangent_.pattern();
  if (!real_.analyze(pattern, kernel(), counters_).ok())
    throw std::logic_error("ImplicitMatrix: the pattern has its whole diagonal");
  for (int c = 0; c < plan_.columns; ++c) mass_slot_.push_back(place_of(pattern, c, c));
  for (int r = plan_.columns; r < pattern.rows; ++r) compliance_slot_.push_back(place_of(pattern, r, r));
  values_.assign(at(pattern.entries()), 0.0);
  damping_ = values_;
  jacobian_.assign(at(plan_.trash_slot()) + 1, 0.0);
  motion_.equations().evaluator().start_jacobian(jacobian_);
  loads_.assign(motion_.coordinates(), 0.0);
  moved_loads_ = loads_;
  moved_.assign(2 * motion_.coordinates(), 0.0);
  x_.assign(columns_ + rows_, 0.0);
  pair_r_.assign(2 * motion_.coordinates(), Complex());
  pair_x_.assign(columns_ + rows_, Complex());
  group_columns();
}

void ImplicitMatrix::analyze_pair() {
  const SparsePattern& pattern = tangent_.pattern();
  std::vector<MatrixEntry> places;
  for (int c = 0; c < pattern.columns; ++c) {
    for (int k = pattern.column_start[at(c)]; k < pattern.column_start[at(c) + 1]; ++k) {
      const int r = pattern.row_index[at(k)];
      for (const int i : {0, 1}) {
        for (const int j : {0, 1}) places.push_back({2 * r + i, 2 * c + j});
      }
    }
  }
  SlottedPattern pair = build_pattern(2 * pattern.rows, 2 * pattern.columns, places);
  pair_slot_ = std::move(pair.slot);
  if (!pair_.analyze(pair.pattern, kernel(), counters_).ok())
    throw std::logic_error("ImplicitMatrix: the pattern has its whole diagonal");
  pair_values_.assign(at(pair.pattern.entries()), 0.0);
}

// Columns of the elements' part of which no two reach the same row, one after the other.
void ImplicitMatrix::group_columns() {
  const SparsePattern& pattern = tangent_.pattern();
  std::vector<std::vector<int>> groups_of_row(columns_);
  for (int c = 0; c < plan_.columns; ++c) {
    std::vector<char> taken(groups_.size() + 1, 0);
    const auto for_rows = [&](auto&& f) {
      for (int k = pattern.column_start[at(c)]; k < pattern.column_start[at(c) + 1]; ++k) {
        if (pattern.row_index[at(k)] < plan_.columns) f(groups_of_row[at(pattern.row_index[at(k)])]);
      }
    };
    for_rows([&](const std::vector<int>& groups) {
      for (const int g : groups) taken[at(g)] = 1;
    });
    const auto group = static_cast<std::size_t>(std::find(taken.begin(), taken.end(), 0) - taken.begin());
    if (group == groups_.size()) groups_.emplace_back();
    groups_[group].push_back(c);
    for_rows([&](std::vector<int>& groups) { groups.push_back(static_cast<int>(group)); });
  }
}

bool ImplicitMatrix::linearize(double t, Side side, std::span<const double> y) {
  EquationsOfMotion& equations = motion_.equations();
  Evaluator& evaluator = equations.evaluator();
  evaluator.set_time(t, side);
  evaluator.set_configuration(motion_.q(y));
  if (rows_ > 0) evaluator.jacobian(jacobian_);
  tangent_.begin(jacobian_);
  tangent_.add_stiffness(evaluator, equations.multipliers());
  base_.assign(tangent_.values().begin(), tangent_.values().end());
  std::fill(damping_.begin(), damping_.end(), 0.0);
  add_differences(t, side, y);
  const double sum =
      std::accumulate(base_.begin(), base_.end(), 0.0) + std::accumulate(damping_.begin(), damping_.end(), 0.0);
  return std::isfinite(sum);
}

/// Calls visit(columns) for every group and takes what it says, -dQ/dx of every row, to the entries it belongs to.
template <class Visit>
void ImplicitMatrix::visit_groups(Visit&& visit) {
  const SparsePattern& pattern = tangent_.pattern();
  for (const std::vector<int>& group : groups_) {
    std::vector<double>& into = visit(group);
    for (const int c : group) {
      for (int k = pattern.column_start[at(c)]; k < pattern.column_start[at(c) + 1]; ++k) {
        const int r = pattern.row_index[at(k)];
        if (r >= plan_.columns) break;
        into[at(k)] += moved_loads_[at(plan_.coordinate[at(r)])];
      }
    }
  }
}

void ImplicitMatrix::add_differences(double t, Side side, std::span<const double> y) {
  Evaluator& evaluator = motion_.equations().evaluator();
  StateLoads* const contacts = motion_.equations().state_loads();
  const std::size_t n = motion_.coordinates();
  const double length = evaluator.length_scale();
  const std::span<double> q = std::span(moved_).first(n), qd = std::span(moved_).subspan(n);
  std::copy(y.begin(), y.begin() + static_cast<std::ptrdiff_t>(2 * n), moved_.begin());
  const auto unit = [&](int coordinate) { return coordinate % 3 == 2 ? 1 : length; };
  const auto velocity_loads = [&](std::vector<double>& loads) {
    evaluator.applied_forces(qd, loads);
    if (contacts) contacts->add(qd, loads);
  };
  velocity_loads(loads_);
  // Beside speeds that have become small rounding of the loads would count: those that they make over a length do.
  const std::span<const double> mass = motion_.equations().masses().mass;
  double speed = 0;
  for (std::size_t c = 0; c < mass.size(); ++c) {
    const double by = unit(static_cast<int>(c)), acceleration = mass[c] > 0 ? std::abs(loads_[c]) / (mass[c] * by) : 0;
    speed = std::max({speed, std::abs(qd[c]) / by, std::sqrt(acceleration)});
  }
  if (speed == 0) speed = 1;
  // -dQ of the group's columns, which differ in their units: each row is reached by one of them.
  const SparsePattern& pattern = tangent_.pattern();
  const auto divide = [&](const std::vector<int>& group, double difference) {
    for (std::size_t c = 0; c < n; ++c) moved_loads_[c] = (loads_[c] - moved_loads_[c]) / difference;
    for (const int c : group) {
      const double by = unit(plan_.coordinate[at(c)]);
      for (int k = pattern.column_start[at(c)]; k < pattern.column_start[at(c) + 1]; ++k) {
        if (pattern.row_index[at(k)] < plan_.columns)
          moved_loads_[at(plan_.coordinate[at(pattern.row_index[at(k)])])] /= by;
      }
    }
  };
  visit_groups([&](const std::vector<int>& group) -> std::vector<double>& {
    for (const int c : group)
      qd[at(plan_.coordinate[at(c)])] += velocity_difference * speed * unit(plan_.coordinate[at(c)]);
    velocity_loads(moved_loads_);
    for (const int c : group) qd[at(plan_.coordinate[at(c)])] = y[n + at(plan_.coordinate[at(c)])];
    divide(group, velocity_difference * speed);
    return damping_;
  });
  if (!contacts) return;
  std::fill(loads_.begin(), loads_.end(), 0.0);
  contacts->add(qd, loads_);
  const auto places = evaluator.curve_places();
  visit_groups([&](const std::vector<int>& group) -> std::vector<double>& {
    for (const int c : group) q[at(plan_.coordinate[at(c)])] += place_difference * unit(plan_.coordinate[at(c)]);
    evaluator.set_configuration(q);
    std::fill(moved_loads_.begin(), moved_loads_.end(), 0.0);
    contacts->add(qd, moved_loads_);
    for (const int c : group) q[at(plan_.coordinate[at(c)])] = y[at(plan_.coordinate[at(c)])];
    divide(group, place_difference);
    return base_;
  });
  evaluator.go_to_curve_places(places);
  evaluator.set_time(t, side);
  evaluator.set_configuration(motion_.q(y));
}

// What is on the diagonal beside K, and E.
void ImplicitMatrix::find_compliance(double mu) {
  const SparsePattern& pattern = tangent_.pattern();
  const std::span<const double> mass = motion_.equations().masses().mass;
  for (const int slot : compliance_slot_) values_[at(slot)] = 0;
  for (int c = 0; c < plan_.columns; ++c) {
    const std::size_t diagonal = at(mass_slot_[at(c)]);
    const double resistance =
        mu * mu * mass[at(plan_.coordinate[at(c)])] + mu * std::abs(damping_[diagonal]) + std::abs(base_[diagonal]);
    if (!(resistance > 0)) continue;
    for (int k = pattern.column_start[at(c)]; k < pattern.column_start[at(c) + 1]; ++k) {
      const int r = pattern.row_index[at(k)] - plan_.columns;
      if (r >= 0) values_[at(compliance_slot_[at(r)])] -= compliance_part * base_[at(k)] * base_[at(k)] / resistance;
    }
  }
  // Rows between bodies that do not move, and rows that do not hold for the time being.
  for (const int slot : compliance_slot_) {
    if (values_[at(slot)] == 0) values_[at(slot)] = -1;
  }
}

bool ImplicitMatrix::factorize(double real) {
  const std::span<const double> mass = motion_.equations().masses().mass;
  mu_ = real;
  for (std::size_t k = 0; k < base_.size(); ++k) values_[k] = base_[k] + mu_ * damping_[k];
  for (std::size_t c = 0; c < columns_; ++c) values_[at(mass_slot_[c])] += mu_ * mu_ * mass[at(plan_.coordinate[c])];
  find_compliance(mu_);
  return real_.factorize(values_, counters_).ok();
}

bool ImplicitMatrix::factorize(Complex pair) {
  if (pair_slot_.empty()) analyze_pair();
  const std::span<const double> mass = motion_.equations().masses().mass;
  nu_ = pair;
  const auto set_pair = [&](std::size_t k, Complex value) {
    pair_values_[at(pair_slot_[4 * k])] = pair_values_[at(pair_slot_[4 * k + 3])] = value.real();
    pair_values_[at(pair_slot_[4 * k + 1])] = -value.imag();
    pair_values_[at(pair_slot_[4 * k + 2])] = value.imag();
  };
  for (std::size_t k = 0; k < base_.size(); ++k) set_pair(k, base_[k] + nu_ * damping_[k]);
  for (std::size_t c = 0; c < columns_; ++c) {
    const std::size_t k = at(mass_slot_[c]);
    set_pair(k, base_[k] + nu_ * damping_[k] + nu_ * nu_ * mass[at(plan_.coordinate[c])]);
  }
  find_compliance(std::abs(nu_));
  for (const int slot : compliance_slot_) set_pair(at(slot), values_[at(slot)]);
  return pair_.factorize(pair_values_, counters_).ok();
}

template <class N>
void ImplicitMatrix::fill_right_hand_side(N mu, std::span<const N> r_q, std::span<const N> r_v,
                                          std::span<N> out) const {
  const SparsePattern& pattern = tangent_.pattern();
  const std::span<const double> mass = motion_.equations().masses().mass;
  std::fill(out.begin(), out.end(), N(0));
  for (int c = 0; c < plan_.columns; ++c) {
    const std::size_t k = at(plan_.coordinate[at(c)]);
    const N pushed = r_v[k] + mu * r_q[k];
    out[at(c)] += mass[k] * pushed;
    for (int e = pattern.column_start[at(c)]; e < pattern.column_start[at(c) + 1]; ++e) {
      const int r = pattern.row_index[at(e)];
      out[at(r)] += r < plan_.columns ? damping_[at(e)] * r_q[k] : base_[at(e)] * pushed / (mu * mu);
    }
  }
}

void ImplicitMatrix::solve(std::span<double> r) {
  const std::size_t n = motion_.coordinates();
  const std::span<double> r_q = r.first(n), r_v = r.subspan(n, n);
  fill_right_hand_side<double>(mu_, r_q, r_v, x_);
  real_.solve(x_, counters_);
  for (std::size_t c = 0; c < columns_; ++c) {
    const std::size_t k = at(plan_.coordinate[c]);
    r_v[k] = mu_ * x_[c] - r_q[k];
    r_q[k] = x_[c];
  }
}

void ImplicitMatrix::solve(std::span<double> re, std::span<double> im) {
  const std::size_t n = motion_.coordinates();
  for (std::size_t k = 0; k < 2 * n; ++k) pair_r_[k] = {re[k], im[k]};
  const std::span<const Complex> r(pair_r_);
  fill_right_hand_side<Complex>(nu_, r.first(n), r.subspan(n, n), pair_x_);
  // A complex number is laid out as its real and imaginary part: the order of the pair's equations.
  pair_.solve(std::span(reinterpret_cast<double*>(pair_x_.data()), 2 * pair_x_.size()), counters_);
  for (std::size_t c = 0; c < columns_; ++c) {
    const std::size_t k = at(plan_.coordinate[c]);
    const Complex rate = nu_ * pair_x_[c] - pair_r_[k];
    re[k] = pair_x_[c].real();
    im[k] = pair_x_[c].imag();
    re[n + k] = rate.real();
    im[n + k] = rate.imag();
  }
}

}  // namespace catena
