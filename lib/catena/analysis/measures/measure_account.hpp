// What one measure has come to so far. Private to measures.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <string_view>

#include "catena/analysis/measures/measure_set.hpp"

namespace catena {

class MeasureSet::Account {
 public:
  /// `column`: place of the measure's first column in the set; a path's second one is `second`.
  Account(const MeasureRequest& request, std::size_t column, std::size_t second, const TimeRange& run)
      : request_(request), column_(column), second_(second), run_(run) {
    const double sign = request.kind == MeasureKind::minimum ? -1 : 1;
    const auto signed_value = [column](double s) { return [=](std::span<const double> v) { return s * v[column]; }; };
    switch (request.kind) {
      case MeasureKind::maximum:
      case MeasureKind::minimum:
        extremes_.emplace_back(signed_value(sign));
        break;
      case MeasureKind::range:
        extremes_.emplace_back(signed_value(1));
        extremes_.emplace_back(signed_value(-1));
        break;
      case MeasureKind::path:
        prepare_path();
        break;
      case MeasureKind::at:
        instants_.push_back({request.at});
        break;
      default:
        break;
    }
  }

  bool is_integral() const {
    return request_.kind == MeasureKind::integral || request_.kind == MeasureKind::mean ||
           request_.kind == MeasureKind::rms;
  }
  void give_pulses() { keeps_nodes_ = true; }
  /// What the value is made of; why not, as the end of a sentence about the measure, where it is made of more.
  std::string_view pulses(const MeasureResult& result, std::vector<ColumnPulse>& out) const;
  /// The gradient that was found of them.
  void take_given(MeasureResult& result, const std::vector<double>& gradient) const;
  /// Whether it depends on what is between rows, single instants apart.
  bool wants_samples() const { return is_integral() || !extremes_.empty(); }

  /// `instants_move`: with the parameters, so that rates are needed there.
  void set_parameters(int parameters, bool instants_move) {
    parameters_ = static_cast<std::size_t>(parameters);
    instants_move_ = instants_move;
  }
  void know_accuracy(double part) {
    for (Extreme& extreme : extremes_) extreme.know_accuracy(part);
  }
  void add(const MotionSamples& samples, const MotionSamples::Part& part, const MotionPiece& piece);
  void look_at_instants(const MotionSamples& samples, const MotionPiece& piece);
  void add_row(const MotionSample& sample, bool only_rows);
  /// `looked`: the motion could be looked at everywhere between its rows.
  MeasureResult result(const ColumnInfo& column, bool looked) const;
  /// The derivative by the last instant, were it another one; not a number where that is not known.
  double by_last_instant(const MeasureResult& result, const End* end) const;
  /// The run ended early, and how its end moves is not known.
  void leave_out_early_end(MeasureResult& result) const;
  /// Puts in what moving instants make of the gradient; `measure`: its number.
  /// `given`: the gradient at fixed instants was not made of samples.
  void move(MeasureResult& result, const End* end, const MovingInstants& moving, std::size_t measure, bool given) const;

 private:
  struct Instant {
    double t;
    std::optional<MotionSample> sample{};
    bool of_row = false;                   // `sample` is a row's, until the motion is looked at there
    std::vector<double> rate{};            // of columns; with derivatives
    std::optional<MotionSample> before{};  // at a moving jump: the limit from before it
    std::vector<double> rate_before{}, moving{};
  };
  void prepare_path();
  void add_jump(const MotionSamples& samples, double t, double before, double after);
  void leave_out_start(const MotionSamples& samples, const MotionPiece& piece);
  bool is_at_end(const Extreme& extreme) const;
  bool ties_with_end(const Extreme& extreme) const;
  bool is_touched_by(const End& end) const;
  void take_out(MeasureResult& result, std::size_t p, const std::string& why) const;
  void move_points(MeasureResult& result, std::span<const MovingPoint> points) const;
  double gradient_of(const MotionSample& sample, std::size_t column, std::size_t p) const {
    return sample.derivative.empty() ? std::numeric_limits<double>::quiet_NaN()
                                     : sample.derivative[column * parameters_ + p];
  }
  /// Notes where the column switches: whether it does so with a jump, and whether its branches stay equal.
  void note_switches(const MotionSamples::Part& part, const MotionPiece& piece);
  bool is_undecided(const MotionSample& sample) const {
    const bool has_second = request_.kind == MeasureKind::path;
    return (sample.undecided & (bit_of_column(column_) | (has_second ? bit_of_column(second_) : 0))) != 0;
  }
  bool is_undecided() const;
  void tell_switches(MeasureResult& result) const;
  void give(MeasureResult& result, const MotionSample& sample) const;
  void path_pulses(double value, std::vector<ColumnPulse>& out) const;
  /// What one column of a sample is made of.
  static void add_pulses(const MotionSample& sample, std::size_t column, double weight, std::vector<ColumnPulse>& out);
  void give_extreme(MeasureResult& result, const Extreme& extreme, double factor) const;
  void give_integral(MeasureResult& result) const;
  void give_rms_gradient(MeasureResult& result, double value) const;
  void give_path(MeasureResult& result) const;
  void check_ties(MeasureResult& result, const Extreme& extreme) const;

  MeasureRequest request_;
  std::size_t column_, second_, parameters_ = 0;
  bool instants_move_ = false;
  TimeRange run_;
  std::vector<Extreme> extremes_;
  std::vector<Instant> instants_;
  std::optional<MotionSample> first_, last_;
  // Integrals of v and v^2 and of their gradients; of rows where there is no time: sums.
  double sum_ = 0, squares_ = 0, duration_ = 0, size_ = 0;                // size_: the largest |v|
  std::vector<double> sum_gradient_, squares_gradient_, squared_slopes_;  // the last: integrals of v_p^2
  std::optional<std::pair<double, double>> before_break_;  // the last breakpoint, and the column just before it
  std::int64_t rows_ = 0;
  struct Node {
    double t, weight, value;
  };
  std::optional<std::pair<double, double>> last_part_;  // where it ended, and the column there
  bool undecided_ = false;                              // somewhere in the integral
  std::optional<double> jumps_at_;                      // an instant at which the column switches with a jump
  bool keeps_nodes_ = false;
  std::vector<Node> nodes_;  // of the integral, if they are kept
  /// An instant that may move with the parameters: what an integral of v, and of v^2, gains with it.
  struct Jump {
    double t, value, square;
  };
  std::vector<Jump> jumps_;  // the same
};

}  // namespace catena
