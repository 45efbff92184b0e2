// One file of rows an analysis, in a folder: kinematics.csv, kinematics-2.csv, equilibrium.csv, in the order of the
// run.
//
// The folder is made if it is missing. A failure to write is remembered and reported at the end; the run goes on.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "catena/results/result_sink.hpp"
#include "catena/results/row_writer.hpp"

namespace catena {

class RowFiles final : public ResultSink, private RowSink {
 public:
  /// `extension`: of the files, ".csv".
  RowFiles(std::string path, std::string extension, MakeRowWriter make)
      : path_(std::move(path)), extension_(std::move(extension)), make_(std::move(make)) {}

  void begin_run(const RunHeader& header) override;
  RowSink& begin_analysis(std::string_view type) override;
  void end_analysis(const AnalysisResult& result) override;
  void end_run() override {}

  /// Paths of the files that were completed.
  const std::vector<std::string>& files() const { return files_; }
  /// The first thing that could not be written; empty if everything was.
  const std::string& error() const { return error_; }

 private:
  // A file is opened with the first line, so that an analysis without rows leaves none.
  void begin(std::span<const ColumnInfo> columns) override;
  bool row(std::span<const double> values) override;

  std::string path_, extension_, error_;
  MakeRowWriter make_;
  std::map<std::string, int, std::less<>> count_;  // analyses so far, by type
  std::string file_name_;                          // of the analysis that runs
  std::optional<TextOutput> output_;
  std::unique_ptr<RowWriter> writer_;
  std::vector<std::string> files_;
};

}  // namespace catena
