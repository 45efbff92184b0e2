// The folder of -o: one file of rows an analysis, and report.json with all other results.
#pragma once

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "catena/results/result_sink.hpp"
#include "catena/results/row_files.hpp"
#include "catena/results/text_output.hpp"

namespace catena::cli {

class ResultFolder final : public ResultSink {
 public:
  /// Formats of the files with rows.
  static constexpr std::array<std::string_view, 3> formats{"csv", "npz", "json"};
  ResultFolder(std::string path, const std::string& format);

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
  RowFiles rows_;
  std::optional<TextOutput> report_file_;
  std::unique_ptr<ResultSink> report_;
  TeeSink tee_;
  std::vector<std::string> files_;
  std::string error_;
};

}  // namespace catena::cli
