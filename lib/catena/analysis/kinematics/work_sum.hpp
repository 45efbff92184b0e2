// The work of drivers and loads along a driven motion, summed up stretch by stretch.
//
//   W(t) = integral of -lambda nu (drivers), of the loads' power, and of what dampers dissipate
//
// by Gauss's rule of four points (order 8), which evaluates no power at the ends of a stretch, where one may jump. The
// error of all integrals together is known: it is the energy that the sums do not account for,
//
//   gap = T + V - (T0 + V0) - supplied + dissipated
//
// What a law does wrong in a sum, drivers do as well, and the gap stays: the integrals of loads and dampers are judged
// by themselves, too (course/power_samples.hpp). Stretches are shortened until the change of the gap in each of them,
// the error of those integrals, and the part of a power that four points do not resolve, are below 1e-10 of the energy
// exchanged; and where a law may switch from one branch to another, to 1/256 at least. Units: J, W, s. Nothing
// allocates after the first stretch.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/kinematics/course/power_samples.hpp"
#include "catena/analysis/motion/energy_account.hpp"
#include "catena/columns/snapshot.hpp"

namespace catena {

class WorkSum {
 public:
  /// Gauss-Legendre: places of the points in [0, 1].
  static constexpr std::array<double, 4> places = {0.069431844202973712, 0.33000947820757187, 0.66999052179242813,
                                                   0.93056815579702629};

  /// All sums are zero, and stretches as long as they may be.
  void begin(const Evaluator& evaluator);
  /// The energy where the sums begin, from a snapshot with velocities.
  void take_initial_energy(const Snapshot& start);
  void end() { account_.reset(); }
  bool is_on() const { return account_.has_value(); }

  /// Length, s, of a stretch of at most `limit` in which no body moves too far, at this speed and rate of change of the
  /// speed (rad or length scales per s, s^2).
  double stretch_length(double limit, double speed, double gain) const;
  /// Begins a stretch at this snapshot: from here on it can be taken back.
  void begin_stretch(const Snapshot& start);
  /// Looks at the powers at an end of the stretch, `first` the one where it begins: where the evaluator is, at the side
  /// of the instant that lies in the stretch.
  void see_end(bool first, std::span<const double> qd);
  /// Adds the powers at the point of this number in a stretch of the length `span` (s, negative backwards in time);
  /// `lost`: by friction.
  void add_point(std::size_t point, double span, std::span<const double> qd, std::span<const double> lambda,
                 double lost);
  /// At a place of the stretch, 0 and 5 its ends; see PowerSamples.
  std::vector<Vec2<double>>& pressing(std::size_t place) { return samples_.pressing(place); }
  double turning_power() const { return samples_.turning_power(); }
  /// Estimate of the error, J, of the stretch that ends with this snapshot.
  double stretch_error(double span, const Snapshot& end) const;
  /// Whether a law may switch in the stretch, which is longer than such stretches may be.
  bool skips_switches() const;
  /// The error, J, above which a stretch that ends with this snapshot is repeated in shorter ones.
  double allowed_error(const Snapshot& end) const;
  bool can_be_shorter() const;
  /// Takes the stretch back; the next ones are a quarter as long.
  void take_back();
  /// Keeps the stretch, with its error and the one that was allowed.
  void keep(double error, double allowed);

  /// Scatters the work of drivers to the elements.
  void update_driver_work() { account_->driver_work(work_, driver_work_); }
  /// Gives the sums to a row.
  void show(Snapshot& row) const;
  /// The same where they are not known: NaN.
  void show_unknown(Snapshot& row, std::size_t elements);
  /// The warning about their accuracy, if one is due.
  std::string doubt() const;

 private:
  double gap(const Snapshot& now) const;
  double energy_scale(const Snapshot& now) const;

  std::optional<EnergyAccount> account_;  // while work is summed up
  const Evaluator* evaluator_ = nullptr;
  PowerSamples samples_;
  std::vector<double> work_, power_, cubic_part_, driver_work_, work_before_;
  double initial_energy_ = 0;
  double exchanged_ = 0, exchanged_before_ = 0;
  double unsure_ = 0;                          // sum of the errors above the allowed ones
  double gap_before_ = 0, largest_power_ = 0;  // of the present stretch
  double part_ = 1;                            // stretches are this part of the longest allowed
};

}  // namespace catena
