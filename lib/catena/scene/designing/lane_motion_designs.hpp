// Motions of the designs of a sweep in lanes: one analysis kinematics or inverse_dynamics without events or work, of a
// mechanism that lanes know (analysis/batch/lane_program.hpp).
//
// The rows of all designs of a group are followed side by side; between its rows the motion of every design is looked
// at by the measures of analysis/measures/, at several instants at once.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/batch/lane_look.hpp"
#include "catena/analysis/measures/measure_set.hpp"
#include "catena/scene/designing/lane_designs.hpp"

namespace catena {

class LaneMotionDesigns : public LaneDesigns {
 public:
  /// As LaneDesigns::make(), of such an analysis.
  static std::unique_ptr<LaneDesigns> make(const AnalysisContext& context, std::string& why_not);
  void measure(std::span<const ParameterSeeds> designs, std::span<Outcome> outcomes) override;

 private:
  struct Lane {
    AnalysisTask task;
    std::shared_ptr<const Model> model;
    std::vector<double> instants;
    double length_scale = 1;
  };
  LaneMotionDesigns(const AnalysisContext& context, std::shared_ptr<const Model> model,
                    std::shared_ptr<const Plan> plan, std::unique_ptr<const LaneProgram> program,
                    std::unique_ptr<MeasureSet> measures);
  /// Model and instants of a design; empty, or why it cannot be in a lane.
  std::string prepare(Lane& lane, const ParameterSeeds& seeds);
  void take_model(const Model& model);
  /// Assembles those whose given configuration is far; takes out those that cannot be.
  unsigned assemble(unsigned lanes, std::span<Outcome> outcomes);
  void take_measures(int lane, Outcome& outcome);
  /// The rows of a design and the motion between them; false where it is lost.
  bool follow_rows(const std::vector<double>& instants);
  AnalysisContext context_of(const Lane& lane);

  const AnalysisContext& outer_;
  std::shared_ptr<const Model> model_;  // of the scene as it is
  std::unique_ptr<const LaneProgram> program_;
  std::unique_ptr<MeasureSet> measures_;
  EvaluationWork evaluation_;
  Evaluator evaluator_;
  LaneMotion motion_;
  LaneLook look_;
  std::array<Lane, static_cast<std::size_t>(lane_count)> lanes_;
  SystemState start_;
};

}  // namespace catena
