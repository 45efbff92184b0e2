// Buckling by dense algebra: the eigenvalues mu of the reduced stiffness in the metric of the present one,
//
//   T^T Z^T K(p) Z T = U diag(mu) U^T,   T^T Z^T K(p0) Z T = I        mu(p0) = 1;  a load: a mu_k that passes zero
//
// Sorted, each mu_k is a continuous function of p whatever the load's dependence on it, so that a change of sign
// between two values brackets a root, equal ones as often as they are there. A load that enters K linearly has them in
// closed form; each is confirmed by its change of sign. Else both sides are searched outwards, in steps that grow from
// where K begins to change, and between samples for a lowest mu that only dips below zero.
#include <fmt/format.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/stability/buckling.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Change of the stiffness, in parts of itself, at the first step: far above rounding, well before the first load.
constexpr double least_change = 0.02, most_change = 0.5;
// Factors by which the first step is looked for, and how often.
constexpr double coarse = 1e3, fine = 4;
constexpr int most_tries = 100;
// Rounding of a stiffness with its multipliers, in parts of the largest.
constexpr double stiffness_rounding = 64 * std::numeric_limits<double>::epsilon();
// Deviation from a straight line that counts as rounding, and the part of the largest rate of change that counts as
// none.
constexpr double straight = 1e-10, no_change = 1e-11;
// The search outwards: samples an octave, and how far, in first steps. A load beyond that would be 1e8 times a value
// that already changes the stiffness visibly.
constexpr int samples = 6;
constexpr double farthest = 1e8;
// Accuracy of a load, relative to its distance.
constexpr double located = 1e-14;
// Loads in closed form are accurate to 1e-16 of the steepest rate of change: used up to this multiple of its inverse.
constexpr double well_known = 1e3;
// Half width, in parts of the distance, of the bracket that confirms a load in closed form.
constexpr double confirming = 1e-5;

}  // namespace

// The values of mu along the parameter.
class Buckling::Spectrum {
 public:
  Spectrum(Buckling& buckling, MotionGroup& group)
      : buckling_(buckling), group_(group), matrix_(buckling.plan_, buckling.system_.radius()) {}

  /// Takes the present stiffness as the metric.
  Report start() {
    StaticSystem& system = buckling_.system_;
    std::vector<double>& lambda = buckling_.point_.lambda;
    const std::vector<double> arms = body_arms(system, lambda);
    std::vector<double> weight;
    for (int coordinate : system.plan().coordinate) {
      weight.push_back(coordinate % 3 == 2 ? arms[at(coordinate / 3)] * arms[at(coordinate / 3)] : 1);
    }
    MotionGroups* const groups = &buckling_.groups_.value();
    groups->orthonormalise(weight);
    system.fill(lambda, Curvature::exact, 0);
    const StiffnessFloor floor(system, lambda, 0, groups);
    std::vector<double> reduced;
    reduce_stiffness(system.matrix(), group_, reduced);
    const Eigen::Index f = group_.freedoms();
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(Eigen::Map<Eigen::MatrixXd>(reduced.data(), f, f));
    if (solver.info() != Eigen::Success) return buckling_.not_stable();
    std::vector<std::vector<double>> free;
    for (Eigen::Index k = 0; k < f; ++k) {
      std::vector<double> v = expand(solver.eigenvectors().col(k));
      if (std::abs(solver.eigenvalues()[k]) <= floor(v)) {
        free.push_back(std::move(v));
      } else if (solver.eigenvalues()[k] < 0) {
        return buckling_.not_stable();
      }
    }
    if (!free.empty()) {
      return {Status::refused,
              fmt::format("the equilibrium is neutral at the present value of the parameter: nothing resists {}; hold "
                          "them first",
                          describe_free_motions(static_cast<int>(free.size()), names_of_moving(system, lambda, free))),
              {}};
    }
    rounding_ = stiffness_rounding * solver.eigenvalues()[f - 1] / solver.eigenvalues()[0];
    metric_ = solver.eigenvectors() * solver.eigenvalues().cwiseSqrt().cwiseInverse().asDiagonal();
    return {};
  }

