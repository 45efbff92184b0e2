// The kernels of a batch for one instruction set: what lane_code.hpp describes, in packs. Included by the file of each
// instruction set alone, which is compiled for it.
//
//   gamma = -d2Phi/dt2 along q + qd t      nu = -dPhi/dt at rest      both from the Taylor series of phi, as the
//   derived operations of assembly/constraint_operations.hpp; Phi_q from dual numbers. Pins have their closed forms.
//
// A correction is taken with the factors at hand while the configuration is so near to where they were made that it
// leaves less than a hundredth of the error; a lane is done when the next correction would be rounding. Velocities and
// accelerations are solved for with factors of the last configuration.
// Cosine and sine as in base/sincos.hpp; angles beyond 1e5 rad are not reduced: such lanes do not converge.
#pragma once

#include "catena/analysis/batch/lane_code.hpp"
#include "catena/analysis/batch/lane_pack.hpp"
#include "catena/elements/constraints/absolute_angle.hpp"
#include "catena/elements/constraints/absolute_distance.hpp"
#include "catena/elements/constraints/absolute_x.hpp"
#include "catena/elements/constraints/absolute_y.hpp"
#include "catena/elements/constraints/coupler.hpp"
#include "catena/elements/constraints/displacement.hpp"
#include "catena/elements/constraints/relative_angle.hpp"
#include "catena/elements/constraints/relative_distance.hpp"
#include "catena/elements/constraints/relative_x.hpp"
#include "catena/elements/constraints/relative_y.hpp"
#include "catena/elements/constraints/revolute.hpp"
#include "catena/elements/constraints/slot.hpp"
#include "catena/elements/constraints/translational.hpp"
#include "catena/elements/constraints/weld.hpp"
#include "catena/elements/list.hpp"

namespace catena {

template <class V>
class LaneKernel {
 public:
  // Everything in one function: what is stored in packs might be any memory for all that the compiler knows, but not
  // the members of an object that never leaves its function.
  [[gnu::flatten]] static void solve(LaneJob& job) {
    for (int lane = 0; lane < job.lanes; lane += P::size) {
      LaneKernel kernel(job, lane);
      kernel.solve();
    }
  }
  [[gnu::flatten]] static void foretell(const LaneForetelling& f);

 private:
  using P = Pack<V>;
  using Mask = typename P::Mask;
  static constexpr int most_iterations = 25;
  // In length scales or rad, as in kinematics/driven_solver.cpp: a correction below `negligible` is not computed; one
  // below `rounding_floor` need not shrink any more.
  static constexpr double negligible = 1e-15, rounding_floor = 1e-12;
  // Factors from further away than this, or that leave more than this of a correction, are made anew.
  static constexpr double keep_distance = 1e-3, poor_contraction = 0.1;
  static constexpr double largest_angle = 1e5;

  LaneKernel(const LaneJob& job, int lane)
      : job_(job), code_(*job.code), first_of_type_(job.code->first_of_type), unit_(P::load(job.unit + lane)) {
    // One by one: an object whose members have their addresses taken would be kept in memory.
    job_.field += lane, job_.function += lane, job_.frame += lane;
    job_.q += lane, job_.qd += lane, job_.qdd += lane;
    job_.matrix += lane, job_.right += lane, job_.tail += lane, job_.exchange += lane;
    job_.converged += lane, job_.first_size += lane, job_.first_turn += lane, job_.contraction += lane;
    job_.residual += lane, job_.margin += lane;
  }

  static P at(const double* base, int number) { return P::load(base + lane_count * number); }
  static void put(double* base, int number, const P& value) { value.store(base + lane_count * number); }

