// Equilibria of the designs of a sweep in lanes: one analysis `equilibrium`, each from its given configuration, of a
// mechanism that lanes know (analysis/batch/lane_equilibrium.hpp).
//
// Every lane has an evaluator of its own, which gives its columns at the place of rest. Designs whose given
// configuration does not meet the constraints are assembled one by one before they are put into their lanes.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "catena/analysis/batch/lane_equilibrium.hpp"
#include "catena/analysis/measures/measure_set.hpp"
#include "catena/assembly/systems/kkt_matrix.hpp"
#include "catena/scene/designing/lane_designs.hpp"

namespace catena {

class LaneRestDesigns : public LaneDesigns {
 public:
  /// As LaneDesigns::make(), of an analysis `equilibrium`.
  static std::unique_ptr<LaneDesigns> make(const AnalysisContext& context, std::string& why_not);
  void measure(std::span<const ParameterSeeds> designs, std::span<Outcome> outcomes) override;

 private:
  struct Lane {
    AnalysisTask task;
    std::shared_ptr<const Model> model;
    EvaluationWork work{};
    std::optional<Evaluator> evaluator{};
    std::vector<double> start{}, q{};
  };
  LaneRestDesigns(const AnalysisContext& context, std::shared_ptr<const Model> model, std::shared_ptr<const Plan> plan,
                  std::unique_ptr<const LaneProgram> program, std::unique_ptr<MeasureSet> measures);
  /// Puts a design into a lane; empty, or why it cannot be there.
  std::string prepare(int lane, const ParameterSeeds& seeds);
  /// Takes out those that cannot be assembled.
  LaneSet assemble(LaneSet lanes, std::span<Outcome> outcomes);
  void take_measures(int lane, Outcome& outcome);

  const AnalysisContext& outer_;
  std::shared_ptr<const Model> model_;  // of the scene as it is
  std::shared_ptr<const Plan> plan_;
  std::unique_ptr<const LaneProgram> program_;
  std::unique_ptr<MeasureSet> measures_;
  KktMatrix matrix_;
  LaneEquilibrium search_;
  double tolerance_;
  bool is_linear_;  // the constraints of that model
  std::vector<double> lambda_;
  std::array<Lane, static_cast<std::size_t>(lane_count)> lanes_;
};

}  // namespace catena
