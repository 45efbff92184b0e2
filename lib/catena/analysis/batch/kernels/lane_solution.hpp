// Phi_q x = right in packs of designs: the listed steps of an elimination (lane_code.hpp), and its tails, whose rows
// are exchanged lane by lane; and Phi_q^T x = right from the same factors. Part of the kernels (lane_kernel.hpp).
#pragma once

#include "catena/analysis/batch/kernels/lane_equations.hpp"

namespace catena {

template <class V>
class LaneSolution : protected LaneEquations<V> {
 protected:
  using Base = LaneEquations<V>;
  using Base::at;
  using Base::Base;
  using Base::code_;
  using Base::job_;
  using Base::put;
  using Base::unit_;
  using typename Base::Mask;
  using typename Base::P;

  void factor();
  /// x of an unknown takes the place of the row of its pivot.
  void solve_right() { take_steps<false>(code_.solve, code_.solve_runs, job_.right); }
  /// The right-hand side of a column stands in the row of its pivot; x takes the place of its row.
  void solve_transposed() { take_steps<true>(code_.transposed, code_.transposed_runs, job_.right); }
  /// Unknowns into the numbers of coordinates.
  void store_unknowns(double* numbers) const;

 private:
  static P there(const double* base, int place) { return P::load(base + place); }
  template <class F>
  void for_each_step(const LaneRun& run, double* numbers, F&& f) const;
  template <bool is_transposed>
  void take_steps(const LaneRun* run, int runs, double* numbers);
  template <class F>
  void with_size(const LaneTail& tail, F&& f);
  template <int n>
  void factor_tail(const LaneTail& tail, int number);
  template <int n>
  void solve_tail(const LaneTail& tail, int number);
  template <int n>
  void solve_tail_transposed(const LaneTail& tail, int number);
};

template <class V>
void LaneSolution<V>::store_unknowns(double* numbers) const {
  for (const LaneUnknown* u = code_.unknown; u != code_.unknown + code_.rows; ++u)
    there(job_.right, u->place).store(numbers + u->coordinate);
}

template <class V>
template <class F>
void LaneSolution<V>::with_size(const LaneTail& tail, F&& f) {
  static_assert(largest_tail == 6);
  switch (tail.size) {
    case 1:
      return f.template operator()<1>();
    case 2:
      return f.template operator()<2>();
    case 3:
      return f.template operator()<3>();
    case 4:
      return f.template operator()<4>();
    case 5:
      return f.template operator()<5>();
    default:
      return f.template operator()<6>();
  }
}

// Pointers of its own: those of the object would be read anew after every store.
template <class V>
template <class F>
void LaneSolution<V>::for_each_step(const LaneRun& run, double* numbers, F&& f) const {
  const double* const matrix = job_.matrix;
  for (const LaneStep *s = code_.step + run.first, *end = code_.step + run.last; s != end; ++s) {
    const P t = there(numbers, s->target);
    f(t, numbers + s->source, matrix + s->factor).store(numbers + s->target);
  }
}

template <class V>
template <bool is_transposed>
void LaneSolution<V>::take_steps(const LaneRun* run, int runs, double* numbers) {
  using From = const double*;
  for (const LaneRun* const last = run + runs; run != last; ++run) {
    switch (run->act) {
      case LaneAct::add_product:
        for_each_step(*run, numbers, [](const P& t, From s, From m) { return t + P::load(m) * P::load(s); });
        break;
      case LaneAct::subtract_product:
        for_each_step(*run, numbers, [](const P& t, From s, From m) { return t - P::load(m) * P::load(s); });
        break;
      case LaneAct::solve_tail: {
        const LaneTail& tail = code_.tail[run->first];
        with_size(tail, [&]<int n>() {
          if constexpr (is_transposed) {
            solve_tail_transposed<n>(tail, run->first);
          } else {
            solve_tail<n>(tail, run->first);
          }
        });
        break;
      }
    }
  }
}

template <class V>
void LaneSolution<V>::factor() {
  for (const LaneReset* r = code_.reset; r != code_.reset + code_.resets; ++r)
    P(r->value).store(job_.matrix + r->place);
  take_steps<false>(code_.factor, code_.factor_runs, job_.matrix);
  for (int number = 0; number < code_.tails; ++number) {
    const LaneTail& tail = code_.tail[number];
    with_size(tail, [&]<int n>() { factor_tail<n>(tail, number); });
  }
}

// L and U of the tail, rows exchanged; an exchange is 1 in the lanes that make it. On the diagonal stands 1 / U.
template <class V>
template <int n>
void LaneSolution<V>::factor_tail(const LaneTail& tail, int number) {
  const int base = number * largest_tail * largest_tail;
  P a[n][n];
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) a[r][c] = there(job_.matrix, tail.slot[n * r + c]);
  P determinant(1);
  for (int p = 0; p < n; ++p) {
    for (int i = p + 1; i < n; ++i) {
      const Mask larger_below = abs(a[i][p]) > abs(a[p][p]);
      put(job_.exchange, base + n * p + i, select(larger_below, P(1), P(0)));
      for (int c = 0; c < n; ++c) {
        const P upper = a[p][c];
        a[p][c] = select(larger_below, a[i][c], upper);
        a[i][c] = select(larger_below, upper, a[i][c]);
      }
      determinant = select(larger_below, -determinant, determinant);
    }
    determinant = determinant * a[p][p];
    const P inverse = P(1) / a[p][p];
    for (int i = p + 1; i < n; ++i) {
      a[i][p] = a[i][p] * inverse;
      for (int c = p + 1; c < n; ++c) a[i][c] = a[i][c] - a[i][p] * a[p][c];
    }
    a[p][p] = inverse;
  }
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < n; ++c) put(job_.tail, base + n * r + c, a[r][c]);
    if (tail.length_row[r]) determinant = determinant * unit_;
    if (tail.length_column[r]) determinant = determinant / unit_;
  }
  put(job_.found.margin, number, determinant);
}

