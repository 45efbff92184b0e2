// PhaseEquations: projections onto constraints, and jumps of velocities.
#include <algorithm>
#include <cmath>

#include "catena/analysis/sensitivity/phases/phase_equations.hpp"
#include "catena/base/at.hpp"

namespace catena {

bool PhaseEquations::project(const Design& design, std::span<const DesignScalar> anchor, std::span<DesignScalar> q,
                             std::span<DesignScalar> qd) {
  DesignMechanism& mechanism = design.mechanism;
  DesignVector bare(q.size());
  for (const bool velocity : {false, true}) {
    const std::span<DesignScalar> part = velocity ? qd : q;
    for (std::size_t c = 0; c < bare.size(); ++c) {
      const bool unknown = c < plan().column.size() && plan().column[c] >= 0;
      bare[c] = velocity || unknown ? DesignScalar(part[c].v) : q[c];
    }
    if (velocity)
      mechanism.set_state(q, bare);
    else
      mechanism.set_state(bare);
    mechanism.rows(rows_);
    for (std::size_t p = 0; p < design.count; ++p) {
      for (std::size_t c = 0; c < f_.size(); ++c)
        f_[c] = c < at(3 * plan().moving) ? mechanism.mass(static_cast<int>(c)).v * part[c].d[p] : 0;
      for (std::size_t r = 0; r < b_.size(); ++r)
        b_[r] = velocity ? -rows_[r].d.d[p] : anchor[r].d[p] - rows_[r].f.d[p];
      if (!system_->solve(f_, b_)) return false;
      for (const int c : plan().coordinate) part[at(c)].d[p] = f_[at(c)];
    }
  }
  return true;
}

int PhaseEquations::row_not_met(std::span<const Taylor<DesignScalar>> rows, std::span<const DesignScalar> anchor,
                                std::span<const DesignScalar> q, std::span<const DesignScalar> qd, std::size_t p,
                                double none, const std::vector<char>& except) const {
  // Of rates: the fastest turn or travel, in 1/s, at least 1.
  double pace = 1, moves = 0, moves_rate = 0;
  for (const DesignScalar& rate : qd) {
    pace = std::max(pace, std::abs(rate.v));
    moves_rate = std::max(moves_rate, std::abs(rate.d[p]));
  }
  for (const DesignScalar& place : q) moves = std::max(moves, std::abs(place.d[p]));
  for (std::size_t r = 0; r < rows.size(); ++r) {
    if (!held_[r] || (!except.empty() && except[r])) continue;
    const double miss = std::abs(rows[r].f.d[p] - anchor[r].d[p]), slip = std::abs(rows[r].d.d[p]);
    const bool is_met = miss <= same_place * moves + none && slip <= same_place * (moves_rate + moves) + none * pace;
    if (!is_met) return static_cast<int>(r);
  }
  return -1;
}

bool PhaseEquations::jump(const Design& design, const VelocityJump& jump, const DesignStrike* strike,
                          std::span<const DesignScalar> target, std::span<const double> instant,
                          std::span<const DesignScalar> q, std::span<DesignScalar> qd) {
  DesignMechanism& mechanism = design.mechanism;
  std::vector<Coupled> coupled;
  for (const ImpactPlace& place : jump.places) {
    if (place.direction != 0)
      coupled.push_back(
          {place.place, slide_row(place.place), design.places[place.place].mu * DesignScalar(place.direction)});
  }
  DesignVector blow(f_.size());
  mechanism.set_state(q);
  const int struck = strike ? plan().plan_body[at(strike->body)] : -1;
  if (struck >= 0 && struck < plan().moving) {
    const Vec2<DesignScalar> arm = mechanism.ground_frame(struck).axis(strike->point);
    blow[at(3 * struck)] = strike->impulse.x;
    blow[at(3 * struck + 1)] = strike->impulse.y;
    blow[at(3 * struck + 2)] = cross(arm, strike->impulse);
  }
  mechanism.rows(rows_);
  std::vector<double> by_time(b_.size());  // nu_t, with the other sign
  for (std::size_t r = 0; r < b_.size(); ++r) {
    by_time[r] = rows_[r].dd.v;
    b_[r] = target[r].v - rows_[r].d.v;
  }
  for (std::size_t c = 0; c < f_.size(); ++c)
    f_[c] = c < at(3 * plan().moving) ? mechanism.mass(static_cast<int>(c)).v * qd[c].v + blow[c].v : 0;
  if (!solve_values(design, coupled)) return false;
  DesignVector after(qd.size());
  DesignVector& impulse = impulse_;
  for (const int c : plan().coordinate) after[at(c)] = DesignScalar(f_[at(c)]);
  for (std::size_t r = 0; r < b_.size(); ++r) impulse[r] = DesignScalar(b_[r]);
  for (std::size_t l = 0; l < coupled.size(); ++l) impulse[at(coupled[l].slide_row)] = DesignScalar(-sizes_[l]);
  mechanism.set_state(q, after);
  mechanism.rows(rows_);
  for (std::size_t c = 0; c < loads_.size(); ++c) {
    loads_[c] = -blow[c];
    if (c < at(3 * plan().moving)) loads_[c] += mechanism.mass(static_cast<int>(c)) * (after[c] - qd[c]);
  }
  mechanism.add_constraint_loads(impulse, loads_);
  for (std::size_t p = 0; p < design.count; ++p) {
    for (std::size_t c = 0; c < f_.size(); ++c) f_[c] = -loads_[c].d[p];
    for (std::size_t r = 0; r < b_.size(); ++r) b_[r] = target[r].d[p] - rows_[r].d.d[p] - by_time[r] * instant[p];
    if (!system_->solve(f_, b_)) return false;
    for (const int c : plan().coordinate) after[at(c)].d[p] = f_[at(c)];
    for (std::size_t r = 0; r < b_.size(); ++r) {
      if (held_[r]) impulse[r].d[p] = b_[r];
    }
  }
  add_slopes(design, coupled, after, impulse);
  for (const int c : plan().coordinate) qd[at(c)] = after[at(c)];
  return true;
}

}  // namespace catena
