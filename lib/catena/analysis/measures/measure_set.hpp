// The measures of one analysis at work: they look at its rows and at the motion between them, and give values, instants
// and gradients at the end.
//
// Analyses in time show stretches of their motion (cover()); others give rows alone (take_row()). With derivatives of
// columns at hand, a measure's gradient is
//
//   extremes          that of the column at the fixed instant (at an end of the run as well); a tie of two instants
//                     whose gradients differ has none
//   integrals         sum of weights x gradients at the nodes        mean, rms       from these
//   paths             of each point the nearest instant is fixed     first, final, at
//
// Pieces end at breakpoints of functions of time, and where the motion goes on in another way by itself. Where these
// jump at an instant t* that parameters move, an integral of v has the part (v(t*-) - v(t*+)) dt*/dp besides, and what
// is largest, or nearest, at t* itself moves with it (motion_samples.hpp). Where the run ends at T, or a measure is
// taken at an instant, that moves:
//
//   dm/dp = (dm/dp) at fixed instants + (dm/dT) dT/dp
//
// Where T is itself an instant at which functions jump the two must move together; else m has no derivative if its
// column jumps there. Points P_k of a path that move add -((x, y) - P_k) . dP_k/dp / (n m).
//
// Without derivatives of columns at hand a measure says what it is made of (pulses()), dm = sum weight x d(column at
// t), and is given the gradient at fixed instants that someone else finds: one way back for any number of parameters.
//
// What a run could not be looked at for (between rows of a motion of least norm) is taken from its rows, and `trouble`
// says so; integrals over time have no value there. Neither has a measure that is not a number.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "catena/analysis/measures/extreme.hpp"
#include "catena/analysis/measures/measure.hpp"
#include "catena/analysis/run/breakpoints.hpp"

namespace catena {

/// How the given points of a path move with a parameter: coordinate `axis` (0: x) of point number `point`.
struct MovingPoint {
  std::size_t point, axis, parameter;
  double rate;
};

/// How the instants of a run, and points that measures are given, move with the parameters: dt/dp by parameter.
struct MovingInstants {
  std::vector<double> last;                ///< of the end of the run; empty: it stands still
  std::vector<std::vector<double>> taken;  ///< of the instant at which measure k, kind `at`, is taken; empty, the same
  std::vector<std::vector<MovingPoint>> points;  ///< of measure k, kind `path`
  std::string why_unknown;                       ///< where a rate is not a number: why
};

/// What a measure changes by with one of the set's columns at an instant; or with the instant itself, if the motion
/// goes on in another way there and the instant moves.
struct ColumnPulse {
  static constexpr auto by_instant = static_cast<std::size_t>(-1);
  double t;
  std::size_t column;  ///< or by_instant
  double weight;
};

class MeasureSet {
 public:
  /// Measures of the kind `field` are passed over. Throws ColumnError, and std::invalid_argument for a measure whose
  /// column the analysis cannot give, or that is none in a plan without time. `run`: the first and the last instant.
  MeasureSet(std::vector<MeasureRequest> requests, const Model& model, const Plan& plan, const ColumnSources& sources,
             const TimeRange& run);
  ~MeasureSet();

  bool empty() const { return requests_.empty(); }
  const ColumnSet& columns() const { return *columns_; }
  const Needs& needs() const { return columns_->needs(); }
  /// Gradients by so many parameters are wanted, from derivatives of columns(); before anything is taken. `may_end`:
  /// the run may end anywhere. `instants_move`: with the parameters, those at which measures look.
  void differentiate(int parameters, DifferentiateColumns derivatives, bool may_end = false,
                     bool instants_move = false);
  /// Columns are known to this part of their size, if that is worse than rounding: extremes that differ by less may be
  /// one or the other.
  void know_accuracy(double part);
  /// After differentiate(): derivatives of columns are not at hand, pulses() are asked for instead. Columns are asked
  /// at every instant that may have one.
  void give_pulses();

  /// Columns of stretches, and of rows that are given by their instants, are computed by `values`, without snapshots.
  void use_values(MotionSamples::Values values);
  /// The same measures of another design: with other numbers, of a model of the
  /// same structure.
  void begin_again(std::vector<MeasureRequest> requests, const Model& model, const TimeRange& run);

  /// A stretch of the motion, one after the other.
  void cover(const MotionStretch& stretch);
  /// How long the next stretch may be where rows do not bound it, s.
  double pace() const;
  /// A row; `only_rows`: there are no stretches.
  void take_row(const Snapshot& snapshot, bool only_rows);
  /// A row by use_values(); false where it has no columns there.
  bool take_row(double t);

  /// Whether the run ended before its last instant.
  bool ended_early() const { return latest_row_ && *latest_row_ != run_.last; }
  /// Of the measures passed in, those of the kind `field` left out. Without `moving` gradients are those at fixed
  /// instants, of a run that ended early none. `given`: gradients of pulses() at fixed instants, by give_pulses().
  std::vector<MeasureResult> results(const MovingInstants* moving = nullptr,
                                     const std::vector<std::vector<double>>* given = nullptr) const;
  /// Of every measure, as in results(), what it is made of; nothing, and `why` says it, where an extreme is reached at
  /// two instants, which may have different gradients, or the column of a root mean square is zero.
  std::optional<std::vector<std::vector<ColumnPulse>>> pulses(std::string& why) const;

 private:
  class Account;
  void open_accounts(const std::vector<std::array<std::size_t, 2>>& places);
  /// Resolves the columns of measures, and the switches of those that have some.
  void resolve(const Model& model, const Plan& plan, const ColumnSources& sources);
  void note_row(const MotionSample& sample, bool only_rows);
  void cover_piece(const MotionPiece& piece);
  void look_at_end(const MotionPiece& piece);

  /// Where the motion has come to: columns there, from before it, and how fast they change.
  struct End {
    double t = 0;
    MotionSample sample;
    std::vector<double> rate;    ///< by column
    std::vector<double> moving;  ///< dt/dp of the instant, if functions jump there; empty: it stands still
    std::vector<double> change;  ///< of columns, across it
  };

  TimeRange run_;
  std::vector<MeasureRequest> requests_;
  Breakpoints breakpoints_;
  std::unique_ptr<ColumnSet> columns_;
  /// For derivatives: the same and, behind them, where they switch (columns/switches.hpp), which `columns_` has itself
  /// in driven motions; null: nothing does.
  std::unique_ptr<ColumnSet> switched_columns_;
  std::vector<ColumnSwitch> switches_;
  std::unique_ptr<MotionSamples> samples_;
  std::vector<std::unique_ptr<Account>> accounts_;
  int parameters_ = 0;
  std::optional<double> earliest_row_, latest_row_;
  std::optional<End> end_;
  std::optional<double> broken_at_;  // the end of the last stretch behind which the motion goes on in another way
  bool wants_samples_ = false;       // some measure depends on what is between rows
  bool looked_ = true;               // whether every stretch could be looked at
  bool may_end_ = false;
  bool is_driven_ = false;  // its steps are not those of a method, which follow how fast bodies move
};

}  // namespace catena
