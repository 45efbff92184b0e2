// Results as text for people, an analysis after the other: outcome, table, report.
#pragma once

#include "catena/results/result_sink.hpp"
#include "catena/results/terminal/report_text.hpp"
#include "catena/results/terminal/text_table.hpp"
#include "catena/results/text_output.hpp"

namespace catena {

class TextSink final : public ResultSink {
 public:
  /// `hint` is printed once, under the first table that does not show everything: how to see the rest.
  TextSink(TextOutput& output, const TableLimits& limits, std::string hint)
      : output_(output), hint_(std::move(hint)), table_(limits) {}

  void begin_run(const RunHeader& header) override;
  RowSink& begin_analysis(std::string_view type) override;
  void end_analysis(const AnalysisResult& result) override;
  void end_run() override { output_.flush(); }

 private:
  TextOutput& output_;
  std::string hint_;
  TextTable table_;
};

}  // namespace catena