  static void sincos(const P& angle, P& cosine, P& sine);
  void set_frames();
  Frame<P> frame(int body) const {
    const int k = 5 * body;
    return {at(job_.frame, k), at(job_.frame, k + 1), at(job_.frame, k + 2), at(job_.frame, k + 3),
            at(job_.frame, k + 4)};
  }
  template <class E>
  E element(const LaneElement& e) const {
    E result;
    int k = e.field;
    std::apply([&](const auto&... field) { (load(result, field, k), ...); }, E::fields());
    if constexpr (requires { result.angle; }) result.angle = at(job_.field, k++);
    return result;
  }
  template <class E, class Field>
  void load(E& element, const Field& field, int& k) const {
    if constexpr (requires { field.member; }) {
      auto& member = element.*field.member;
      if constexpr (requires { member.x; }) {
        member = {at(job_.field, k), at(job_.field, k + 1)};
        k += 2;
      } else {
        member = at(job_.field, k++);
      }
    }
  }
  P scale(const LaneElement& e) const { return e.scale < 0 ? P(1) : at(job_.field, e.scale); }
  Taylor<P> value(const LaneElement& e) const {
    if (e.function < 0) return {};
    return {at(job_.function, e.function), at(job_.function, e.function + 1), at(job_.function, e.function + 2)};
  }
  Vec2<double> origin() const { return {code_.origin_x, code_.origin_y}; }
  template <class F>
  void for_each_element(F&& f) const;

  P phi();
  void jacobian();
  void nu();
  void gamma();
  void factor();
  void factor_tail(int tail);
  void solve_right();
  void solve_tail(int tail);
  void correct(const Mask& active, P& size, P& turn);
  void store_rates(double* rates) const;
  void solve();

