// Where an analysis tells where the bodies are, beside its rows: for those who draw the mechanism.
//
//   begin_poses   ( pose   shape* )*
//
// A timed analysis gives a pose a row; modes and buckling the one pose about which the shapes are. Nothing is computed
// for a pose sink unless there is one.
#pragma once

#include <memory>
#include <span>

#include "catena/columns/snapshot.hpp"

namespace catena {

class PoseSink {
 public:
  virtual ~PoseSink() = default;
  /// The model of what comes: first that of the scene, then that of every analysis, in which parameters may differ.
  virtual void begin_poses(std::shared_ptr<const Model> model) = 0;
  /// A configuration, with what needs() asked for where the analysis can give it.
  virtual void pose(const Snapshot& snapshot) = 0;
  /// A motion from the last pose along which something is shown: rates of the plan's coordinates, m and rad.
  virtual void shape(const Evaluator& evaluator, std::span<const double> rates) = 0;
  /// What is to be computed beside what the columns need.
  virtual Needs needs() const = 0;
};

}  // namespace catena
