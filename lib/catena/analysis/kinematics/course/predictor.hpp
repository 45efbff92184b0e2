// Predicts the coordinates of the next instant from earlier ones: the start of a Newton iteration.
//
//   q, qd, qdd known at the last two instants   quintic Hermite extrapolation, error of order h^6
//   q, qd known                                 cubic Hermite, h^4
//   q known                                     polynomial through up to four instants, h^4, or through six, h^6
//
// The derivatives of the same polynomial predict qd and qdd, so that one refinement each suffices there too. The
// weights are scalars computed once a step; the vectors are combined in one pass. Six instants are used where the terms
// of the polynomial, in Newton's form, shrink: at steps that are long for the motion the higher orders predict worse.
// Never singular: pushing the same time twice replaces the last entry, and of instants that are much nearer to each
// other than to t the later one counts alone.
#pragma once

#include <span>
#include <vector>

namespace catena {

class Predictor {
 public:
  explicit Predictor(std::size_t size);

  /// Clears the history: after a jump, or at a breakpoint of a function of time.
  void clear() { count_ = 0; }
  /// Records the solution at t; qd and qdd may be empty.
  void push(double t, std::span<const double> q, std::span<const double> qd, std::span<const double> qdd);
  /// Fills what can be predicted at t; returns false if nothing is known (then nothing is written). Spans may be empty.
  bool predict(double t, std::span<double> q, std::span<double> qd, std::span<double> qdd) const;

 private:
  struct Instant {
    double t = 0;
    int derivatives = 0;  // 0: q alone, 1: qd too, 2: qdd too
    std::vector<double> q;
  };
  struct Rates {
    std::vector<double> qd, qdd;
  };
  const Instant& back(int k) const { return ring_[static_cast<std::size_t>((head_ - k + capacity) % capacity)]; }
  const Rates& rates(int k) const { return rates_[static_cast<std::size_t>((head_ - k + capacity) % rate_capacity)]; }
  /// What is known at the last instant but k: rates are kept of fewer instants.
  int derivatives(int k) const { return k < rate_capacity ? back(k).derivatives : 0; }
  bool predict_from_places(double t, std::span<double> q) const;

  // Of instants with rates two are used, and one between them may be left out.
  static constexpr int capacity = 6, rate_capacity = 3;  // the second divides the first
  std::vector<Instant> ring_;
  std::vector<Rates> rates_;
  int head_ = -1, count_ = 0;
};

}  // namespace catena
