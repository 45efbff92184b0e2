// The kernels of equilibria for one instruction set: what lane_static_code.hpp describes, in packs. Included by the
// file of each instruction set alone, which is compiled for it.
#pragma once

#include "catena/analysis/batch/kernels/lane_energy.hpp"
#include "catena/analysis/batch/kernels/lane_twin.hpp"

namespace catena {

template <class V>
class LaneStaticKernel : LaneEnergy<V> {
 public:
  using Base = LaneEnergy<V>;
  using Base::look;
  LaneStaticKernel(const LaneStaticJob& job, int lane)
      : Base(job, lane), n_(job.columns), m_(code_.rows), free_(n_ - m_) {}

  void weigh();
  void reflect();
  void balance();
  void curve();
  void stiffen();
  void step();
  void correct();
  void soften();

 private:
  using Base::arm;
  using Base::at;
  using Base::code_;
  using Base::job_;
  using Base::put;
  using Base::rest_;
  using Base::tell;
  using Base::unit_;
  using typename Base::Mask;
  using typename Base::P;
  static constexpr double largest_turn = 1;   // of a correction, rad
  static constexpr double smallest = 1e-300;  // stands for zero where something is divided by it

  P reflector(int row, int k) const { return at(rest_.reflector, m_ * row + k); }
  P reduced(int row, int c) const { return at(rest_.reduced, n_ * row + c); }
  P lower(int row, int c) const { return at(rest_.lower, free_ * row + c); }
  // The first n numbers of `work` are a vector over columns, in the axes of Q.
  P work(int k) const { return at(rest_.work, k); }
  void set_work(int k, const P& value) const { put(rest_.work, k, value); }
  void multiply(int k, double* numbers) const;
  void to_axes(double* numbers) const;
  void from_axes(double* numbers) const;
  void solve_range() const;
  void solve_free() const;
  void reduce_by(int k) const;
  P mask() const { return at(rest_.mask, 0); }

