// The tensions of an elastic rope between its grips (rope_grips.hpp). The rope has no mass: where it slides over a
// pulley it is in balance at every instant, and how much of it has passed follows from that.
//
//   part n, from grip n to grip n + 1:      s_n = y_n T_n                          s_n its stretch, y_n what it yields
//   S_n = s_n + s_n+1 + ...                  S_0 = -u_0                            u_0: L less the way of the whole
//   grip n sticks                            S_n = held - u_n                      nothing passes
//   grip n slides                            T_n = T_n-1 e^(-sigma E)              slip v = u_n' + S_n', sigma v >= 0
//
// Grips that stick divide the rope; between two of them, sum s_n is known and every T_n a multiple of the first. What
// is stored is sum y_n T_n^2 / 2, what is lost -sum (T_n - T_n-1) v_n >= 0. The y_n are those of the start of a motion,
// at which all tensions are alike (Jenkins elements in a row). Where the whole is slack, S_0 <= 0, nothing pulls.
// Units: m, N. Singular where lines are (rope_span.hpp).
#pragma once

#include <span>
#include <vector>

#include "catena/analysis/contact/contact_points.hpp"

namespace catena {

class ElasticGrips {
 public:
  /// `points` must outlive this object.
  ElasticGrips(const std::vector<ContactPoint>& points, std::shared_ptr<const RopePlaces> rope);

  const RopePlaces& rope() const { return *rope_; }
  /// Finds all tensions at the evaluator's configuration.
  void look(const Evaluator& evaluator, std::span<const double> qd, const std::vector<ContactState>& states);

  // Of the last look. Grips are numbered from 0, of part n + 1 on.
  double stretch() const { return -u_[0].f; }
  double tension(std::size_t part) const { return T_[part].f; }
  double friction(std::size_t grip) const { return T_[grip + 1].f - T_[grip].f; }
  double slip(std::size_t grip) const { return u_[grip + 1].d + S_[grip + 1].d; }
  /// What `held` is where the grip sticks from now on.
  double held(std::size_t grip) const { return u_[grip + 1].f + S_[grip + 1].f; }
  double stretch_behind(std::size_t grip) const { return S_[grip + 1].f; }
  double place(std::size_t grip) const { return u_[grip + 1].f; }
  /// What the tensions may still differ by before a grip that sticks slips, N.
  double margin(std::size_t grip) const;
  /// Energy beyond that of one spring, J; power lost, W.
  double energy_at(const Evaluator& evaluator, const std::vector<ContactState>& states) const;
  double dissipation(const std::vector<ContactState>& states) const;
  /// Adds the forces beyond those of one spring to `loads`.
  void add(std::span<double> loads) const;

  /// Changes `states` to grips that stick and slide as velocities ask for.
  void settle(const Evaluator& evaluator, std::span<const double> qd, std::vector<ContactState>& states);

 private:
  struct Rate {
    double f = 0, d = 0;
  };
  bool divides(std::size_t part, const std::vector<ContactState>& states) const;
  void share(std::size_t first, std::size_t end, const std::vector<ContactState>& states);
  bool slips(std::size_t grip) const;

  const std::vector<ContactPoint>& points_;
  std::shared_ptr<const RopePlaces> rope_;
  std::vector<Evaluator::ScalarMotion> motion_;  // of the whole, then of each grip
  std::vector<Rate> u_, S_, T_, exponent_, ratio_;
};

}  // namespace catena
