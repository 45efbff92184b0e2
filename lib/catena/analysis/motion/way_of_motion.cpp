#include "catena/analysis/motion/way_of_motion.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace catena {
namespace {

// Instants at which accelerations are looked at: faster changes than so many a run make the way longer than it is, by
// the square of what lies between two instants.
constexpr int looked_at = 1000;

/// Accelerations at places and velocities beside those of the start.
class Beside {
 public:
  Beside(EquationsOfMotion& equations, std::span<const double> q, std::span<const double> qd)
      : equations_(equations), q_(q.begin(), q.end()), qd_(qd.begin(), qd.end()), a_(q.size()) {}

  /// With every particle moved by so much, m, and faster by so much, m/s.
  std::vector<double> at(double t, double moved, double faster) {
    std::vector<double> q = q_, qd = qd_;
    for (std::size_t c = 0; c < moving(); ++c) {
      if (c % 3 == 2) continue;
      q[c] += moved;
      qd[c] += faster;
    }
    if (!equations_.accelerations(t, Side::after, q, qd, a_)) std::fill(a_.begin(), a_.end(), 0.0);
    return a_;
  }
  /// The largest difference of translations.
  double apart(std::span<const double> a, std::span<const double> b) const {
    double most = 0;
    for (std::size_t c = 0; c < moving(); ++c) {
      if (c % 3 != 2) most = std::max(most, std::abs(a[c] - b[c]));
    }
    return most;
  }
  std::vector<double> nothing() const { return std::vector<double>(q_.size(), 0.0); }
  double speed() const { return apart(qd_, nothing()); }

 private:
  std::size_t moving() const { return 3 * static_cast<std::size_t>(equations_.plan().moving); }

  EquationsOfMotion& equations_;
  std::vector<double> q_, qd_, a_;
};

}  // namespace

double way_of_motion(EquationsOfMotion& equations, double t, std::span<const double> q, std::span<const double> qd,
                     double last) {
  Beside beside(equations, q, qd);
  double time = last - t;
  if (!(time > 0)) return 0;
  const std::vector<double> none = beside.nothing(), first = beside.at(t, 0, 0);
  double largest = beside.apart(first, none), steepest = 0;
  std::vector<double> before = first;
  const Evaluator& evaluator = equations.evaluator();
  const bool changes = !evaluator.model().functions.empty() || !evaluator.laws().empty();
  for (int k = 1; k <= looked_at && changes; ++k) {
    const double instant = k == looked_at ? last : t + (last - t) * k / looked_at;
    std::vector<double> now = beside.at(instant, 0, 0);
    largest = std::max(largest, beside.apart(now, none));
    steepest = std::max(steepest, beside.apart(now, before) * looked_at / (last - t));
    before = std::move(now);
  }
  const double speed = beside.speed();
  const auto way = [&] { return speed * time + largest * time * time / 2; };
  if (steepest > 0) time = std::min(time, largest / steepest);
  if (!(way() > 0)) return 0;
  // What draws particles back, or holds them up, does so after a shorter time.
  const double moved = way(), faster = moved / time;
  const double stiffness = beside.apart(beside.at(t, moved, 0), first) / moved;
  const double damping = beside.apart(beside.at(t, 0, faster), first) / faster;
  if (stiffness > 0) time = std::min(time, 1 / std::sqrt(stiffness));
  if (damping > 0) time = std::min(time, 1 / damping);
  return way();
}

}  // namespace catena
