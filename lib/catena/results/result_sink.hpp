// Receives the results of a whole run as they are computed: a table on the terminal, a JSON document, one file an
// analysis.
//
//   begin_run   ( begin_analysis   rows into the RowSink   end_analysis )*   end_run
//
// Rows are not kept unless a sink keeps them, so memory stays bounded however long a run is. Between begin_analysis and
// end_analysis an analysis that fails early may send no row, nor call RowSink::begin at all.
#pragma once

#include <array>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "catena/base/row_sink.hpp"
#include "catena/results/analysis_result.hpp"

namespace catena {

/// The data of a run known before its first analysis.
struct RunHeader {
  std::string scene;  ///< its name; that of the file if it has none
  std::string description;
  std::array<double, 2> gravity{};  ///< m/s^2
  int bodies = 0;
  int elements = 0;
  int analyses = 0;                                          ///< how many will be run
  std::string version;                                       ///< of the library
  std::vector<std::pair<std::string, double>> parameters{};  ///< names and values of the run, SI
  std::vector<std::pair<std::string, std::string>> set{};    ///< of them, what the caller set, as it was written
  std::vector<std::pair<std::string, std::string>> units{};  ///< in which the scene wants results shown, by kind
};

class ResultSink {
 public:
  virtual ~ResultSink() = default;
  virtual void begin_run(const RunHeader& header) = 0;
  /// The sink for the rows of the analysis that begins; valid until end_analysis.
  virtual RowSink& begin_analysis(std::string_view type) = 0;
  virtual void end_analysis(const AnalysisResult& result) = 0;
  virtual void end_run() = 0;
};

/// Passes all results to several sinks. A row sink that returns false stops the analysis for all.
class TeeSink final : public ResultSink, private RowSink {
 public:
  void add(ResultSink& sink) { sinks_.push_back(&sink); }

  void begin_run(const RunHeader& header) override;
  RowSink& begin_analysis(std::string_view type) override;
  void end_analysis(const AnalysisResult& result) override;
  void end_run() override;

 private:
  void begin(std::span<const ColumnInfo> columns) override;
  bool row(std::span<const double> values) override;

  std::vector<ResultSink*> sinks_;
  std::vector<RowSink*> rows_;  // of the analysis that runs
};

}  // namespace catena
