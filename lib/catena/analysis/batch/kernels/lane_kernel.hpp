// The kernels of a batch for one instruction set: what lane_code.hpp describes, in packs. Included by the file of each
// instruction set alone, which is compiled for it.
//
// A correction is taken with the factors at hand while the configuration is so near to where they were made that it
// leaves less than a hundredth of the error; a lane is done when the next correction would be rounding. Velocities and
// accelerations are solved for with factors of the last configuration. Angles beyond 1e5 rad are not reduced
// (lane_pack.hpp): such lanes do not converge.
#pragma once

#include <limits>

#include "catena/analysis/batch/kernels/lane_loads.hpp"
#include "catena/analysis/batch/kernels/lane_twin.hpp"

namespace catena {

template <class V>
class LaneKernel : LaneLoads<V> {
 public:
  // Everything in one function: what is stored in packs might be any memory for all that the compiler knows, but not
  // the members of an object that never leaves its function.
  [[gnu::flatten]] static void solve(const LaneJob& job, int lane) {
    LaneKernel kernel(job, lane);
    kernel.solve();
  }
  [[gnu::flatten]] static void find_loads(const LaneJob& job, int lane) {
    LaneKernel kernel(job, lane);
    kernel.Base::find_loads();
  }
  [[gnu::flatten]] static bool foretell(const LaneForetelling& f);
  [[gnu::flatten]] static bool judge(const LaneJudgement& j);
  [[gnu::flatten]] static bool watch(const LaneWatch& w);

 private:
  using Base = LaneLoads<V>;
  using Base::at;
  using Base::code_;
  using Base::job_;
  using Base::put;
  using Base::unit_;
  using typename Base::Mask;
  using typename Base::P;
  // As many as kinematics/course/step_rules.hpp allows one motion.
  static constexpr int most_iterations = 25;
  // In length scales or rad, as in kinematics/driven_solver.cpp: a correction below `negligible` is not computed; one
  // below `rounding_floor` need not shrink any more.
  static constexpr double negligible = 1e-15, rounding_floor = 1e-12;
  // Factors from further away than this, or that leave more than this of a correction, are made anew.
  static constexpr double keep_distance = 1e-3, poor_contraction = 0.1;
  static constexpr double largest_angle = 1e5;

  LaneKernel(const LaneJob& job, int lane) : Base(job, lane) {}