  LaneJob job_;  // its arrays begin at the lanes of this pack
  LaneCode code_;
  const int* first_of_type_;
  P unit_;
};

template <class V>
void LaneKernel<V>::sincos(const P& angle, P& cosine, P& sine) {
  constexpr double to_integer = 0x1.8p52;
  const P n = (angle * P(0x1.45f306dc9c883p-1) + P(to_integer)) - P(to_integer);
  const P coarse = angle - n * P(0x1.921fb544p+0), r = coarse - n * P(0x1.0b4611a6p-34);
  const P tail = ((coarse - r) - n * P(0x1.0b4611a6p-34)) - n * P(0x1.3198a2e037073p-69);
  const P z = r * r;
  const auto series = [&](double a, double b, double c, double d, double e, double f) {
    return P(a) + z * (P(b) + z * (P(c) + z * (P(d) + z * (P(e) + z * P(f)))));
  };
  const P s = series(-1.66666666666666324348e-01, 8.33333333332248946124e-03, -1.98412698298579493134e-04,
                     2.75573137070700676789e-06, -2.50507602534068634195e-08, 1.58969099521155010221e-10);
  const P c = series(4.16666666666666019037e-02, -1.38888888888741095749e-03, 2.48015872894767294178e-05,
                     -2.75573143513906633035e-07, 2.08757232129817482790e-09, -1.13596475577881948265e-11);
  const P half = P(0.5) * z, head = P(1) - half;
  const P sin_r = r + (r * z * s + tail * head);
  const P cos_r = head + (((P(1) - head) - half) + (z * z * c - r * tail));
  // n modulo 4 without integers: odd quarters exchange the two.
  const P quarter = n - P(4) * ((n * P(0.25) + P(to_integer)) - P(to_integer));  // -2 ... 2
  const P odd = abs(abs(quarter) - P(1));                                        // 0 for odd quarters, else 1
  const Mask exchanged = odd < P(0.5);
  const P a = select(exchanged, cos_r, sin_r), b = select(exchanged, sin_r, cos_r);
  sine = select(abs(quarter) > P(1.5), -a, select(quarter < P(-0.5), -a, a));
  cosine = select(abs(quarter) > P(1.5), -b, select(quarter > P(0.5), -b, b));
}

template <class V>
void LaneKernel<V>::set_frames() {
  for (int b = 0; b < code_.moving; ++b) {
    const P angle = at(job_.q, 3 * b + 2);
    P c, s;
    sincos(angle, c, s);
    put(job_.frame, 5 * b, at(job_.q, 3 * b));
    put(job_.frame, 5 * b + 1, at(job_.q, 3 * b + 1));
    put(job_.frame, 5 * b + 2, angle);
    put(job_.frame, 5 * b + 3, c);
    put(job_.frame, 5 * b + 4, s);
  }
}

// Calls f(element type, element) for all elements, type after type.
template <class V>
template <class F>
void LaneKernel<V>::for_each_element(F&& f) const {
  int type = 0;
  const auto visit = [&]<class E>() {
    for (int k = first_of_type_[type]; k < first_of_type_[type + 1]; ++k) f.template operator()<E>(code_.element[k]);
    ++type;
  };
#define CATENA_LANE_VISIT(Type) visit.template operator()<Type<P>>();
  CATENA_LANE_ELEMENTS(CATENA_LANE_VISIT)
#undef CATENA_LANE_VISIT
}

// The residuals into the right-hand side; returns their largest, rad or length scales.
template <class V>
typename LaneKernel<V>::P LaneKernel<V>::phi() {
  P largest(0);
  for_each_element([&]<class E>(const LaneElement& e) {
    const Frame<P> i = frame(e.body_i), j = E::bodies == 2 ? frame(e.body_j) : Frame<P>{};
    P rows[E::rows];
    element<E>(e).phi(Arguments<P>{i, j, value(e).f, origin()}, rows);
    for (int r = 0; r < E::rows; ++r) {
      if constexpr (HasSquaredValue<E>) rows[r] = rows[r] * scale(e);
      put(job_.right, e.row + r, rows[r]);
      const P size = abs(rows[r]) * (row_unit<E>(r) == UnitKind::angle ? P(1) : unit_);
      largest = select(size <= largest, largest, size);
    }
  });
  return largest;
}

template <class V>
void LaneKernel<V>::jacobian() {
  for (int k = 0; k < code_.slots; ++k) put(job_.matrix, k, P(code_.initial[k]));
  for_each_element([&]<class E>(const LaneElement& e) {
    constexpr int varying = varying_entries<E>();
    const int* slot = code_.slot + e.slot;
    const auto store = [&](int k, const P& entry) { put(job_.matrix, slot[k], entry); };
    if constexpr (varying == 0) {
      return;
    } else if constexpr (std::is_same_v<E, Revolute<P>>) {
      const E pin = element<E>(e);
      const Vec2<P> arm_i = frame(e.body_i).axis(pin.s_i), arm_j = frame(e.body_j).axis(pin.s_j);
      store(0, arm_i.y);
      store(1, -arm_j.y);
      store(2, -arm_i.x);
      store(3, arm_j.x);
    } else {
      constexpr int columns = 3 * E::bodies;
      using D = Dual<P, columns>;
      constexpr auto pattern = jacobian_pattern<E>();
      const Frame<D> i = seed<P, columns>(frame(e.body_i), 0);
      Frame<D> j;
      if constexpr (E::bodies == 2) j = seed<P, columns>(frame(e.body_j), 3);
      D rows[E::rows];
      element<E>(e).phi(Arguments<D>{i, j, D(value(e).f), origin()}, rows);
      int k = 0;
      for (std::size_t n = 0; n < pattern.size(); ++n) {
        if (pattern[n] != Entry::varying) continue;
        P entry = rows[n / columns].d[n % columns];
        if constexpr (HasSquaredValue<E>) entry = entry * scale(e);
        store(k++, entry);
      }
    }
  });
}

template <class V>
void LaneKernel<V>::nu() {
  for (int r = 0; r < code_.rows; ++r) put(job_.right, r, P(0));
  for_each_element([&]<class E>(const LaneElement& e) {
    if constexpr (E::functions > 0) {
      if (!e.timed) return;
      const P zero(0);
      const auto i = moving(frame(e.body_i), zero, zero, zero);
      auto j = i;
      if constexpr (E::bodies == 2) j = moving(frame(e.body_j), zero, zero, zero);
      Taylor<P> rows[E::rows];
      element<E>(e).phi(Arguments<Taylor<P>>{i, j, value(e), origin()}, rows);
      for (int r = 0; r < E::rows; ++r) put(job_.right, e.row + r, -(scale(e) * rows[r].d));
    }
  });
}

template <class V>
void LaneKernel<V>::gamma() {
  const auto moved = [&](int body) {
    const P zero(0);
    if (body >= code_.moving) return moving(frame(body), zero, zero, zero);
    return moving(frame(body), at(job_.qd, 3 * body), at(job_.qd, 3 * body + 1), at(job_.qd, 3 * body + 2));
  };
  const auto turning = [&](int body) {
    const P omega = body < code_.moving ? at(job_.qd, 3 * body + 2) : P(0);
    return omega * omega;
  };
  for_each_element([&]<class E>(const LaneElement& e) {
    if constexpr (std::is_same_v<E, Revolute<P>>) {
      const E pin = element<E>(e);
      const Vec2<P> g =
          turning(e.body_j) * frame(e.body_j).axis(pin.s_j) - turning(e.body_i) * frame(e.body_i).axis(pin.s_i);
      put(job_.right, e.row, g.x);
      put(job_.right, e.row + 1, g.y);
    } else {
      const auto i = moved(e.body_i);
      auto j = i;
      if constexpr (E::bodies == 2) j = moved(e.body_j);
      Taylor<P> rows[E::rows];
      element<E>(e).phi(Arguments<Taylor<P>>{i, j, value(e), origin()}, rows);
      for (int r = 0; r < E::rows; ++r) put(job_.right, e.row + r, -(scale(e) * rows[r].dd));
    }
  });
}

template <class V>
void LaneKernel<V>::factor() {
  for (int b = 0; b < code_.blocks; ++b) {
    const LaneBlock& block = code_.block[b];
    for (int p = block.first_pivot; p < block.first_pivot + block.pivots; ++p) {
      const LanePivot& pivot = code_.pivot[p];
      const int *below = code_.list + pivot.list, *right = below + 2 * pivot.below, *target = right + 2 * pivot.right;
      for (int i = 0; i < pivot.below; ++i) {
        const P multiplier = at(job_.matrix, below[2 * i]) * P(pivot.inverse);
        put(job_.matrix, below[2 * i], multiplier);
        for (int j = 0; j < pivot.right; ++j, ++target)
          put(job_.matrix, *target, at(job_.matrix, *target) - multiplier * at(job_.matrix, right[2 * j]));
      }
    }
    if (block.tail >= 0) factor_tail(block.tail);
  }
}

// L and U of the tail, rows exchanged; an exchange is 1 in the lanes that make it. On the diagonal stands 1 / U.
template <class V>
void LaneKernel<V>::factor_tail(int number) {
  const LaneTail& tail = code_.tail[number];
  const int n = tail.size, base = number * largest_tail * largest_tail;
  P a[largest_tail][largest_tail];
  for (int r = 0; r < n; ++r)
    for (int c = 0; c < n; ++c) a[r][c] = at(job_.matrix, tail.slot[n * r + c]);
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
  put(job_.margin, number, determinant);
}

// Phi_q x = right; x of the unknown whose pivot stands in a row takes the place of that row.
template <class V>
void LaneKernel<V>::solve_right() {
  double* const w = job_.right;
  const auto subtract = [&](int target, int slot, int source) {
    put(w, target, at(w, target) - at(job_.matrix, slot) * at(w, source));
  };
  for (int b = code_.blocks; b-- > 0;) {
    const LaneBlock& block = code_.block[b];
    const LanePivot* const first = code_.pivot + block.first_pivot;
    for (const LanePivot* pivot = first; pivot < first + block.pivots; ++pivot) {
      const int* below = code_.list + pivot->list;
      for (int i = 0; i < pivot->below; ++i, below += 2) subtract(below[1], below[0], pivot->row);
    }
    if (block.tail >= 0) solve_tail(block.tail);
    for (const LanePivot* pivot = first + block.pivots; pivot-- > first;) {
      const int* right = code_.list + pivot->list + 2 * pivot->below;
      P sum = at(w, pivot->row);
      for (int j = 0; j < pivot->right; ++j, right += 2) sum = sum - at(job_.matrix, right[0]) * at(w, right[1]);
      put(w, pivot->row, sum * P(pivot->inverse));
    }
    const int* outside = code_.outside + block.first_outside;
    for (int k = 0; k < block.outside; ++k, outside += 3) subtract(outside[1], outside[0], outside[2]);
  }
}

template <class V>
void LaneKernel<V>::solve_tail(int number) {
  const LaneTail& tail = code_.tail[number];
  const int n = tail.size, base = number * largest_tail * largest_tail;
  P x[largest_tail];
  for (int r = 0; r < n; ++r) x[r] = at(job_.right, tail.row[r]);
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
    put(job_.right, tail.row[r], x[r]);
  }
}

