// The folder of -o: one CSV file an analysis, and report.json with the whole result document.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "catena/results/csv_directory.hpp"
#include "catena/results/result_sink.hpp"
#include "catena/results/text_output.hpp"

namespace catena::cli {

class ResultFolder final : public ResultSink {
 public:
  explicit ResultFolder(std::string path) : path_(std::move(path)), csv_(path_) {}

  void begin_run(const RunHeader& header) override;
  RowSink& begin_analysis(std::string_view type) override { return tee_.begin_analysis(type); }
  void end_analysis(const AnalysisResult& result) override { tee_.end_analysis(result); }
  void end_run() override;

  /// Why the folder, or the folder in which it would be made, cannot be written to; empty if it can. Creates nothing.
  static std::string obstacle(const std::string& path);
  /// Paths of the files that are complete.
  const std::vector<std::string>& files() const { return files_; }
  /// The first failure to write; empty if there was none.
  const std::string& error() const { return error_; }

 private:
  std::string path_;
  CsvDirectory csv_;
  std::optional<TextOutput> report_file_;
  std::unique_ptr<ResultSink> report_;
  TeeSink tee_;
  std::vector<std::string> files_;
  std::string error_;
};

}  // namespace catena::cli
