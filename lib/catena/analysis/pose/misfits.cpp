#include "catena/analysis/pose/misfits.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/pose/scaling.hpp"
#include "catena/analysis/run/name_list.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

// A large scene gets fewer steps: each costs a factorization.
constexpr int most_steps = 600, least_steps = 60, steps_times_rows = 4000000;
// eps as a part of the largest misfit at the start: first value, factor, last value.
constexpr double first_smoothing = 0.1, smoothing_fall = 0.3, last_smoothing = 1e-6;
constexpr double enough_progress = 1e-6;  // of the sum in one step: else eps falls
constexpr double turn_in_a_step = 0.3;    // rad, in one step
constexpr double most_damping = 1e8;
// Of the largest misfit: below it a constraint counts as met.
constexpr double negligible = 1e-3;
// Of the largest multiplier: above it a constraint takes part in the conflict.
constexpr double carries = 1e-2;

class MisfitSearch {
 public:
  MisfitSearch(Evaluator& evaluator, ConstraintSolver& solver, std::span<double> q)
      : evaluator_(evaluator),
        plan_(evaluator.plan()),
        scaling_(plan_, evaluator.length_scale()),
        solver_(solver),
        q_(q),
        trial_(q.begin(), q.end()),
        values_(at(plan_.trash_slot()) + 1),
        phi_(at(plan_.rows)),
        compliance_(phi_),
        lambda_(phi_),
        step_(at(3 * plan_.moving)),
        steps_left_(std::clamp(steps_times_rows / std::max(plan_.rows, 1), least_steps, most_steps)) {
    evaluator_.start_jacobian(values_);
  }

  void minimise() {
    double now = cost(q_, 0);
    const double largest = scaling_.row_norm(phi_);
    if (!std::isfinite(now) || !(now > 0)) return;
    double damping = 1;
    for (double eps = first_smoothing * largest; eps > last_smoothing * largest; eps *= smoothing_fall) {
      now = cost(q_, eps);
      while (steps_left_ > 0) {
        const double then = step(now, eps, damping);
        if (!(then < now * (1 - enough_progress))) break;
        now = then;
      }
    }
    cost(q_, 0);
  }

  /// At the configuration of the last cost().
  std::vector<Misfit> rank() const {
    std::vector<Misfit> misfits;
    for_each_element([&](int first, int last) {
      Misfit misfit{plan_.row_element[at(first)], 0, true};
      // An element with both kinds of equations, a weld, is ranked by the larger one.
      double square[2] = {0, 0}, worst[2] = {0, 0};
      for (int r = first; r < last; ++r) {
        const bool angle = plan_.row_is_angle[at(r)];
        square[angle] += phi_[at(r)] * phi_[at(r)];
        worst[angle] = std::max(worst[angle], std::abs(phi_[at(r)]) * scaling_.row_unit(r));
      }
      misfit.angle = worst[1] > worst[0];
      misfit.size = std::sqrt(square[misfit.angle]);
      misfits.push_back(misfit);
    });
    const auto size = [&](const Misfit& m) { return m.angle ? m.size : m.size / evaluator_.length_scale(); };
    std::stable_sort(misfits.begin(), misfits.end(),
                     [&](const Misfit& a, const Misfit& b) { return size(a) > size(b); });
    std::size_t kept = std::min(NameList::most, misfits.size());
    while (kept > 1 && size(misfits[kept - 1]) < negligible * size(misfits.front())) --kept;
    misfits.resize(kept);
    return misfits;
  }

  /// Elements with multipliers in the last step; of an unmet constraint they are of size 1 in scaled rows.
  std::vector<int> carriers() const {
    std::vector<double> share;
    std::vector<int> elements;
    double largest = 0;
    for_each_element([&](int first, int last) {
      double square = 0;
      for (int r = first; r < last; ++r) {
        const double size = lambda_[at(r)] / scaling_.row_unit(r);
        square += size * size;
      }
      share.push_back(std::sqrt(square));
      elements.push_back(plan_.row_element[at(first)]);
      largest = std::max(largest, share.back());
    });
    std::vector<int> carrying;
    for (std::size_t k = 0; k < share.size(); ++k) {
      if (share[k] > carries * largest) carrying.push_back(elements[k]);
    }
    std::sort(carrying.begin(), carrying.end());
    return carrying;
  }