// q -= the solution, in the lanes that are not done; its size, and its largest angle.
template <class V>
void LaneKernel<V>::correct(const Mask& active, P& size, P& turn) {
  size = turn = P(0);
  for (int r = 0; r < code_.rows; ++r) {
    const int k = code_.coordinate[r];
    const P step = at(job_.right, r), old = at(job_.q, k);
    put(job_.q, k, select(active, old - step, old));
    P length = abs(step);
    if (k % 3 == 2)
      turn = select(length <= turn, turn, length);
    else
      length = length * unit_;
    size = select(length <= size, size, length);
  }
}

template <class V>
void LaneKernel<V>::store_rates(double* rates) const {
  for (int r = 0; r < code_.rows; ++r) put(rates, code_.coordinate[r], at(job_.right, r));
}

template <class V>
void LaneKernel<V>::solve() {
  const P none(0);
  P gap(0), last(0), contraction(0);
  Mask active = none < P(1);
  bool factored = false;
  for (int iteration = 0; iteration < most_iterations && xsimd::any(active); ++iteration) {
    set_frames();
    phi();
    if (!factored) {
      jacobian();
      factor();
      gap = P(0);
      factored = true;
    }
    solve_right();
    P size, turn;
    correct(active, size, turn);
    if (iteration == 0) {
      put(job_.first_size, 0, size);
      put(job_.first_turn, 0, turn);
    } else {
      const P ratio = select(active && size > P(rounding_floor), size / last, P(0));
      contraction = select(ratio <= contraction, contraction, ratio);
    }
    gap = gap + size;
    last = size;
    // What is left after it; a lane that is not a number never comes to an end.
    active = active && !(gap * size <= P(negligible) || size <= P(negligible));
    factored = !xsimd::any(active && (gap > P(keep_distance) || contraction > P(poor_contraction)));
  }
  set_frames();
  const P residual = phi();
  Mask good = !active && residual <= P(job_.tolerance);
  for (int b = 0; b < code_.moving; ++b) good = good && abs(at(job_.q, 3 * b + 2)) <= P(largest_angle);
  put(job_.converged, 0, select(good, P(1), P(0)));
  put(job_.contraction, 0, contraction);
  put(job_.residual, 0, residual);
  jacobian();
  factor();
  if (!job_.velocity && !job_.acceleration) return;
  nu();
  solve_right();
  store_rates(job_.qd);
  if (!job_.acceleration) return;
  gamma();
  solve_right();
  store_rates(job_.qdd);
}