  int n_, m_, free_;
};

// numbers -= beta v (v^T numbers) of reflection k.
template <class V>
void LaneStaticKernel<V>::multiply(int k, double* numbers) const {
  P sum(0);
  for (int i = k; i < n_; ++i) sum = sum + reflector(i, k) * at(numbers, i);
  sum = sum * at(rest_.factor, k);
  for (int i = k; i < n_; ++i) put(numbers, i, at(numbers, i) - sum * reflector(i, k));
}

template <class V>
void LaneStaticKernel<V>::to_axes(double* numbers) const {
  for (int k = 0; k < m_; ++k) multiply(k, numbers);
}

template <class V>
void LaneStaticKernel<V>::from_axes(double* numbers) const {
  for (int k = m_ - 1; k >= 0; --k) multiply(k, numbers);
}

template <class V>
void LaneStaticKernel<V>::weigh() {
  P residual(0), force(0);
  for (int c = 0; c < n_; ++c) {
    set_work(c, arm(c) * at(rest_.gradient, c));
    force = larger(force, abs(work(c)));
  }
  for (int k = 0; k < rest_.entries; ++k) {
    const int c = rest_.entry_column[k];
    const P part = arm(c) * at(job_.matrix, k) * at(job_.lambda, rest_.entry_row[k]);
    set_work(c, work(c) + part);
    force = larger(force, abs(part));
  }
  for (int c = 0; c < n_; ++c) residual = larger(residual, abs(work(c)));
  tell(rest_residual, residual);
  tell(rest_force, force);
}

template <class V>
void LaneStaticKernel<V>::reflect() {
  const Mask chosen = mask() > P(0.5);
  const auto keep = [&](double* numbers, int place, const P& value) {
    put(numbers, place, select(chosen, value, at(numbers, place)));
  };
  for (int k = 0; k < n_ * m_; ++k) keep(rest_.reflector, k, P(0));
  for (int k = 0; k < rest_.entries; ++k) {
    const int c = rest_.entry_column[k];
    keep(rest_.reflector, m_ * c + rest_.entry_row[k], arm(c) * at(job_.matrix, k));
  }
  P rank(1);
  for (int k = 0; k < m_; ++k) {
    P square(0), whole(0);
    for (int i = 0; i < n_; ++i) {
      const P entry = reflector(i, k);
      whole = whole + entry * entry;
      if (i >= k) square = square + entry * entry;
    }
    const P first = reflector(k, k), size = sqrt(square);
    const P part = size / larger(sqrt(whole), P(smallest));
    rank = select(part < rank, part, rank);
    const P side = select(first < P(0), P(-1), P(1));
    keep(rest_.diagonal, k, -(side * size));
    keep(rest_.factor, k, P(1) / larger(size * (size + abs(first)), P(smallest)));
    keep(rest_.reflector, m_ * k + k, first + side * size);
    for (int c = k + 1; c < m_; ++c) {
      P sum(0);
      for (int i = k; i < n_; ++i) sum = sum + reflector(i, k) * reflector(i, c);
      sum = sum * at(rest_.factor, k);
      for (int i = k; i < n_; ++i) keep(rest_.reflector, m_ * i + c, reflector(i, c) - sum * reflector(i, k));
    }
  }
  keep(rest_.told, rest_rank, rank);
}

// R lambda = -(Q^T D V_q), of the range.
template <class V>
void LaneStaticKernel<V>::balance() {
  for (int c = 0; c < n_; ++c) set_work(c, arm(c) * at(rest_.gradient, c));
  to_axes(rest_.work);
  for (int k = m_ - 1; k >= 0; --k) {
    P sum = -work(k);
    for (int j = k + 1; j < m_; ++j) sum = sum - reflector(k, j) * at(job_.lambda, j);
    put(job_.lambda, k, sum / at(rest_.diagonal, k));
  }
}

// B <- H B H for reflection k: p = beta B v, w = p - beta/2 (p.v) v, B -= v w^T + w v^T.
template <class V>
void LaneStaticKernel<V>::reduce_by(int k) const {
  const P beta = at(rest_.factor, k);
  P along(0);
  for (int i = 0; i < n_; ++i) {
    P sum(0);
    for (int j = k; j < n_; ++j) sum = sum + reduced(i, j) * reflector(j, k);
    sum = beta * sum;
    set_work(i, sum);
    if (i >= k) along = along + sum * reflector(i, k);
  }
  along = P(0.5) * beta * along;
  for (int i = k; i < n_; ++i) set_work(i, work(i) - along * reflector(i, k));
  for (int i = 0; i < n_; ++i) {
    const bool has_part = i >= k;
    const P own = work(i), part = has_part ? reflector(i, k) : P(0);
    for (int j = has_part ? 0 : k; j < n_; ++j) {
      P value = reduced(i, j);
      if (j >= k) value = value - own * reflector(j, k);
      if (has_part) value = value - part * work(j);
      put(rest_.reduced, n_ * i + j, value);
    }
  }
}

template <class V>
void LaneStaticKernel<V>::curve() {
  this->fill();
  P stiffest(0);
  for (int k = 0; k < n_ * n_; ++k) put(rest_.reduced, k, at(rest_.stiffness, k));
  for (int c = 0; c < n_; ++c) stiffest = larger(stiffest, abs(reduced(c, c)));
  for (int k = 0; k < m_; ++k) reduce_by(k);
  tell(rest_stiffest, stiffest);
}

template <class V>
void LaneStaticKernel<V>::stiffen() {
  const P shift = at(rest_.shift, 0);
  Mask positive = P(0) < P(1);
  P least(1e300);
  for (int c = 0; c < free_; ++c) {
    for (int r = c; r < free_; ++r) {
      P value = reduced(m_ + r, m_ + c);
      if (r == c) value = value + shift;
      for (int k = 0; k < c; ++k) value = value - lower(r, k) * lower(c, k);
      if (r == c) {
        positive = positive && value > P(0);
        least = select(abs(value) < least, abs(value), least);
        value = sqrt(value);
      } else {
        value = value / lower(c, c);
      }
      put(rest_.lower, free_ * r + c, value);
    }
  }
  tell(rest_positive, select(positive, P(1), P(0)));
  tell(rest_pivot, least);
}

// y with R^T y = -Phi, into the first numbers of `work`.
template <class V>
void LaneStaticKernel<V>::solve_range() const {
  for (int k = 0; k < m_; ++k) {
    P sum = -at(job_.right, k);
    for (int j = 0; j < k; ++j) sum = sum - reflector(j, k) * work(j);
    set_work(k, sum / at(rest_.diagonal, k));
  }
}

// L L^T z = what stands behind them there, minus B y.
template <class V>
void LaneStaticKernel<V>::solve_free() const {
  for (int r = 0; r < free_; ++r) {
    P sum = work(m_ + r);
    for (int k = 0; k < m_; ++k) sum = sum - reduced(m_ + r, k) * work(k);
    for (int k = 0; k < r; ++k) sum = sum - lower(r, k) * work(m_ + k);
    set_work(m_ + r, sum / lower(r, r));
  }
  for (int r = free_ - 1; r >= 0; --r) {
    P sum = work(m_ + r);
    for (int k = r + 1; k < free_; ++k) sum = sum - lower(k, r) * work(m_ + k);
    set_work(m_ + r, sum / lower(r, r));
  }
}

template <class V>
void LaneStaticKernel<V>::step() {
  double* const force = rest_.work + lane_count * n_;  // -Q^T D V_q
  const P shift = at(rest_.shift, 0);
  for (int c = 0; c < n_; ++c) put(force, c, -(arm(c) * at(rest_.gradient, c)));
  to_axes(force);
  solve_range();
  for (int k = m_; k < n_; ++k) set_work(k, at(force, k));
  solve_free();
  for (int k = m_ - 1; k >= 0; --k) {
    P sum = at(force, k) - shift * work(k);
    for (int j = 0; j < n_; ++j) sum = sum - reduced(k, j) * work(j);
    for (int j = k + 1; j < m_; ++j) sum = sum - reflector(k, j) * at(rest_.next_lambda, j);
    put(rest_.next_lambda, k, sum / at(rest_.diagonal, k));
  }
  from_axes(rest_.work);
  P turn(0), travel(0), slope(0), terms(0);
  for (int c = 0; c < n_; ++c) {
    const P own = work(c), change = arm(c) * own;
    put(rest_.change, c, change);
    slope = slope + change * at(rest_.gradient, c);
    if (c % 3 == 2) {
      turn = larger(turn, abs(change));
    } else {
      travel = larger(travel, abs(change));
    }
    P row(0);
    for (int j = 0; j < n_; ++j) row = row + abs(at(rest_.stiffness, n_ * c + j) * work(j));
    terms = terms + row * abs(own);
  }
  tell(rest_turn, turn);
  tell(rest_travel, travel);
  tell(rest_step, larger(turn, unit_ * travel));
  tell(rest_slope, slope);
  tell(rest_terms, terms);
}

template <class V>
void LaneStaticKernel<V>::correct() {
  const Mask chosen = mask() > P(0.5), bare = at(rest_.by_weights, 0) > P(0.5);
  solve_range();
  for (int k = m_; k < n_; ++k) set_work(k, P(0));
  solve_free();
  for (int k = m_; k < n_; ++k) set_work(k, select(bare, P(0), work(k)));
  from_axes(rest_.work);
  P size(0);
  for (int c = 0; c < n_; ++c) {
    P change = arm(c) * work(c);
    size = larger(size, c % 3 == 2 ? abs(change) : unit_ * abs(change));
    if (c % 3 == 2) {
      const P limit(largest_turn);
      change = select(change > limit, limit, select(change < -limit, -limit, change));
    }
    const P old = at(job_.q, c);
    put(job_.q, c, select(chosen, old + change, old));
  }
  tell(rest_step, size);
}

// 1 / trace of the inverse, which is the sum of squares of L^-1.
template <class V>
void LaneStaticKernel<V>::soften() {
  P trace(0);
  for (int c = 0; c < free_; ++c) {
    for (int r = c; r < free_; ++r) {
      P sum(r == c ? 1 : 0);
      for (int k = c; k < r; ++k) sum = sum - lower(r, k) * work(k);
      set_work(r, sum / lower(r, r));
      trace = trace + work(r) * work(r);
    }
  }
  tell(rest_softest, P(1) / larger(trace, P(smallest)));
}

/// Calls f(kernels) for the packs in use, by twos as for_each_pack() does.
template <class V, class F>
void for_each_static_pack(const LaneStaticJob& job, F&& f) {
  int lane = 0;
  for (; job.equations.lanes - lane > static_cast<int>(V::size); lane += static_cast<int>(Twin<V>::size)) {
    LaneStaticKernel<Twin<V>> kernel(job, lane);
    f(kernel);
  }
  if (lane >= job.equations.lanes) return;
  LaneStaticKernel<V> kernel(job, lane);
  f(kernel);
}

/// The kernels in packs V: of the instruction set that the including file is compiled for.
template <class V>
constexpr LaneStaticKernels make_lane_static_kernels() {
  using Job = const LaneStaticJob&;
  return {[](Job job) { for_each_static_pack<V>(job, [](auto& k) { k.look(); }); },
          [](Job job) { for_each_static_pack<V>(job, [](auto& k) { k.weigh(); }); },
          [](Job job) { for_each_static_pack<V>(job, [](auto& k) { k.reflect(); }); },
          [](Job job) { for_each_static_pack<V>(job, [](auto& k) { k.balance(); }); },
          [](Job job) { for_each_static_pack<V>(job, [](auto& k) { k.curve(); }); },
          [](Job job) { for_each_static_pack<V>(job, [](auto& k) { k.stiffen(); }); },
          [](Job job) { for_each_static_pack<V>(job, [](auto& k) { k.step(); }); },
          [](Job job) { for_each_static_pack<V>(job, [](auto& k) { k.correct(); }); },
          [](Job job) { for_each_static_pack<V>(job, [](auto& k) { k.soften(); }); }};
}

}  // namespace catena
