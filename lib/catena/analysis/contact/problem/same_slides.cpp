#include "catena/analysis/contact/problem/same_slides.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <optional>

namespace catena {
namespace {

Eigen::MatrixXd response_of(const ContactProblem& problem, const std::vector<std::size_t>& joints) {
  const auto size = static_cast<Eigen::Index>(joints.size());
  Eigen::MatrixXd response(size, size);
  for (Eigen::Index r = 0; r < size; ++r) {
    for (Eigen::Index c = 0; c < size; ++c)
      response(r, c) =
          problem.D(2 * joints[static_cast<std::size_t>(r)] + 1, 2 * joints[static_cast<std::size_t>(c)] + 1);
  }
  return response;
}

Eigen::Index rank_of(const Eigen::MatrixXd& response) {
  Eigen::VectorXd unit = response.diagonal();
  for (double& own : unit) own = own > 0 ? 1 / std::sqrt(own) : 0;
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> factors;
  factors.setThreshold(ContactProblem::no_response);
  return factors.compute(unit.asDiagonal() * response * unit.asDiagonal()).rank();
}

// The forces that do the same as those of the joints that stick, with the least sum sqrt(D_kk) T_k^2 / L_k; nothing
// where there are none. Where D_kk = 0, which nothing moves, the force is zero.
std::optional<std::vector<double>> least_forces(const ContactProblem& problem, const std::vector<std::size_t>& joints) {
  const auto size = static_cast<Eigen::Index>(joints.size());
  const Eigen::MatrixXd response = response_of(problem, joints);
  Eigen::VectorXd held(size), root(size);
  for (Eigen::Index r = 0; r < size; ++r) {
    const std::size_t a = joints[static_cast<std::size_t>(r)];
    const double own = response(r, r);
    held(r) = problem.x[2 * a + 1];
    root(r) = std::sqrt(problem.place[a].limit / (own > 0 ? std::sqrt(own) : 1));
  }
  if (!root.allFinite()) return {};
  const Eigen::VectorXd effect = response * held;
  const Eigen::MatrixXd weighted = root.asDiagonal() * response * root.asDiagonal();
  Eigen::CompleteOrthogonalDecomposition<Eigen::MatrixXd> factors;
  factors.setThreshold(ContactProblem::no_response);
  const Eigen::VectorXd scaled = factors.compute(weighted).solve(root.cwiseProduct(effect));
  const Eigen::VectorXd least = root.cwiseProduct(scaled);
  const Eigen::VectorXd missing = response * least - effect;
  for (Eigen::Index r = 0; r < size; ++r) {
    const double terms = response.row(r).cwiseAbs().dot((least.cwiseAbs() + held.cwiseAbs()).transpose());
    if (!(std::abs(missing(r)) <= ContactProblem::rounding_of_sums * terms)) return {};
  }
  return std::vector<double>(least.begin(), least.end());
}

}  // namespace

bool is_sticking_joint(const ContactProblem& problem, std::size_t a) {
  const ContactProblem::Place& place = problem.place[a];
  return !place.has_normal && place.head < 0 && problem.state[a] == ContactProblem::State::sticks;
}

bool slide_as_one(const ContactProblem& problem, std::size_t a, std::size_t b) {
  const std::size_t r = 2 * a + 1, c = 2 * b + 1;
  const double both = problem.D(r, r) * problem.D(c, c);
  return both > 0 && problem.D(r, c) * problem.D(r, c) >= (1 - ContactProblem::rounding_of_sums) * both;
}

std::vector<SameSlide> same_slides(const ContactProblem& problem) {
  std::vector<SameSlide> slides;
  const auto D = [&](std::size_t a, std::size_t b) { return problem.D(2 * a + 1, 2 * b + 1); };
  for (std::size_t a = 0; a < problem.place.size(); ++a) {
    if (!is_sticking_joint(problem, a)) continue;
    const auto found = std::find_if(slides.begin(), slides.end(), [&](const SameSlide& slide) {
      return slide_as_one(problem, a, slide.places.front());
    });
    if (found == slides.end()) {
      slides.push_back({{a}, {}});
    } else {
      found->places.push_back(a);
    }
  }
  // Beside the one that can hold most no ratio is large, and none has a divisor of zero unless all limits are.
  const auto most = [&](std::size_t a) { return std::sqrt(D(a, a)) * problem.place[a].limit; };
  for (SameSlide& slide : slides) {
    std::vector<std::size_t>& places = slide.places;
    const auto master =
        std::max_element(places.begin(), places.end(), [&](std::size_t a, std::size_t b) { return most(a) < most(b); });
    std::rotate(places.begin(), master, master + 1);
    const std::size_t m = places.front();
    for (const std::size_t a : places) slide.ratios.push_back(a == m ? 1 : D(a, m) / D(m, m));
  }
  return slides;
}

void LimitShares::share(ContactProblem& problem) {
  std::vector<std::size_t> joints;
  for (std::size_t a = 0; a < problem.place.size(); ++a) {
    if (is_sticking_joint(problem, a)) joints.push_back(a);
  }
  if (joints.empty()) return;
  if (joints != joints_) {
    unique_ = rank_of(response_of(problem, joints)) == static_cast<Eigen::Index>(joints.size());
    joints_ = joints;
  }
  if (unique_) return;
  const std::optional<std::vector<double>> least = least_forces(problem, joints);
  const auto fits = [&](std::size_t n) {
    return std::abs((*least)[n]) <= (1 + ContactProblem::rounding_of_sums) * problem.place[joints[n]].limit;
  };
  bool all = least.has_value();
  for (std::size_t n = 0; all && n < joints.size(); ++n) all = fits(n);
  if (all) {
    for (std::size_t n = 0; n < joints.size(); ++n) problem.x[2 * joints[n] + 1] = (*least)[n];
    return;
  }
  // Others fit: of these only those that are one motion share.
  for (const SameSlide& slide : same_slides(problem)) {
    double held = 0, most = 0;
    for (std::size_t n = 0; n < slide.places.size(); ++n) {
      held += slide.ratios[n] * problem.x[2 * slide.places[n] + 1];
      most += std::abs(slide.ratios[n]) * problem.place[slide.places[n]].limit;
    }
    if (slide.places.size() < 2 || !(most > 0) || !std::isfinite(most)) continue;
    for (std::size_t n = 0; n < slide.places.size(); ++n)
      problem.x[2 * slide.places[n] + 1] =
          held / most * std::copysign(problem.place[slide.places[n]].limit, slide.ratios[n]);
  }
}

}  // namespace catena
