// Checkpoints of a scene's run: the file, the run it belongs to, and the state from which a run is resumed.
//
// A checkpoint belongs to the scene's text, that of the files that it names, the parameters and the analysis of the
// command line, and the number of the analysis: with anything else it is refused.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <string_view>

#include "catena/results/checkpoint.hpp"
#include "catena/scene/running/scene_runner.hpp"

namespace catena {

/// What an analysis that can pause is asked for.
struct CheckpointRequest {
  double every = 0;                        ///< s; 0: a twentieth of the analysis
  std::optional<Checkpoint> restart = {};  ///< where it is taken up
  /// Takes what is to be saved, and when the analysis began.
  std::function<void(double begin, const MotionMemory& motion)> save = {};
};

class SceneCheckpoints {
 public:
  explicit SceneCheckpoints(const RunOptions& options) : options_(options) {}

  /// Whether analyses must pause: checkpoints are written, or the run goes on from one that was.
  bool wanted() const { return !options_.checkpoint.empty() || restart_; }
  /// Reads the file to go on from and tries the one to write. `texts`: the scene's and those of the files that it
  /// names. Throws CheckpointError.
  void prepare(std::span<const std::string_view> texts);
  /// Number of the analysis with which the run begins.
  int first_analysis() const { return restart_ ? restart_->analysis : 0; }
  /// Valid as long as this object.
  CheckpointRequest request(int analysis) const;

 private:
  const RunOptions& options_;
  std::string owner_;
  std::optional<Checkpoint> restart_;
};

}  // namespace catena
