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

#include "catena/analysis/run/thresholds.hpp"
#include "catena/analysis/spectrum/free_motions.hpp"
#include "catena/analysis/stability/buckling.hpp"
#include "catena/analysis/stability/load_search.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// Rounding of a stiffness with its multipliers, in parts of the largest.
constexpr double stiffness_rounding = thresholds::sum_rounding;
// Deviation from a straight line that counts as rounding.
constexpr double straight = 1e-10;
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
    const std::vector<double> weight = metric_of_arms(system, lambda);
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
    if (!free.empty()) return Buckling::neutral(static_cast<int>(free.size()), names_of_moving(system, lambda, free));
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
  /// What the load last evaluated changes, in parts of the present stiffness: the largest entry that is more than
  /// rounding. Nothing where all are rounding and this is at least `hidden` of every mode: such a load has no effect.
  std::optional<double> change(double hidden) {
    const StiffnessFloor floor = buckling_.floor_under_load();
    const Eigen::Index f = now_.rows();
    std::vector<std::vector<double>> modes;
    for (Eigen::Index k = 0; k < f; ++k) modes.push_back(expand(metric_.col(k)));
    double largest = 0, least = std::numeric_limits<double>::infinity();
    for (Eigen::Index i = 0; i < f; ++i) {
      least = std::min(least, floor(modes[at(i)]));
      for (Eigen::Index j = 0; j <= i; ++j) {
        const double entry = std::abs(now_(i, j) - (i == j ? 1 : 0));
        if (entry > largest && entry > floor.between(modes[at(i)], modes[at(j)])) largest = entry;
      }
    }
    if (largest == 0 && least >= hidden) return std::nullopt;
    return largest;
  }
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

// The search for roots on both sides of the present value.
class Buckling::Search {
 public:
  struct Root {
    double distance = 0;
    int number = 0;  // of its mu
  };

  Search(Buckling& buckling, Spectrum& spectrum, Eigen::Index freedoms, const std::function<bool()>& go_on)
      : buckling_(buckling),
        spectrum_(spectrum),
        freedoms_(freedoms),
        go_on_(go_on),
        present_(buckling.options_.present),
        wanted_(at(buckling.options_.count)) {}

  /// The nearest roots, in the order of their distance; of two at the same one, that above first.
  Report find() {
    if (Report first = find_first_step(); !first.ok()) return first;
    if (!(change_ > FirstLoadStep::no_change)) return {};
    if (go_on_ && !go_on_()) return cancelled();
    if (!find_in_closed_form()) {
      roots_.clear();
      if (Report searched = search_outwards(); !searched.ok()) return searched;
    }
    std::sort(roots_.begin(), roots_.end(), comes_first<Root>);
    roots_.resize(std::min(roots_.size(), wanted_));
    return {};
  }
  const std::vector<Root>& roots() const { return roots_; }

 private:
  // The last two samples on one side.
  struct Front {
    double sign;
    bool open = true;
    std::vector<double> place{};
    std::vector<Eigen::VectorXd> mu{};
  };

  static Report cancelled() { return {Status::cancelled, "stopped while loads were looked for", {}}; }

  // The first step: where the stiffness has changed by a few percent of itself, to the side that the scene allows.
  Report find_first_step() {
    FirstLoadStep first(present_);
    for (int k = 0; k < thresholds::most_bisections; ++k) {
      step_ = first.step();
      if (!spectrum_.evaluate(present_ + side_ * step_)) {
        if (!buckling_.outside_) return spectrum_.report();
        if (side_ > 0 && spectrum_.evaluate(present_ - step_)) {
          side_ = -1;
        } else {
          first.refuse();
        }
      }
      if (!first.is_refused()) {
        const std::optional<double> change = spectrum_.change(FirstLoadStep::least_change);
        change_ = change.value_or(0);
        if (!change || first.take(change_)) return {};
      }
      if (!first.move(change_)) return {};
    }
    step_ = first.step();
    return {};
  }

  // Where the stiffness is linear in the parameter, as samples at three steps and at one on the other side confirm: the
  // loads, confirmed one by one. False where that is not so.
  bool find_in_closed_form() {
    const Eigen::MatrixXd unit = Eigen::MatrixXd::Identity(freedoms_, freedoms_);
    const Eigen::MatrixXd slope = (spectrum_.now() - unit) / (side_ * step_);
    const double none = straight * change_ + spectrum_.rounding();
    const auto is_on_line = [&](double distance) {
      return spectrum_.evaluate(present_ + distance) &&
             (spectrum_.now() - unit - distance * slope).cwiseAbs().maxCoeff() <= none;
    };
    if (!is_on_line(3 * side_ * step_) || !is_on_line(-side_ * step_)) return false;
    const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(slope, Eigen::EigenvaluesOnly);
    const double steepest = solver.eigenvalues().cwiseAbs().maxCoeff();
    std::vector<double> distances;
    for (double rate : solver.eigenvalues()) {
      if (std::abs(rate) > FirstLoadStep::no_change * steepest) distances.push_back(-1 / rate);
    }
    std::sort(distances.begin(), distances.end(), [](double a, double b) { return std::abs(a) < std::abs(b); });
    distances.resize(std::min(distances.size(), wanted_));
    bool confirmed = true;
    for (std::size_t k = 0; confirmed && k < distances.size();) {
      // Equal ones together.
      std::size_t end = k + 1;
      while (end < distances.size() && std::abs(distances[end] - distances[k]) <= confirming * std::abs(distances[k]))
        ++end;
      const double a = distances[k] * (1 - 2 * confirming), b = distances[end - 1] * (1 + 2 * confirming);
      const Eigen::VectorXd mu_a = spectrum_.values(present_ + a), mu_b = spectrum_.values(present_ + b);
      // Outside what the scene allows there are no loads.
      if (mu_a.size() > 0 && mu_b.size() > 0) {
        const std::size_t before = roots_.size();
        look_between(a, mu_a, b, mu_b, std::abs(distances[k]) * steepest < well_known ? distances[k] : 0);
        confirmed = roots_.size() - before >= end - k;
      }
      k = end;
    }
    return confirmed;
  }

