#include "catena/analysis/pose/dead_point.hpp"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <random>

#include "catena/analysis/pose/quadratics.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

/// Left null vectors as rows, lengths in length scales, of length one.
Eigen::MatrixXd left_null_rows(const Evaluator& evaluator, const RankReport& rank) {
  const Plan& plan = evaluator.plan();
  Eigen::MatrixXd w = Eigen::MatrixXd::Zero(rank.left_null_vectors.count(), plan.rows);
  for (int k = 0; k < w.rows(); ++k) {
    const auto rows = rank.left_null_vectors.indices(k);
    const auto weights = rank.left_null_vectors.values(k);
    for (std::size_t n = 0; n < rows.size(); ++n) {
      w(k, rows[n]) = weights[n] * (plan.row_is_angle[at(rows[n])] ? 1 : evaluator.length_scale());
    }
  }
  w.rowwise().normalize();
  return w;
}

/// A vector over the rows with lengths in length scales.
Eigen::VectorXd in_units(const Evaluator& evaluator, std::span<const double> b) {
  Eigen::VectorXd x(static_cast<Eigen::Index>(b.size()));
  for (std::size_t r = 0; r < b.size(); ++r) {
    x[static_cast<Eigen::Index>(r)] = b[r] / (evaluator.plan().row_is_angle[r] ? 1 : evaluator.length_scale());
  }
  return x;
}

/// Combinations c^T w of the left null vectors that vanish along all motions, as columns.
Eigen::MatrixXd lasting_combinations(Evaluator& evaluator, const NullSpaces& spaces, const Eigen::MatrixXd& w) {
  const Eigen::Index count = w.rows();
  std::vector<double> still(at(evaluator.plan().rows)), forth(still), back(still);
  std::vector<double> rest(at(evaluator.plan().coordinates()), 0.0), z(rest);
  evaluator.gamma(rest, still);
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Eigen::MatrixXd forms(count, count + 2);
  double terms = 0;
  for (Eigen::Index j = 0; j < forms.cols(); ++j) {
    std::fill(z.begin(), z.end(), 0.0);
    for (const std::vector<double>& motion : spaces.z) {
      const double part = uniform(generator);
      for (std::size_t c = 0; c < z.size(); ++c) z[c] += part * motion[c];
    }
    evaluator.gamma(z, forth);
    for (double& value : z) value = -value;
    evaluator.gamma(z, back);
    for (std::size_t r = 0; r < still.size(); ++r) forth[r] = (forth[r] + back[r]) / 2 - still[r];
    const Eigen::VectorXd form = in_units(evaluator, forth);
    forms.col(j) = w * form;
    terms = std::max(terms, (w.cwiseAbs() * form.cwiseAbs()).maxCoeff());
  }
  const Eigen::JacobiSVD<Eigen::MatrixXd> svd(forms, Eigen::ComputeFullU);
  const auto ends = (svd.singularValues().array() > Quadratics::vanishing * terms).count();
  return svd.matrixU().rightCols(count - ends);
}

}  // namespace

std::optional<SingularPoint> find_dead_point(Evaluator& evaluator, std::span<const double> q, double threshold) {
  const Plan& plan = evaluator.plan();
  const NullSpaces spaces = find_null_spaces(evaluator, q, threshold);
  const int count = spaces.rank.left_null_vectors.count();
  if (!spaces.rank.ok() || count == 0 || count > most_dependences || spaces.z.empty()) return {};
  std::vector<double> nu(at(plan.rows));
  evaluator.nu(nu);
  const Eigen::MatrixXd w = left_null_rows(evaluator, spaces.rank);
  const Eigen::VectorXd asked = in_units(evaluator, nu), opposed = w * asked;
  if (!(opposed.norm() > clear_disagreement * asked.norm())) return {};
  const Eigen::MatrixXd lasting = lasting_combinations(evaluator, spaces, w);
  if ((lasting.transpose() * opposed).norm() > std::max(clear_disagreement, threshold) * asked.norm()) return {};
  SingularPoint point;
  point.kind = SingularPoint::Kind::lock_up;
  point.t = evaluator.time();
  point.q.assign(q.begin(), q.end());
  point.nullity = count - static_cast<int>(lasting.cols());
  point.name_bodies(evaluator, spaces.z);
  point.find_driver(evaluator, most_opposed(evaluator, spaces.rank, nu).w, nu);
  return point;
}

}  // namespace catena
