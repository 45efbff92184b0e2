#include "catena/analysis/dynamics/integrators/coordinate_partition.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include "catena/analysis/pose/jacobian_rank.hpp"
#include "catena/analysis/pose/mobility.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Newton's method from a step's end doubles the digits: steps that need more are too long.
constexpr int most_iterations = 10;
// Iterations gain nothing any more below `assembled`, nor do they where every equation misses by no more than rounding
// of its terms: with long arms (wheels of a thousand length scales) that is much more, and beside them small wheels
// turn noticeably by it.
constexpr double rounding_of_terms = 8 * std::numeric_limits<double>::epsilon();

}  // namespace

CoordinatePartition::CoordinatePartition(EquationsOfMotion& equations)
    : equations_(equations),
      evaluator_(equations.evaluator()),
      plan_(equations.plan()),
      scaling_(plan_, evaluator_.length_scale()),
      system_(evaluator_.shared_plan()) {
  const double length = evaluator_.length_scale();
  all_free_.assign(at(3 * plan_.moving), 0.0);
  for (int c : plan_.coordinate) all_free_[at(c)] = c % 3 == 2 ? 1 : 1 / (length * length);
  weight_ = all_free_;
  jacobian_.resize(at(plan_.trash_slot()) + 1);
  evaluator_.start_jacobian(jacobian_);
  residual_.resize(at(plan_.rows));
  multipliers_.resize(at(plan_.rows));
  change_.resize(all_free_.size());
  row_square_.resize(at(plan_.rows));
}

bool CoordinatePartition::factorize() {
  evaluator_.jacobian(jacobian_);
  if (!system_.factorize(jacobian_, evaluator_.counters)) return false;
  ratio_ = 1;
  for (int r = 0; r < plan_.rows; ++r) ratio_ = std::min(ratio_, system_.pivot(r) / row_square_[at(r)]);
  return true;
}

// The directions that the motion is integrated without, in the metric used here.
void CoordinatePartition::leave_out() {
  SparseVectors directions = equations_.left_out();
  const std::vector<double> ours = system_.row_sizes(), theirs = equations_.row_sizes();
  for (std::size_t n = 0; n < directions.index.size(); ++n) {
    const auto row = at(directions.index[n]);
    directions.value[n] *= theirs[row] > 0 ? ours[row] / theirs[row] : 0;
  }
  system_.leave_out(std::move(directions));
}

bool CoordinatePartition::choose(std::span<const double> q) {
  if (plan_.rows == 0) return true;
  if (freedoms_ < 0) {
    freedoms_ = plan_.columns - acting_rows(plan_) + equations_.left_out().count();
    // The rank here may be lower than elsewhere: a motion may start in a flat position.
    if (freedoms_ < 0) freedoms_ = analyse_mobility(evaluator_, q).dof();
  }
  if (freedoms_ > most_freedoms) return false;
  ++choices_;
  evaluator_.set_configuration(q);
  std::fill(row_square_.begin(), row_square_.end(), 1.0);
  system_.set_metric(all_free_);
  if (!factorize()) return false;
  if (equations_.left_out().count() > 0) {
    leave_out();
    if (!factorize()) return false;
  }
  for (int r = 0; r < plan_.rows; ++r) row_square_[at(r)] = system_.diagonal(r);
  weight_ = all_free_;
  find_tangents(freedoms_);
  pick_independent(freedoms_);
  system_.set_metric(weight_);
  if (!factorize()) return false;
  largest_ratio_ = ratio_;
  return true;
}

// An orthonormal basis of the scaled tangent space.
void CoordinatePartition::find_tangents(int freedoms) {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const std::size_t size = all_free_.size();
  tangents_.resize(at(freedoms));
  for (int j = 0; j < freedoms; ++j) {
    std::vector<double>& tangent = tangents_[at(j)];
    tangent.assign(size, 0.0);
    for (int c : plan_.coordinate) tangent[at(c)] = uniform(generator) / std::sqrt(all_free_[at(c)]);
    std::fill(residual_.begin(), residual_.end(), 0.0);
    system_.multiply_add(tangent, residual_);
    system_.least_change(residual_, change_, multipliers_, evaluator_.counters);
    for (std::size_t c = 0; c < size; ++c) tangent[c] = (tangent[c] - change_[c]) * std::sqrt(all_free_[c]);
    // Twice is enough for orthogonality to rounding.
    for (int round = 0; round < 2; ++round) {
      for (int k = 0; k < j; ++k) {
        double product = 0;
        for (std::size_t c = 0; c < size; ++c) product += tangents_[at(k)][c] * tangent[c];
        for (std::size_t c = 0; c < size; ++c) tangent[c] -= product * tangents_[at(k)][c];
      }
    }
    double square = 0;
    for (double x : tangent) square += x * x;
    for (double& x : tangent) x /= std::sqrt(square);
  }
}