  // Both sides go outwards together: what is nearest comes first.
  Report search_outwards() {
    Front sides[2] = {{1}, {-1}};
    for (Front& s : sides) {
      s.place = {0};
      s.mu = {Eigen::VectorXd::Ones(freedoms_)};
    }
    Report outcome;
    for_each_distance(step_, farthest_load, [&](double reach) {
      if (go_on_ && !go_on_()) {
        outcome = cancelled();
        return false;
      }
      for (Front& s : sides) {
        if (!s.open) continue;
        Eigen::VectorXd mu = spectrum_.values(present_ + s.sign * reach);
        if (mu.size() > 0) {
          take_sample(s, s.sign * reach, std::move(mu));
        } else if (buckling_.outside_) {
          close(s, s.sign * reach);
        } else {
          outcome = spectrum_.report();
          return false;
        }
      }
      return roots_.size() < wanted_ && (sides[0].open || sides[1].open);
    });
    return outcome;
  }

  void take_sample(Front& s, double x, Eigen::VectorXd mu) {
    if (s.place.size() == 2) {
      if (const auto low = find_dip(s.place[0], s.place[1], x, s.mu[0], s.mu[1], mu)) {
        const Eigen::VectorXd mu_low = spectrum_.values(present_ + *low);
        // The two roots between samples, beside the one that the samples show.
        const bool before = std::abs(*low) < std::abs(s.place[1]);
        look_between(s.place[before ? 0 : 1], s.mu[before ? 0 : 1], *low, mu_low);
        look_between(*low, mu_low, before ? s.place[1] : x, before ? s.mu[1] : mu);
      }
    }
    look_between(s.place.back(), s.mu.back(), x, mu);
    s.place.push_back(x);
    s.mu.push_back(std::move(mu));
    if (s.place.size() > 2) {
      s.place.erase(s.place.begin());
      s.mu.erase(s.mu.begin());
    }
  }

  // Up to the end of what the scene allows, which lies before `beyond`.
  void close(Front& s, double beyond) {
    s.open = false;
    double inside = s.place.back();
    for (int k = 0; k < 50; ++k) {
      const double middle = 0.5 * (inside + beyond);
      (spectrum_.evaluate(present_ + middle) ? inside : beyond) = middle;
    }
    const Eigen::VectorXd mu = spectrum_.values(present_ + inside);
    if (inside != s.place.back() && mu.size() > 0) look_between(s.place.back(), s.mu.back(), inside, mu);
  }

  // All roots between two distances with these mu; `known`: where they are, if that is known.
  void look_between(double a, const Eigen::VectorXd& mu_a, double b, const Eigen::VectorXd& mu_b, double known = 0) {
    for (int k = 0; k < static_cast<int>(mu_a.size()); ++k) {
      if ((mu_a[k] < 0) == (mu_b[k] < 0)) continue;
      roots_.push_back({known != 0 ? known : locate(k, a, mu_a[k], b, mu_b[k]), k});
    }
  }

  // Where the lowest positive mu may pass below zero and back between three samples: the place, if it does.
  std::optional<double> find_dip(double a, double b, double c, const Eigen::VectorXd& mu_a, const Eigen::VectorXd& mu_b,
                                 const Eigen::VectorXd& mu_c) {
    const int k = static_cast<int>((mu_b.array() < 0).count());
    if (k == mu_b.size() || mu_a[k] < 0 || mu_c[k] < 0 || mu_b[k] >= mu_a[k] || mu_b[k] >= mu_c[k]) return {};
    // Golden section, ended by the first value below zero.
    constexpr double part = thresholds::golden_part;
    double middle = mu_b[k];
    for (int step = 0; step < thresholds::most_bisections && std::abs(c - a) > 1e-9 * std::abs(b); ++step) {
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

  // The root of mu_k between a and b, of opposite signs there: regula falsi that halves the stale side, and bisection
  // every third time.
  double locate(int k, double a, double mu_a, double b, double mu_b) {
    for (int step = 0;
         step < 2 * thresholds::most_bisections && std::abs(b - a) > located * std::max(std::abs(a), std::abs(b));
         ++step) {
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

  Buckling& buckling_;
  Spectrum& spectrum_;
  Eigen::Index freedoms_;
  const std::function<bool()>& go_on_;
  double present_;
  std::size_t wanted_;
  double step_ = 0, change_ = 0, side_ = 1;  // of the first step: its length, what it changes, +1 or -1
  std::vector<Root> roots_;
};

Report Buckling::find_by_dense(std::vector<Load>& loads, const std::function<bool()>& go_on) {
  MotionGroup& group = groups_->groups().front();
  if (group.freedoms() == 0) return {};
  Spectrum spectrum(*this, group);
  if (Report start = spectrum.start(); !start.ok()) return start;
  Search search(*this, spectrum, group.freedoms(), go_on);
  if (Report found = search.find(); !found.ok()) return found;
  for (const Search::Root& root : search.roots())
    loads.push_back({root.distance, spectrum.shape(options_.present + root.distance, root.number)});
  return {};
}

}  // namespace catena