  void correct(const Mask& active, P& size, P& turn);
  void solve();
};

// q -= the solution, in the lanes that are not done; its size, and its largest angle.
template <class V>
void LaneKernel<V>::correct(const Mask& active, P& size, P& turn) {
  const LaneUnknown* u = code_.unknown;
  const auto largest_step = [&](const LaneUnknown* end) {
    P largest(0);
    for (; u != end; ++u) {
      const P step = P::load(job_.right + u->place), old = P::load(job_.q + u->coordinate);
      select(active, old - step, old).store(job_.q + u->coordinate);
      largest = larger(largest, abs(step));
    }
    return largest;
  };
  const P length = largest_step(code_.unknown + code_.lengths) * unit_;
  turn = largest_step(code_.unknown + code_.rows);
  size = larger(length, turn);
}

template <class V>
void LaneKernel<V>::solve() {
  const P none(0);
  P gap(0), last(0), contraction(0), residual(0);
  Mask active = none < P(1);
  bool factored = false, near = false;
  for (int iteration = 0;; ++iteration) {
    near ? this->turn_frames() : this->set_frames();
    const bool is_last = iteration == most_iterations || !any(active);
    if (factored && !is_last) {
      this->template equations<false>();
    } else {
      residual = this->template equations<true>();
      this->factor();
      gap = P(0);
      factored = true;
    }
    if (is_last) break;
    this->solve_right();
    P size, turn;
    correct(active, size, turn);
    if (iteration == 0) {
      put(job_.found.first_size, 0, size);
      put(job_.found.first_turn, 0, turn);
    } else {
      const P ratio = select(active && size > P(rounding_floor), size / last, P(0));
      contraction = select(ratio <= contraction, contraction, ratio);
    }
    near = all(turn <= P(Base::small_turn));
    gap = gap + size;
    last = size;
    // What is left after it; a lane that is not a number never comes to an end.
    active = active && !(gap * size <= P(negligible) || size <= P(negligible));
    factored = !any(active && (gap > P(keep_distance) || contraction > P(poor_contraction)));
  }
  Mask good = !active && residual <= P(job_.tolerance);
  P lengths(0);  // not a number where one of them is not
  for (int b = 0; b < code_.moving; ++b) {
    lengths = lengths + (abs(at(job_.q, 3 * b)) + abs(at(job_.q, 3 * b + 1)));
    good = good && abs(at(job_.q, 3 * b + 2)) <= P(largest_angle);
    put(job_.turned, 2 * b, at(job_.frame, 5 * b + 3));
    put(job_.turned, 2 * b + 1, at(job_.frame, 5 * b + 4));
  }
  good = good && lengths <= P(std::numeric_limits<double>::max());
  put(job_.found.converged, 0, select(good, P(1), P(0)));
  put(job_.found.contraction, 0, contraction);
  put(job_.found.residual, 0, residual);
  if (!job_.velocity && !job_.acceleration) return;
  this->nu();
  this->solve_right();
  this->store_unknowns(job_.qd);
  if (!job_.acceleration) return;
  this->gamma();
  this->solve_right();
  this->store_unknowns(job_.qdd);
}

template <class V>
bool LaneKernel<V>::foretell(const LaneForetelling& f) {
  bool is_any = false;
  for (int lane = 0; lane < lane_count; lane += P::size) {
    const auto at = [&](const double* base, int k) { return P::load(base + lane_count * k + lane); };
    const P distance = at(f.t1, 0) - at(f.t0, 0);
    const Mask apart = abs(distance) > P(0);
    const P h = select(apart, distance, P(1)), u = select(apart, (at(f.t, 0) - at(f.t0, 0)) / h, P(1));
    const P v = P(1) - u, u2 = u * u, u3 = u2 * u, v2 = v * v, v3 = v2 * v;
    const P a0 = v3 * (P(1) + u * (P(3) + P(6) * u)), b0 = h * u * v3 * (P(1) + P(3) * u);
    const P c0 = P(0.5) * h * h * u2 * v3;
    const P a1 = u3 * (P(1) + v * (P(3) + P(6) * v)), b1 = -(h * v * u3 * (P(1) + P(3) * v));
    const P c1 = P(0.5) * h * h * v2 * u3;
    for (int k = 0; k < f.numbers; ++k) {
      const P q = (a0 * at(f.q0, k) + a1 * at(f.q1, k)) + (b0 * at(f.qd0, k) + b1 * at(f.qd1, k)) +
                  (c0 * at(f.qdd0, k) + c1 * at(f.qdd1, k));
      q.store(f.q + lane_count * k + lane);
    }
    Mask falls = P(0) > P(1);
    for (int k = 0; k < f.tails; ++k) {
      const P here = abs(at(f.margin1, k)), before = abs(at(f.margin0, k));
      falls = falls || here - v * (here - before) < P(f.remaining_part) * here;
    }
    select(falls, P(1), P(0)).store(f.falls + lane);
    is_any = is_any || any(falls);
  }
  return is_any;
}

template <class V>
bool LaneKernel<V>::judge(const LaneJudgement& j) {
  bool are_all = true;
  for (int lane = 0; lane < lane_count; lane += P::size) {
    const auto at = [&](const double* base, int k) { return P::load(base + lane_count * k + lane); };
    Mask sound = at(j.converged, 0) > P(0.5) && at(j.first_turn, 0) <= P(j.largest_turn) &&
                 at(j.contraction, 0) <= P(j.largest_contraction);
    for (int k = 2; k < j.numbers; k += 3) sound = sound && abs(at(j.q, k) - at(j.q0, k)) <= P(j.longest_step);
    for (int k = 0; k < j.tails; ++k) {
      const P here = at(j.margin0, k), there = at(j.margin, k);
      sound = sound && here * there > P(0) && abs(there) >= P(j.sudden_part) * abs(here);
    }
    select(sound, P(1), P(0)).store(j.sound + lane);
    are_all = are_all && all(sound);
  }
  return are_all;
}

template <class V>
bool LaneKernel<V>::watch(const LaneWatch& w) {
  bool is_any = false;
  for (int lane = 0; lane < lane_count; lane += P::size) {
    Mask near = P(0) > P(1);
    for (int k = 0; k < w.tails; ++k) {
      const P margin = abs(P::load(w.margin + lane_count * k + lane));
      double* const kept = w.largest + lane_count * k + lane;
      const P before = P::load(kept), largest = select(margin > before, margin, before);
      largest.store(kept);
      near = near || !(margin > P(w.least_part) * select(largest < P(1), largest, P(1)));
    }
    select(near, P(1), P(0)).store(w.near + lane);
    is_any = is_any || any(near);
  }
  return is_any;
}

/// Calls f(kernels, lane) for the packs in use: twins, and a single one where that holds the lanes that are left.
template <class V, class F>
void for_each_pack(const LaneJob& job, F&& f) {
  int lane = 0;
  for (; job.lanes - lane > static_cast<int>(V::size); lane += static_cast<int>(Twin<V>::size))
    f.template operator()<LaneKernel<Twin<V>>>(lane);
  if (lane < job.lanes) f.template operator()<LaneKernel<V>>(lane);
}

/// The kernels in packs V: of the instruction set that the including file is compiled for.
template <class V>
constexpr LaneKernels make_lane_kernels(const char* name, const LaneStaticKernels& statics) {
  return {name,
          [](LaneJob& job) { for_each_pack<V>(job, [&]<class K>(int lane) { K::solve(job, lane); }); },
          [](LaneJob& job) { for_each_pack<V>(job, [&]<class K>(int lane) { K::find_loads(job, lane); }); },
          LaneKernel<V>::foretell,
          LaneKernel<V>::judge,
          LaneKernel<V>::watch,
          &statics};
}

}  // namespace catena
