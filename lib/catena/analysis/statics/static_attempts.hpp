// The list of attempts that a search for an equilibrium makes until one is accepted, each from the start.
//
//   few degrees of freedom and a start that can be assembled nearby   descent from there, else Newton
//   otherwise                                                         Newton
//   it was not accepted                                               Newton from a start displaced a little
//   nor was that one                                                  descent from the start, unless it came first
//   four displaced starts failed, solver "auto"                       Ipopt; then Newton from other starts
//   the last attempt, solver "auto"                                   damped settling (static_settling.hpp)
//
// A chosen Ipopt or NLopt is tried once. Descent and settling do not treat gaps. Displacements are random numbers of
// fixed seeds: the same scene gives the same answer.
#pragma once

#include <optional>
#include <vector>

#include "catena/analysis/balance/static_system.hpp"
#include "catena/analysis/statics/static_result.hpp"

namespace catena {

/// How one attempt looks for an equilibrium.
enum class StaticWay { valley, newton, ipopt, nlopt, settling };

struct StaticAttempt {
  StaticWay way = StaticWay::newton;
  unsigned displacement = 0;  ///< seed of the displaced start; 0: the start itself
};

/// Attempts and pushes away from points that are no minimum, in all.
inline constexpr int most_static_trials = 14;
/// Starts of a solver that fail before another one is used.
inline constexpr unsigned starts_before_ipopt = 4;

class StaticAttempts {
 public:
  StaticAttempts(const StaticSystem& system, const StaticSearchOptions& options);

  /// The first one.
  const StaticAttempt& present() const { return list_[place_]; }
  /// Goes on to the next one before trial number `trial` of most_static_trials; false: there is none.
  bool go_on(int trial);
  /// Whether the present one is descent after other methods had failed.
  bool is_late_descent() const { return place_ > 0 && present().way == StaticWay::valley; }

 private:
  std::vector<StaticAttempt> list_;
  std::size_t place_ = 0;
  bool settles_last_ = false;
};

/// Disturbs every coordinate by a random amount: angles by at most `angle`, rad, places by `place` of that in length
/// scales. Bodies that cannot turn against each other turn together (turning_groups.hpp). The same seed gives the same
/// numbers.
void shake(const StaticSystem& system, std::vector<double>& q, unsigned seed, double angle, double place = 0.1);

/// The start of an attempt from `start`.
std::vector<double> start_of(const StaticAttempt& attempt, const StaticSystem& system,
                             const std::vector<double>& start);

}  // namespace catena