template <class V>
void LaneKernel<V>::foretell(const LaneForetelling& f) {
  for (int lane = 0; lane < lane_count; lane += P::size) {
    const auto at = [&](const double* base, int k) { return P::load(base + lane_count * k + lane); };
    const P u = at(f.u, 0), h = at(f.h, 0), v = P(1) - u, u2 = u * u, u3 = u2 * u, v2 = v * v, v3 = v2 * v;
    const P a0 = v3 * (P(1) + u * (P(3) + P(6) * u)), b0 = h * u * v3 * (P(1) + P(3) * u);
    const P c0 = P(0.5) * h * h * u2 * v3;
    const P a1 = u3 * (P(1) + v * (P(3) + P(6) * v)), b1 = -(h * v * u3 * (P(1) + P(3) * v));
    const P c1 = P(0.5) * h * h * v2 * u3;
    for (int k = 0; k < f.numbers; ++k) {
      const P q = (a0 * at(f.q0, k) + a1 * at(f.q1, k)) + (b0 * at(f.qd0, k) + b1 * at(f.qd1, k)) +
                  (c0 * at(f.qdd0, k) + c1 * at(f.qdd1, k));
      q.store(f.q + lane_count * k + lane);
    }
  }
}

/// The kernels in packs V: of the instruction set that the including file is compiled for.
template <class V>
constexpr LaneKernels make_lane_kernels(const char* name) {
  return {name, LaneKernel<V>::solve, LaneKernel<V>::foretell};
}

}  // namespace catena
