// How many digits of a motion's columns are right is found from the error that is carried along with one run
// (motion_accuracy.hpp, accuracy_of_islands.hpp), or from a second run (second_run.hpp) where contacts and events
// change the mechanism, with which the carried error is lost, and for methods that do not tell their own; where `auto`
// may turn to one of these after the run alone (accuracy_by_choice.hpp).
#pragma once

#include <algorithm>
#include <atomic>
#include <memory>
#include <type_traits>
#include <utility>

#include "catena/analysis/accuracy/accuracy_by_choice.hpp"
#include "catena/analysis/accuracy/accuracy_of_islands.hpp"
#include "catena/analysis/accuracy/motion_accuracy.hpp"
#include "catena/analysis/accuracy/second_run.hpp"

namespace catena {

/// A motion as it is asked for.
struct AskedMotion {
  const ColumnSources& sources;
  const SystemState& start;
  const TimeGrid& grid;
  const DynamicsOptions& options;
  bool changes = false;  ///< it has contacts or friction, or events that act
  const std::atomic<bool>* cancel = nullptr;
};

/// The method in use; of mechanisms integrated apart that of the first, which differ in what `auto` chooses alone.
template <class Analysis>
IntegrationMethod used_method(const Analysis& analysis) {
  if constexpr (std::is_same_v<Analysis, DynamicsOfIslands>)
    return analysis.methods().front();
  else
    return analysis.method();
}

/// Whether errors of its steps cannot be carried along with this method.
inline bool carries_no_error(IntegrationMethod method) {
  return method != IntegrationMethod::automatic && method != IntegrationMethod::rk8 && method != IntegrationMethod::rk5;
}
inline bool has_adaptive_implicit_steps(IntegrationMethod method) {
  return method == IntegrationMethod::radau || method == IntegrationMethod::alpha;
}

/// Whether a method that was asked for keeps to its tolerance less surely than order 8 does. Of rk5 places were 34
/// tolerances off after three turns of a Kepler ellipse.
inline bool may_be_off(const DynamicsOptions& options) {
  return options.step == 0 && (options.method == IntegrationMethod::rk5 || options.method == IntegrationMethod::adams ||
                               has_adaptive_implicit_steps(options.method));
}
/// Whether the error that was carried along does not tell that a motion keeps to it: claims are optimistic by up to 7.
template <class Analysis>
bool is_doubtful(const RowAccuracy& carried, double tolerance) {
  if constexpr (std::is_same_v<Analysis, DynamicsOfIslands>)
    return true;
  else
    return !(static_cast<const MotionAccuracy&>(carried).error_of_places() <= 2 * tolerance);
}

/// Of the error that is carried along with it.
template <class Analysis>
std::unique_ptr<RowAccuracy> carried_accuracy(Analysis& analysis, const ColumnSet& columns,
                                              const ColumnSources& sources) {
  if constexpr (std::is_same_v<Analysis, DynamicsOfIslands>)
    return std::make_unique<AccuracyOfIslands>(analysis, columns, sources);
  else
    return std::make_unique<MotionAccuracy>(analysis, columns);
}

/// Of analysis.run(), which follows; both must outlive the result, and the columns. `make`: another analysis of the
/// same model, with other options.
template <class Analysis, class Make>
std::unique_ptr<RowAccuracy> accuracy_of_motion(Analysis& analysis, const ColumnSet& columns, const AskedMotion& motion,
                                                Make make) {
  const IntegrationMethod method = used_method(analysis);
  const auto is_implicit = [&analysis] { return std::ranges::any_of(analysis.methods(), has_adaptive_implicit_steps); };
  const auto turned = [&analysis] { return std::ranges::any_of(analysis.methods(), carries_no_error); };
  const auto is_smooth = [&analysis] { return analysis.singular_points().empty() && analysis.jolts().empty(); };
  const auto second = [start = motion.start, grid = motion.grid, coarser = coarser_options(motion.options), make,
                       is_implicit](const Needs& needs, RowObserver& observer, bool by_other_method) {
    DynamicsOptions options = coarser;
    if (by_other_method && is_implicit())
      options.tolerance = std::max(options.tolerance / 100, DynamicsOptions::least_tolerance);
    else if (by_other_method)
      options.method = options.method == IntegrationMethod::rk5 ? IntegrationMethod::rk8 : IntegrationMethod::rk5;
    const auto other = make(options);
    other->start_from(start);
    AnalysisReport report = other->run(grid, needs, observer);
    return SecondRun::Motion{std::move(report), changes_of(*other), MotionRounding(other->evaluator()),
                             options.tolerance};
  };
  const auto proceed = [cancel = motion.cancel] { return !(cancel && cancel->load(std::memory_order_relaxed)); };
  const auto first = [&analysis] { return changes_of(analysis); };
  const bool wants_second = motion.changes || carries_no_error(method);
  const bool may_turn = motion.options.method == IntegrationMethod::automatic && motion.options.may_turn_implicit &&
                        motion.options.step == 0;
  const bool may_doubt = may_be_off(motion.options);
  if (!wants_second && !may_turn && !may_doubt) return carried_accuracy(analysis, columns, motion.sources);
  const bool is_checked = may_doubt || (has_adaptive_implicit_steps(method) && motion.options.step == 0);
  auto runs = std::make_unique<SecondRun>(
      columns, SecondRun::Runs{first, second, proceed, is_checked ? motion.options.tolerance : 0},
      method == IntegrationMethod::baumgarte);
  if (wants_second) return runs;
  auto carried = carried_accuracy(analysis, columns, motion.sources);
  const auto may_repeat = [may_turn, is_smooth] { return may_turn && is_smooth(); };
  const auto doubted = [may_doubt, &carried = *carried, tolerance = motion.options.tolerance] {
    return may_doubt && is_doubtful<Analysis>(carried, tolerance);
  };
  return std::make_unique<AccuracyByChoice>(std::move(carried), std::move(runs), turned, may_repeat, doubted);
}

}  // namespace catena
