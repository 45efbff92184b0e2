// One CSV file an analysis, in a folder: kinematics.csv, kinematics-2.csv, equilibrium.csv, in the order of the run.
//
// The folder is made if it is missing. A failure to write is remembered and reported at the end; the run goes on.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "catena/results/csv_writer.hpp"
#include "catena/results/result_sink.hpp"

namespace catena {

class CsvDirectory final : public ResultSink, private RowSink {
 public:
  explicit CsvDirectory(std::string path) : path_(std::move(path)) {}

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

  std::string path_, error_;
  std::map<std::string, int, std::less<>> count_;  // analyses so far, by type
  std::string file_name_;                          // of the analysis that runs
  std::optional<TextOutput> output_;
  std::optional<CsvWriter> writer_;
  std::vector<std::string> files_;
};

}  // namespace catena
