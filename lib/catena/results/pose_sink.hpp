// Takes the poses of the bodies that an analysis goes through, beside its rows: for drawings of the mechanism.
//
//   begin_poses   ( pose   shape* | watch_design ... add_design )*
//
// A timed analysis gives a pose a row; modes and buckling the one pose about which the shapes are; optimisations and
// sweeps designs, each with analyses of its own. Nothing is computed for a pose sink unless there is one.
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catena/base/row_sink.hpp"
#include "catena/columns/snapshot.hpp"
#include "catena/results/analysis_result.hpp"

namespace catena {

class PoseSink;

/// Watches the analyses of one design, in order; several designs may be analysed at once.
class DesignSink {
 public:
  virtual ~DesignSink() = default;
  /// The sink for the rows of the analysis that begins; valid until end_analysis.
  virtual RowSink& begin_analysis(std::string_view type) = 0;
  virtual void end_analysis(const AnalysisResult& result) = 0;
  /// For the poses of this design's analyses.
  virtual PoseSink& poses() = 0;
};

/// What tells one design of an analysis from another.
struct DesignLabel {
  std::string name;                                    ///< "start", "best", "design 7"
  std::int64_t row = -1;                               ///< its row of the analysis; -1: it has none of its own
  std::vector<std::pair<std::string, double>> values;  ///< of the parameters in which designs differ
};

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
  /// What watches design `number` of `count` of the present analysis; nullptr where it is not wanted. Several threads
  /// may ask at once.
  virtual std::unique_ptr<DesignSink> watch_design(std::int64_t number, std::int64_t count) const = 0;
  /// A design that was watched, once its analyses are done.
  virtual void add_design(DesignLabel label, std::unique_ptr<DesignSink> design) = 0;
};

}  // namespace catena
