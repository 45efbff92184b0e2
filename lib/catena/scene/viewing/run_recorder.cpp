#include "catena/scene/viewing/run_recorder.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "catena/columns/reaction.hpp"
#include "catena/elements/all.hpp"
#include "catena/model/attachment.hpp"

namespace catena {
namespace {

constexpr double none = std::numeric_limits<double>::quiet_NaN();

PoseLayout layout_of(const Model& model, std::size_t most) {
  PoseLayout layout{.bodies = model.bodies.size()};
  layout.arrows = model.bodies.size() + model.elements.size() <= most;
  if (!layout.arrows) return layout;
  for (int e = 0; e < static_cast<int>(model.elements.size()); ++e) {
    const ElementRecord& record = model.elements[static_cast<std::size_t>(e)];
    if (record.kind == ElementKind::constraint || record.kind == ElementKind::driver) layout.reactions.push_back(e);
    if (model.element_type(e) == PointForce<>::type) layout.loads.push_back(e);
  }
  return layout;
}

}  // namespace

RowSink& RunRecorder::begin_analysis(std::string_view type) {
  RecordedAnalysis& analysis = record_.analyses.emplace_back();
  analysis.result.type = type;
  analysis.model = record_.model;
  analysis.rows = ThinnedRows(limits_.column_values);
  analysis.poses = ThinnedRows(limits_.pose_values);
  return *this;
}

void RunRecorder::end_analysis(const AnalysisResult& result) { current().result = result; }

void RunRecorder::begin(std::span<const ColumnInfo> columns) {
  current().columns_kept = std::min(columns.size(), limits_.columns);
  current().rows.begin(current().columns_kept);
}

bool RunRecorder::row(std::span<const double> values) {
  current().rows.add(values.first(current().columns_kept));
  return true;
}

void RunRecorder::begin_poses(std::shared_ptr<const Model> model) {
  if (record_.analyses.empty()) {
    record_.model = std::move(model);
    return;
  }
  current().layout = layout_of(*model, limits_.arrow_parts);
  current().model = std::move(model);
  // Coordinates take two bytes where they are many, arrows four always.
  current().poses = ThinnedRows(current().layout.arrows ? limits_.pose_values / 2 : limits_.pose_values);
  current().poses.begin(current().layout.width());
}

Needs RunRecorder::needs() const {
  const bool arrows = !record_.analyses.empty() && record_.analyses.back().layout.arrows;
  return {.velocity = arrows, .acceleration = false, .multipliers = arrows, .work = false};
}

void RunRecorder::pose(const Snapshot& snapshot) {
  const PoseLayout& layout = current().layout;
  const std::vector<int>& plan_body = snapshot.evaluator.plan().plan_body;
  pose_.assign(layout.width(), none);
  pose_[PoseLayout::time] = snapshot.t;
  for (std::size_t b = 0; b < layout.bodies; ++b) {
    const Frame<double> frame = snapshot.evaluator.ground_frame(plan_body[b]);
    pose_[PoseLayout::frames + 3 * b] = frame.x;
    pose_[PoseLayout::frames + 3 * b + 1] = frame.y;
    pose_[PoseLayout::frames + 3 * b + 2] = frame.phi;
  }
  if (layout.arrows) {
    take_velocities(snapshot);
    take_reactions(snapshot);
    take_loads(snapshot);
  }
  current().poses.add(pose_);
}

void RunRecorder::take_velocities(const Snapshot& snapshot) {
  if (snapshot.qd.empty()) return;
  const PoseLayout& layout = current().layout;
  for (std::size_t b = 0; b < layout.bodies; ++b) {
    const auto p = static_cast<std::size_t>(snapshot.evaluator.plan().plan_body[b]);
    for (std::size_t k = 0; k < 3; ++k) pose_[layout.velocities() + 3 * b + k] = snapshot.qd[3 * p + k];
  }
}

// An element whose bodies are welded or fixed may have no rows of its own; its reaction is then not known.
void RunRecorder::take_reactions(const Snapshot& snapshot) {
  if (snapshot.lambda.empty()) return;
  const PoseLayout& layout = current().layout;
  const Plan& plan = snapshot.evaluator.plan();
  for (std::size_t k = 0; k < layout.reactions.size(); ++k) {
    const int element = layout.reactions[k];
    if (plan.element_row[static_cast<std::size_t>(element)] < 0) continue;
    const Reaction reaction = element_reactions(snapshot, element).on_j;
    const Attachment attachment = attachment_of(snapshot.evaluator.model(), element);
    const bool on_i = attachment.bodies == 1;
    const int body = on_i ? attachment.i : attachment.j;
    const int p = body < 0 ? plan.bodies : plan.plan_body[static_cast<std::size_t>(body)];
    const Vec2<double> place = snapshot.evaluator.ground_frame(p).point(on_i ? attachment.point_i : attachment.point_j);
    const double values[] = {place.x, place.y, reaction.force.x, reaction.force.y};
    std::copy(std::begin(values), std::end(values),
              pose_.begin() + static_cast<std::ptrdiff_t>(layout.reaction_forces() + 4 * k));
  }
}

void RunRecorder::take_loads(const Snapshot& snapshot) {
  const PoseLayout& layout = current().layout;
  const Model& model = snapshot.evaluator.model();
  std::size_t at = layout.load_forces();
  for (const int element : layout.loads) {
    const Vec2<double> load = load_at(model, element, snapshot.t);
    pose_[at++] = load.x;
    pose_[at++] = load.y;
  }
}

void RunRecorder::shape(const Evaluator& evaluator, std::span<const double> rates) {
  std::vector<double> changes;
  for (const int p : evaluator.plan().plan_body) {
    for (std::size_t k = 0; k < 3; ++k) changes.push_back(rates[3 * static_cast<std::size_t>(p) + k]);
  }
  current().shapes.push_back(std::move(changes));
}

/// A recorder of its own for one design, with a share of the room.
class RunRecorder::OfDesign final : public DesignSink {
 public:
  explicit OfDesign(const RecordLimits& limits) : recorder_(limits) {}

