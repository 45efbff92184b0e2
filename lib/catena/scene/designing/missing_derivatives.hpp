// Which derivatives of the analyses of a design are not those of their equations alone.
//
// Numbers of an analysis may depend on parameters ("until": "=T"), and an analysis may go on from the end of another,
// which moves with the parameters. Where the part of a measure's derivative that follows from this is known it is
// added,
//
//   dm/dp = (dm/dp) at fixed instants + (dm/dT) dT/dp       T the last instant of the run,
//
// and elsewhere the derivative is taken out, with the reason: half a derivative would be a wrong one.
#pragma once

#include <string>
#include <vector>

#include "catena/scene/running/analysis_run.hpp"

namespace catena {

class MissingDerivatives {
 public:
  /// Both must outlive this object.
  MissingDerivatives(const SceneModels& models, const DesignRequest& design)
      : models_(models), design_(design), why_(design.parameters.size()) {}

  /// Completes the gradients of this analysis, or takes them out.
  void complete(const AnalysisTask& task, const ParameterSeeds& seeds, AnalysisResult& result) const;
  /// This analysis has ended, and the next one goes on from there with these values.
  void go_on_from(const AnalysisTask& task, const ParameterSeeds& seeds, const ParameterSeeds& values_at_end);
  /// The next analysis starts from the scene.
  void start_anew();

 private:
  void take_out(MeasureResult& measure, std::size_t parameter, const std::string& why, AnalysisResult& result) const;

  const SceneModels& models_;
  const DesignRequest& design_;
  std::vector<std::string> why_;  // by parameter: why what goes on from here has no derivative; empty where it has
  std::string before_;            // type of the analysis that left the state behind; empty: the scene's own
};

}  // namespace catena