// QR with pivoting: the coordinate of which the tangents that are left have most, then the tangents turned so that
// only one of them has it.
void CoordinatePartition::pick_independent(int freedoms) {
  const std::size_t columns = weight_.size();
  for (std::size_t j = 0; j < at(freedoms); ++j) {
    std::size_t best = 0;
    double largest = -1;
    for (std::size_t c = 0; c < columns; ++c) {
      double square = 0;
      for (std::size_t k = j; k < tangents_.size(); ++k) square += tangents_[k][c] * tangents_[k][c];
      if (weight_[c] > 0 && square > largest) {
        largest = square;
        best = c;
      }
    }
    weight_[best] = 0;
    mirror_.assign(tangents_.size(), 0.0);
    // Householder's reflection among tangents j ...: component `best` ends up in tangent j alone.
    double square = 0;
    for (std::size_t k = j; k < tangents_.size(); ++k) square += tangents_[k][best] * tangents_[k][best];
    for (std::size_t k = j; k < tangents_.size(); ++k) mirror_[k] = tangents_[k][best];
    mirror_[j] += std::copysign(std::sqrt(square), mirror_[j]);
    double length = 0;
    for (double x : mirror_) length += x * x;
    if (length == 0) continue;
    for (std::size_t c = 0; c < columns; ++c) {
      double product = 0;
      for (std::size_t k = j; k < tangents_.size(); ++k) product += mirror_[k] * tangents_[k][c];
      product *= 2 / length;
      for (std::size_t k = j; k < tangents_.size(); ++k) tangents_[k][c] -= product * mirror_[k];
    }
  }
}

// Whether residual_, that of q, is rounding of sum |Phi_q| |q| in each equation, q counted from the ground's origin:
// places of curves on the ground are. Where equations depend on each other those that are kept pass the rounding of
// one on to all others, to angles by the length scale.
bool CoordinatePartition::residual_is_rounding(std::span<const double> q) {
  std::fill(multipliers_.begin(), multipliers_.end(), 0.0);
  for (int c = 0; c < plan_.columns; ++c) {
    const int coordinate = plan_.coordinate[at(c)];
    const bool angle = coordinate % 3 == 2;
    const Vec2<double> origin = evaluator_.origin(coordinate / 3);
    const double from_ground = angle ? 0 : coordinate % 3 == 0 ? origin.x : origin.y;
    const double size = std::max(std::abs(q[at(coordinate)] + from_ground), angle ? 1 : evaluator_.length_scale());
    for (int k = plan_.jacobian.column_start[at(c)]; k < plan_.jacobian.column_start[at(c) + 1]; ++k)
      multipliers_[at(plan_.jacobian.row_index[at(k)])] += std::abs(jacobian_[at(k)]) * size;
  }
  if (equations_.left_out().count() > 0)
    return position_residual_ <= rounding_of_terms * scaling_.row_norm(multipliers_);
  for (std::size_t r = 0; r < residual_.size(); ++r) {
    if (!(std::abs(residual_[r]) <= rounding_of_terms * multipliers_[r])) return false;
  }
  return true;
}

bool CoordinatePartition::solve(double t, Side side, std::span<double> q, std::span<double> qd) {
  position_residual_ = 0;
  if (plan_.rows == 0) return true;
  evaluator_.set_time(t, side);
  double before = 0;
  for (int k = 0;; ++k) {
    evaluator_.set_configuration(q);
    evaluator_.phi(residual_);
    position_residual_ = scaling_.row_norm(residual_);
    if (!std::isfinite(position_residual_)) return false;
    if (k == 0 && (!factorize() || ratio_ < unusable * largest_ratio_)) return false;
    if (position_residual_ <= thresholds::few_roundings) break;
    if (k > 0 && position_residual_ > 0.5 * before &&
        ((before < thresholds::assembled && position_residual_ < 10 * thresholds::assembled) ||
         residual_is_rounding(q)))
      break;
    if (k == most_iterations || (k > 0 && position_residual_ > before)) return false;
    before = position_residual_;
    system_.least_change(residual_, change_, multipliers_, evaluator_.counters);
    for (std::size_t c = 0; c < change_.size(); ++c) q[c] -= change_[c];
  }
  // The factors are those of the estimate, the Jacobian is the one that holds: further rounds correct for that.
  evaluator_.jacobian(jacobian_);
  before = std::numeric_limits<double>::infinity();
  for (;;) {
    evaluator_.nu(residual_);
    for (double& value : residual_) value = -value;
    system_.multiply_add(qd, residual_);
    const double size = scaling_.row_norm(residual_);
    if (!(size < 0.5 * before) || size == 0) break;
    before = size;
    system_.least_change(residual_, change_, multipliers_, evaluator_.counters);
    for (std::size_t c = 0; c < change_.size(); ++c) qd[c] -= change_[c];
  }
  return true;
}

}  // namespace catena