  RowSink& begin_analysis(std::string_view type) override { return recorder_.begin_analysis(type); }
  void end_analysis(const AnalysisResult& result) override { recorder_.end_analysis(result); }
  PoseSink& poses() override { return recorder_; }
  std::vector<RecordedAnalysis>& analyses() { return recorder_.record_.analyses; }

 private:
  RunRecorder recorder_;
};

std::unique_ptr<DesignSink> RunRecorder::watch_design(std::int64_t number, std::int64_t count) const {
  const std::size_t parts = record_.model->bodies.size() + record_.model->elements.size();
  const std::size_t most = std::min(limits_.designs, limits_.design_parts / std::max<std::size_t>(parts, 1));
  constexpr std::size_t fewest = 2;  // one design alone cannot be compared
  if (most < fewest) return nullptr;
  const std::int64_t stride = (count + static_cast<std::int64_t>(most) - 1) / static_cast<std::int64_t>(most);
  if (number % std::max<std::int64_t>(stride, 1) != 0) return nullptr;
  RecordLimits share = limits_;
  share.pose_values /= 2 * limits_.designs;
  share.column_values /= 2 * limits_.designs;
  return std::make_unique<OfDesign>(share);
}

void RunRecorder::add_design(DesignLabel label, std::unique_ptr<DesignSink> design) {
  // Only watch_design() makes them.
  current().designs.push_back({std::move(label), std::move(static_cast<OfDesign&>(*design).analyses())});
}

std::vector<Frame<double>> frames_of(const PoseLayout& layout, std::span<const double> pose) {
  std::vector<Frame<double>> frames;
  for (std::size_t b = 0; b < layout.bodies; ++b) {
    const auto q = pose.subspan(PoseLayout::frames + 3 * b, 3);
    frames.push_back(make_frame(q[0], q[1], q[2]));
  }
  return frames;
}

std::vector<Frame<double>> given_poses(const Model& model) {
  std::vector<Frame<double>> frames;
  for (int b = 0; b < static_cast<int>(model.bodies.size()); ++b) frames.push_back(model.frame(b));
  return frames;
}

Vec2<double> load_at(const Model& model, int element, double t) {
  const ElementRecord& record = model.elements[static_cast<std::size_t>(element)];
  const auto& list = std::get<std::vector<ElementEntry<PointForce<double>, double>>>(model.forces);
  double components[2];
  for (std::size_t k = 0; k < 2; ++k) {
    const FunctionValue<double>& value = list[static_cast<std::size_t>(record.index)].values[k];
    // A law of state is not known from the time alone.
    components[k] = value.law >= 0 ? none : value.constant;
    if (value.function < 0) continue;
    const TimeFunction<double>& function = model.functions[static_cast<std::size_t>(value.function)];
    components[k] = function.domain().contains(t) ? function.evaluate(t).f : none;
  }
  return {components[0], components[1]};
}

}  // namespace catena