template <class V>
template <int n>
void LaneSolution<V>::solve_tail(const LaneTail& tail, int number) {
  const int base = number * largest_tail * largest_tail;
  P x[n];
  for (int r = 0; r < n; ++r) x[r] = there(job_.right, tail.row[r]);
  // L has the exchanges of later columns in it: all of them come first.
  for (int p = 0; p < n; ++p) {
    for (int i = p + 1; i < n; ++i) {
      const Mask exchanged = at(job_.exchange, base + n * p + i) > P(0.5);
      const P upper = x[p];
      x[p] = select(exchanged, x[i], upper);
      x[i] = select(exchanged, upper, x[i]);
    }
  }
  const auto factor = [&](int r, int c) { return at(job_.tail, base + n * r + c); };
  for (int r = 1; r < n; ++r)
    for (int c = 0; c < r; ++c) x[r] = x[r] - factor(r, c) * x[c];
  for (int r = n; r-- > 0;) {
    for (int c = r + 1; c < n; ++c) x[r] = x[r] - factor(r, c) * x[c];
    x[r] = x[r] * factor(r, r);
    x[r].store(job_.right + tail.row[r]);
  }
}

// T = S^-1 L U with the exchanges S: T^-T = S^T L^-T U^-T.
template <class V>
template <int n>
void LaneSolution<V>::solve_tail_transposed(const LaneTail& tail, int number) {
  const int base = number * largest_tail * largest_tail;
  P x[n];
  for (int r = 0; r < n; ++r) x[r] = there(job_.right, tail.row[r]);
  const auto factor = [&](int r, int c) { return at(job_.tail, base + n * r + c); };
  for (int r = 0; r < n; ++r) {
    for (int c = 0; c < r; ++c) x[r] = x[r] - factor(c, r) * x[c];
    x[r] = x[r] * factor(r, r);
  }
  for (int r = n; r-- > 0;)
    for (int c = r + 1; c < n; ++c) x[r] = x[r] - factor(c, r) * x[c];
  for (int p = n; p-- > 0;) {
    for (int i = n; i-- > p + 1;) {
      const Mask exchanged = at(job_.exchange, base + n * p + i) > P(0.5);
      const P upper = x[p];
      x[p] = select(exchanged, x[i], upper);
      x[i] = select(exchanged, upper, x[i]);
    }
  }
  for (int r = 0; r < n; ++r) x[r].store(job_.right + tail.row[r]);
}

}  // namespace catena
