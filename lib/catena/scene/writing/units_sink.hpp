// Passes results on in the units that were asked for: columns, measures, least and largest values, each of which tells
// its unit. Other named results stay in SI.
#pragma once

#include <vector>

#include "catena/results/result_sink.hpp"
#include "catena/scene/numbers/output_units.hpp"

namespace catena {

class UnitsSink final : public ResultSink, private RowSink {
 public:
  /// Whether the units that a scene wants its results shown in count where `wishes` say nothing.
  enum class Scene { counts, is_passed_over };
  UnitsSink(ResultSink& target, OutputUnits::Wishes wishes, Scene scene = Scene::counts)
      : target_(target), wishes_(std::move(wishes)), scene_(scene) {}

  void begin_run(const RunHeader& header) override;
  RowSink& begin_analysis(std::string_view type) override;
  void end_analysis(const AnalysisResult& result) override;
  void end_run() override { target_.end_run(); }

 private:
  void begin(std::span<const ColumnInfo> columns) override;
  bool row(std::span<const double> values) override;

  ResultSink& target_;
  OutputUnits::Wishes wishes_;
  Scene scene_;
  OutputUnits units_;
  RowSink* rows_ = nullptr;
  std::vector<double> factor_, row_;  // by column
};

}  // namespace catena
