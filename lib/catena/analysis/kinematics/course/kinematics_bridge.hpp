// Interpolates a motion across an instant at which the equations do not determine it, from instants at which they do.
//
// At a singular configuration a branch stays as smooth as elsewhere; only the equations that determine it become
// singular, and near it rounding grows with the first, second and third power of 1/distance in q, qd and qdd. So the
// branch is computed at two to four instants around, where it is well determined, and Hermite's polynomial through
// their q, qd and qdd replaces it in between: with four instants at distances up to 2 h an error of order h^12 q^(12) /
// 10^7. Singular for coinciding instants, which callers must avoid.
#pragma once

#include <span>
#include <vector>

namespace catena {

class MotionBridge {
 public:
  /// Two instants on either side.
  static constexpr int capacity = 4;

  void clear() { nodes_.clear(); }
  bool empty() const { return nodes_.empty(); }
  int size() const { return static_cast<int>(nodes_.size()); }
  /// Takes the motion at one more instant, at most `capacity`, in any order.
  void add(double t, std::span<const double> q, std::span<const double> qd, std::span<const double> qdd);
  /// Removes all but the instants taken first.
  void keep_first(std::size_t count) { nodes_.resize(count); }
  /// The polynomial and its derivatives at t; spans may be empty.
  void evaluate(double t, std::span<double> q, std::span<double> qd, std::span<double> qdd) const;
  /// The earliest and the latest instant taken.
  double first() const;
  double last() const;

  struct Node {
    double t = 0;
    std::vector<double> q, qd, qdd;
  };
  std::span<const Node> nodes() const { return nodes_; }

 private:
  std::vector<Node> nodes_;
};

}  // namespace catena
