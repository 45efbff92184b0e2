#include "catena/scene/judging/taut_ropes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "catena/analysis/kinematics/kinematics.hpp"
#include "catena/analysis/run/name_list.hpp"
#include "catena/analysis/run/row_observer.hpp"
#include "catena/analysis/run/thresholds.hpp"
#include "catena/base/at.hpp"

namespace catena {
namespace {

AnalysisReport look_at_start(Kinematics& analysis, const SystemState& from) {
  analysis.start_from(from);
  RowFunction nothing([](const Snapshot&) { return true; });
  return analysis.run(TimeGrid::instant(from.t), {}, nothing);
}

}  // namespace

TautRopes::TautRopes(std::shared_ptr<const Model> model, const PlanOptions& without, const SystemState& from)
    : model_(std::move(model)) {
  for (const int element : model_->gaps()) {
    const std::string_view type = model_->element_type(element);
    if (type == "rope" || type == "cable") pulled_.push_back({element});
  }
  if (any()) find(without, from);
}

void TautRopes::find(const PlanOptions& without, const SystemState& from) {
  Kinematics alone(model_, without);
  if (look_at_start(alone, from).status != Status::under_driven) return pulled_.clear();
  std::erase_if(pulled_, [&](const Pulled& rope) {
    const Evaluator& evaluator = alone.evaluator();
    return std::abs(evaluator.measure(rope.element, {}, {}).value) > thresholds::closed_gap * evaluator.length_scale();
  });
  if (!any()) return;
  PlanOptions with = without;
  add_rows(with);
  Kinematics tied(model_, with);
  const AnalysisReport report = look_at_start(tied, from);
  const auto is_redundant = [&](const Pulled& rope) {
    const std::string name = model_->element_name(rope.element);
    return std::find(report.redundant.begin(), report.redundant.end(), name) != report.redundant.end();
  };
  if (report.status == Status::under_driven || std::any_of(pulled_.begin(), pulled_.end(), is_redundant))
    pulled_.clear();
}

void TautRopes::add_rows(PlanOptions& options) const {
  for (const Pulled& rope : pulled_) {
    std::erase(options.released_elements, rope.element);
    options.keep_elements.push_back(rope.element);
    options.one_sided = true;
  }
}

std::string TautRopes::names() const {
  NameList names;
  for (const Pulled& rope : pulled_) names.add(model_->element_name(rope.element));
  return names.text();
}

void TautRopes::observe(const Snapshot& row) {
  if (row.lambda.empty()) return;
  for (Pulled& rope : pulled_) {
    const int equation = row.evaluator.plan().element_row[at(rope.element)];
    const double tension = -row.lambda[at(equation)];
    largest_ = std::max(largest_, std::abs(tension));
    if (tension < rope.least) rope.least = tension, rope.t = row.t;
  }
}

std::vector<std::string> TautRopes::warnings() const {
  if (!any()) return {};
  std::vector<std::string> sentences{
      fmt::format("{} {} taken to stay taut: without {} constraints and drivers do not determine the motion", names(),
                  pulled_.size() == 1 ? "is" : "are", pulled_.size() == 1 ? "it" : "them")};
  for (const Pulled& rope : pulled_) {
    if (!(rope.least < -thresholds::no_force * largest_)) continue;
    sentences.push_back(fmt::format(
        "{} \"{}\" would have to push, by up to {:.4g} N (at t = {:.6g} s), and becomes slack in truth: take "
        "dynamics there",
        model_->element_type(rope.element), model_->element_name(rope.element), -rope.least, rope.t));
  }
  return sentences;
}

}  // namespace catena