  /// The stiffness at p in the metric of the present one; the report of the last call that gave false.
  bool evaluate(double p) {
    report_ = buckling_.stiffness_at(p, matrix_);
    if (!report_.ok()) return false;
    std::vector<double> reduced;
    reduce_stiffness(matrix_, group_, reduced);
    const Eigen::Index f = group_.freedoms();
    now_ = metric_.transpose() * Eigen::Map<Eigen::MatrixXd>(reduced.data(), f, f) * metric_;
    if (now_.allFinite()) return true;
    report_ = {
        Status::not_converged, fmt::format("the stiffness at the value {:.6g} of the parameter is not finite", p), {}};
    return false;
  }
  const Eigen::MatrixXd& now() const { return now_; }
  /// The effect of rounding of the stiffest mode in the metric of the softest.
  double rounding() const { return rounding_; }
  Report& report() { return report_; }

  /// mu, ascending; empty where there is none.
  Eigen::VectorXd values(double p) {
    if (!evaluate(p)) return {};
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(now_, Eigen::EigenvaluesOnly).eigenvalues();
  }
  std::vector<double> shape(double p, int k) {
    if (!evaluate(p)) return std::vector<double>(at(buckling_.plan_->columns), 0.0);
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(now_);
    return expand(metric_ * solver.eigenvectors().col(k));
  }

 private:
  std::vector<double> expand(const Eigen::VectorXd& y) const {
    const auto n = static_cast<Eigen::Index>(group_.columns.size());
    const Eigen::VectorXd v = Eigen::Map<const Eigen::MatrixXd>(group_.basis.data(), n, y.size()) * y;
    return {v.data(), v.data() + v.size()};  // one group: all columns, ascending
  }

  Buckling& buckling_;
  MotionGroup& group_;
  KktMatrix matrix_;
  Eigen::MatrixXd metric_, now_;
  double rounding_ = 0;
  Report report_;
};

// The roots found so far on one side of the present value or on both.
class Buckling::Search {
 public:
  struct Root {
    double distance = 0;
    int number = 0;  // of its mu
  };

  Search(Spectrum& spectrum, double present) : spectrum_(spectrum), present_(present) {}

  std::vector<Root> roots;

  /// All roots between two distances with these mu; `known`: where they are, if that is known.
  void between(double a, const Eigen::VectorXd& mu_a, double b, const Eigen::VectorXd& mu_b, double known = 0) {
    for (int k = 0; k < static_cast<int>(mu_a.size()); ++k) {
      if ((mu_a[k] < 0) == (mu_b[k] < 0)) continue;
      roots.push_back({known != 0 ? known : bracketed(k, a, mu_a[k], b, mu_b[k]), k});
    }
  }

  /// Where the lowest positive mu may pass below zero and back between three samples: the place, if it does.
  std::optional<double> dip(double a, double b, double c, const Eigen::VectorXd& mu_a, const Eigen::VectorXd& mu_b,
                            const Eigen::VectorXd& mu_c) {
    const int k = static_cast<int>((mu_b.array() < 0).count());
    if (k == mu_b.size() || mu_a[k] < 0 || mu_c[k] < 0 || mu_b[k] >= mu_a[k] || mu_b[k] >= mu_c[k]) return {};
    // Golden section, ended by the first value below zero.
    constexpr double part = 0.381966011250105;
    double middle = mu_b[k];
    for (int step = 0; step < 60 && std::abs(c - a) > 1e-9 * std::abs(b); ++step) {
      const bool right = std::abs(c - b) > std::abs(b - a);
      const double x = right ? b + part * (c - b) : b - part * (b - a);
      const Eigen::VectorXd mu = spectrum_.values(present_ + x);
      if (mu.size() == 0) return {};
      if (mu[k] < 0) return x;
      if (mu[k] < middle) {
        (right ? a : c) = b;
        b = x;
        middle = mu[k];
      } else {
        (right ? c : a) = x;
      }
    }
    return {};
  }

