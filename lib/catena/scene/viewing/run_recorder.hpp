// A run kept in memory for pages, figures and plots: rows and poses of every analysis, within limits that are said.
//
// Poses are rows of numbers (PoseLayout): time, frames of the centroids, and for small scenes velocities, reactions and
// applied forces as well. Values that an analysis does not give are NaN. Lengths m, angles rad, forces N.
//
// Designs of optimisations and sweeps are runs within the run, each with a share of the room. Of many designs every
// second, third ... is kept.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "catena/results/pose_sink.hpp"
#include "catena/results/result_sink.hpp"
#include "catena/scene/viewing/thinned_rows.hpp"

namespace catena {

/// What is kept. The limits of values are those of a page of 80 MB: 2 bytes a coordinate of a body and 8 a value of a
/// column, a third more in base64, leave room for the names and shapes of 10^5 bodies.
struct RecordLimits {
  std::size_t pose_values = 18'000'000;
  std::size_t column_values = 1'500'000;
  std::size_t columns = 600;         ///< kept of an analysis, the first ones
  std::size_t arrow_parts = 4000;    ///< bodies and elements of scenes with arrows, which take 4 bytes a component
  std::size_t designs = 48;          ///< of an analysis: more cannot be told apart on parallel axes
  std::size_t design_parts = 20000;  ///< bodies and elements of all of them: each design has a drawing of its own
};

/// Where the parts of a pose stand in its row.
struct PoseLayout {
  std::size_t bodies = 0;
  bool arrows = false;
  std::vector<int> reactions{};  ///< elements with a reaction: force on body j, ground axes, and its place
  std::vector<int> loads{};      ///< elements with an applied force in the drawing, two values each

  static constexpr std::size_t time = 0, frames = 1;
  std::size_t velocities() const { return frames + 3 * bodies; }
  std::size_t reaction_forces() const { return velocities() + (arrows ? 3 * bodies : 0); }
  std::size_t load_forces() const { return reaction_forces() + 4 * reactions.size(); }
  std::size_t width() const { return load_forces() + 2 * loads.size(); }
};

struct RecordedDesign;

struct RecordedAnalysis {
  AnalysisResult result;
  std::shared_ptr<const Model> model;
  std::size_t columns_kept = 0;
  ThinnedRows rows;
  PoseLayout layout;
  ThinnedRows poses;
  std::vector<std::vector<double>> shapes;  ///< changes of the last pose's frames, three a body
  std::vector<RecordedDesign> designs;      ///< those that are kept, in order
};

struct RecordedDesign {
  DesignLabel label;
  std::vector<RecordedAnalysis> analyses;
};

struct RunRecord {
  RunHeader header;
  std::shared_ptr<const Model> model;  ///< of the scene; nullptr where it could not be read
  std::vector<RecordedAnalysis> analyses;
};

class RunRecorder final : public ResultSink, public PoseSink, private RowSink {
 public:
  explicit RunRecorder(const RecordLimits& limits = {}) : limits_(limits) {}

  const RunRecord& record() const { return record_; }

  void begin_run(const RunHeader& header) override { record_.header = header; }
  RowSink& begin_analysis(std::string_view type) override;
  void end_analysis(const AnalysisResult& result) override;
  void end_run() override {}

  void begin_poses(std::shared_ptr<const Model> model) override;
  void pose(const Snapshot& snapshot) override;
  void shape(const Evaluator& evaluator, std::span<const double> rates) override;
  Needs needs() const override;
  std::unique_ptr<DesignSink> watch_design(std::int64_t number, std::int64_t count) const override;
  void add_design(DesignLabel label, std::unique_ptr<DesignSink> design) override;

 private:
  class OfDesign;
  void begin(std::span<const ColumnInfo> columns) override;
  bool row(std::span<const double> values) override;
  void take_velocities(const Snapshot& snapshot);
  void take_reactions(const Snapshot& snapshot);
  void take_loads(const Snapshot& snapshot);
  RecordedAnalysis& current() { return record_.analyses.back(); }

  RecordLimits limits_;
  RunRecord record_;
  std::vector<double> pose_;  // kept for its memory
};

/// The frames of a pose, model order.
std::vector<Frame<double>> frames_of(const PoseLayout& layout, std::span<const double> pose);
/// The given configuration, and what forces act then.
std::vector<Frame<double>> given_poses(const Model& model);
/// Values of a load's functions at an instant; NaN where they have none.
Vec2<double> load_at(const Model& model, int element, double t);

}  // namespace catena