 private:
  template <class F>
  void for_each_element(F&& f) const {
    for (int first = 0; first < plan_.rows;) {
      int last = first + 1;
      while (last < plan_.rows && plan_.row_element[at(last)] == plan_.row_element[at(first)]) ++last;
      f(first, last);
      first = last;
    }
  }
  double size_of(int first, int last) const {
    double square = 0;
    for (int r = first; r < last; ++r) {
      const double size = phi_[at(r)] * scaling_.row_unit(r);
      square += size * size;
    }
    return std::sqrt(square);
  }
  double cost(std::span<const double> q, double eps) {
    evaluator_.set_configuration(q);
    evaluator_.phi(phi_);
    double sum = 0;
    for_each_element([&](int first, int last) { sum += std::hypot(size_of(first, last), eps); });
    return sum;
  }

  /// One damped step from q_, which moves if the cost falls. Returns the cost there; `damping` adapts.
  double step(double now, double eps, double& damping) {
    evaluator_.set_configuration(q_);
    evaluator_.phi(phi_);
    evaluator_.jacobian(values_);
    const std::vector<double> phi = phi_;
    std::vector<double> softness(phi_.size());
    for_each_element([&](int first, int last) {
      const double size = std::hypot(size_of(first, last), eps);
      for (int r = first; r < last; ++r) softness[at(r)] = size / (scaling_.row_unit(r) * scaling_.row_unit(r));
    });
    for (; damping <= most_damping && steps_left_ > 0; damping *= 10) {
      --steps_left_;
      for (std::size_t r = 0; r < softness.size(); ++r) compliance_[r] = damping * softness[r];
      if (!solver_.factorize_compliant(values_, compliance_, evaluator_.counters)) continue;
      solver_.solve(phi, step_, lambda_, evaluator_.counters);
      double turn = 0;
      for (std::size_t c = 2; c < step_.size(); c += 3) turn = std::max(turn, std::abs(step_[c]));
      const double factor = turn > turn_in_a_step ? turn_in_a_step / turn : 1;
      std::copy(q_.begin(), q_.end(), trial_.begin());
      for (std::size_t c = 0; c < step_.size(); ++c) trial_[c] -= factor * step_[c];
      const double then = cost(trial_, eps);
      if (!(then < now)) continue;
      std::copy(trial_.begin(), trial_.end(), q_.begin());
      damping = std::max(damping / 10, 1e-8);
      return then;
    }
    damping = 1;
    return now;
  }

  Evaluator& evaluator_;
  const Plan& plan_;
  Scaling scaling_;
  ConstraintSolver& solver_;
  std::span<double> q_;
  std::vector<double> trial_, values_, phi_, compliance_, lambda_, step_;
  int steps_left_;
};

}  // namespace

Conflict find_conflict(Evaluator& evaluator, ConstraintSolver& solver, std::span<double> q) {
  MisfitSearch search(evaluator, solver, q);
  search.minimise();
  return {search.rank(), search.carriers()};
}

std::string describe_misfits(const Model& model, std::span<const Misfit> misfits) {
  std::string text;
  for (const Misfit& m : misfits) {
    if (!text.empty()) text += ", ";
    text += fmt::format("{} \"{}\" misses by {:.3g} {}", model.element_type(m.element), model.element_name(m.element),
                        m.size, m.angle ? "rad" : "m");
    if (text.size() > 300) break;
  }
  return text;
}

std::string describe_held(const Model& model) {
  NameList names;
  const auto add = [&](bool held, std::size_t body, const char* column) {
    if (held) names.add_text(fmt::format("{}.{}", model.body_name(static_cast<int>(body)), column));
  };
  for (std::size_t b = 0; b < model.bodies.size(); ++b) {
    add(model.bodies[b].hold_x, b, "x");
    add(model.bodies[b].hold_y, b, "y");
    add(model.bodies[b].hold_angle, b, "angle");
  }
  return names.count() > 0 ? fmt::format("\"hold\" does not let assembly change {}; or ", names.text()) : "";
}

std::string describe_cause(const Model& model, const Conflict& conflict) {
  std::vector<int> drivers, others;
  for (int element : conflict.elements) {
    (model.elements[at(element)].kind == ElementKind::driver ? drivers : others).push_back(element);
  }
  const auto list = [&](const std::vector<int>& elements) { return element_names(model, elements); };
  if (drivers.size() > 1) {
    return fmt::format("the drivers {} contradict each other, or an estimate too far off", list(drivers));
  }
  if (drivers.size() == 1) {
    return fmt::format("driver {} asks for a position that the lengths do not allow, or an estimate too far off",
                       list(drivers));
  }
  return fmt::format("lengths that do not fit among {}, or an estimate too far off", list(others));
}

}  // namespace catena