 private:
  // The root of mu_k between a and b, of opposite signs there: regula falsi that halves the stale side, and bisection
  // every third time.
  double bracketed(int k, double a, double mu_a, double b, double mu_b) {
    for (int step = 0; step < 200 && std::abs(b - a) > located * std::max(std::abs(a), std::abs(b)); ++step) {
      double x = step % 3 == 2 ? 0.5 * (a + b) : a + (b - a) * mu_a / (mu_a - mu_b);
      if (x == a || x == b) x = 0.5 * (a + b);
      if (x == a || x == b) break;
      const Eigen::VectorXd mu = spectrum_.values(present_ + x);
      if (mu.size() == 0) break;
      if (mu[k] == 0) return x;
      if ((mu[k] < 0) == (mu_a < 0)) {
        a = x;
        mu_a = mu[k];
        mu_b *= 0.5;
      } else {
        b = x;
        mu_b = mu[k];
        mu_a *= 0.5;
      }
    }
    return 0.5 * (a + b);
  }

  Spectrum& spectrum_;
  double present_;
};

Report Buckling::find_by_dense(std::vector<Load>& loads, const std::function<bool()>& go_on) {
  MotionGroup& group = groups_->groups().front();
  if (group.freedoms() == 0) return {};
  Spectrum spectrum(*this, group);
  if (Report start = spectrum.start(); !start.ok()) return start;
  const double present = options_.present;
  const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(group.freedoms(), group.freedoms());
  // The first step: where the stiffness has changed by a few percent of itself, to the side that the scene allows.
  double step = present != 0 ? 0.1 * std::abs(present) : 1, change = 0, side = 1;
  double too_small = 0, too_large = std::numeric_limits<double>::infinity();
  bool found = false;
  for (int k = 0; k < most_tries && !found; ++k) {
    if (!spectrum.evaluate(present + side * step)) {
      if (!outside_) return spectrum.report();
      if (side > 0 && spectrum.evaluate(present - step)) {
        side = -1;
      } else {
        too_large = std::min(too_large, step);
      }
    }
    if (step < too_large) {
      change = (spectrum.now() - unit).cwiseAbs().maxCoeff();
      found = change >= least_change && change <= most_change;
      if (found) break;
      (change < least_change ? too_small : too_large) = step;
    }
    if (too_small > 0 && std::isfinite(too_large)) {
      if (too_large < 1.001 * too_small) break;  // it jumps there: both sides of the jump are searched
      step = std::sqrt(too_small * too_large);
    } else if (std::isfinite(too_large)) {
      step /= fine;
    } else {
      // No further than the change so far allows: an oscillating dependence must not be stepped over.
      step *= std::clamp(std::sqrt(least_change * most_change) / change, fine, coarse);
    }
  }
  if (!(change > no_change)) return {};
  if (go_on && !go_on()) return {Status::cancelled, "stopped while loads were looked for", {}};

  // Linear, as one more sample confirms: the loads in closed form, confirmed one by one.
  Search search(spectrum, present);
  const Eigen::MatrixXd slope = (spectrum.now() - unit) / (side * step);
  const double none = straight * change + spectrum.rounding();
  bool linear = spectrum.evaluate(present + 3 * side * step) &&
                (spectrum.now() - unit - 3 * side * step * slope).cwiseAbs().maxCoeff() <= none;
  linear = linear && spectrum.evaluate(present - side * step) &&
           (spectrum.now() - unit + side * step * slope).cwiseAbs().maxCoeff() <= none;
  if (linear) {
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(slope, Eigen::EigenvaluesOnly);
    const double steepest = solver.eigenvalues().cwiseAbs().maxCoeff();
    std::vector<double> distances;
    for (double rate : solver.eigenvalues()) {
      if (std::abs(rate) > no_change * steepest) distances.push_back(-1 / rate);
    }
    std::sort(distances.begin(), distances.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    distances.resize(std::min(distances.size(), at(options_.count)));
    for (std::size_t k = 0; linear && k < distances.size();) {
      // Equal ones together.
      std::size_t end = k + 1;
      while (end < distances.size() && std::abs(distances[end] - distances[k]) <= confirming * std::abs(distances[k]))
        ++end;
      const double a = distances[k] * (1 - 2 * confirming), b = distances[end - 1] * (1 + 2 * confirming);
      const Eigen::VectorXd mu_a = spectrum.values(present + a), mu_b = spectrum.values(present + b);
      // Outside what the scene allows there are no loads.
      if (mu_a.size() > 0 && mu_b.size() > 0) {
        const std::size_t before = search.roots.size();
        search.between(a, mu_a, b, mu_b, std::abs(distances[k]) * steepest < well_known ? distances[k] : 0);
        linear = search.roots.size() - before >= end - k;
      }
      k = end;
    }
  }
  if (!linear) {
    search.roots.clear();
    const double growth = std::pow(2.0, 1.0 / samples);
    // Both sides go outwards together: what is nearest comes first.
    struct Front {
      double sign;
      bool open = true;
      std::vector<double> place{};  // the last three samples
      std::vector<Eigen::VectorXd> mu{};
    };
    Front sides[2] = {{1}, {-1}};
    for (Front& s : sides) {
      s.place = {0};
      s.mu = {Eigen::VectorXd::Ones(group.freedoms())};
    }
    for (double reach = step / samples; reach <= farthest * step && (sides[0].open || sides[1].open);
         reach = reach < step ? reach + step / samples : reach * growth) {
      if (go_on && !go_on()) return {Status::cancelled, "stopped while loads were looked for", {}};
      for (Front& s : sides) {
        if (!s.open) continue;
        const double x = s.sign * reach;
        Eigen::VectorXd mu = spectrum.values(present + x);
        if (mu.size() == 0) {
          if (!outside_) return spectrum.report();
          // Up to the end of what the scene allows.
          s.open = false;
          double inside = s.place.back(), beyond = x;
          for (int k = 0; k < 50; ++k) {
            const double middle = 0.5 * (inside + beyond);
            (spectrum.evaluate(present + middle) ? inside : beyond) = middle;
          }
          mu = spectrum.values(present + inside);
          if (inside != s.place.back() && mu.size() > 0) search.between(s.place.back(), s.mu.back(), inside, mu);
          continue;
        }
        if (s.place.size() >= 2) {
          const std::size_t last = s.place.size() - 1;
          const double a = s.place[last - 1], b = s.place[last];
          if (const auto low = search.dip(a, b, x, s.mu[last - 1], s.mu[last], mu)) {
            const Eigen::VectorXd mu_low = spectrum.values(present + *low);
            // The two roots between samples, beside the one that the samples show.
            const bool before = std::abs(*low) < std::abs(b);
            search.between(before ? a : b, before ? s.mu[last - 1] : s.mu[last], *low, mu_low);
            search.between(*low, mu_low, before ? b : x, before ? s.mu[last] : mu);
          }
        }
        search.between(s.place.back(), s.mu.back(), x, mu);
        s.place.push_back(x);
        s.mu.push_back(std::move(mu));
        if (s.place.size() > 2) {
          s.place.erase(s.place.begin());
          s.mu.erase(s.mu.begin());
        }
      }
      if (search.roots.size() >= at(options_.count)) break;
    }
  }
  // Of two at the same distance, the one above.
  std::sort(search.roots.begin(), search.roots.end(), [](const Search::Root& a, const Search::Root& b) {
    const double near = std::abs(std::abs(a.distance) - std::abs(b.distance));
    if (near <= 1e-12 * std::abs(a.distance)) return a.distance > b.distance;
    return std::abs(a.distance) < std::abs(b.distance);
  });
  search.roots.resize(std::min(search.roots.size(), at(options_.count)));
  for (const Search::Root& root : search.roots) {
    loads.push_back({root.distance, spectrum.shape(present + root.distance, root.number)});
  }
  return {};
}

}  // namespace catena
