#include "catena/results/terminal/text_sink.hpp"

#include <utility>

namespace catena {

void TextSink::begin_run(const RunHeader& header) { output_.write(header_text(header)); }

RowSink& TextSink::begin_analysis(std::string_view) {
  table_.begin({});
  return table_;
}

void TextSink::end_analysis(const AnalysisResult& result) {
  output_.write("\n" + outcome_text(result));
  const TextTable::Text table = table_.text(result.digits);
  output_.write(table.lines);
  if (!hint_.empty() && table.shortened) output_.write("  (" + std::exchange(hint_, {}) + ")\n");
  output_.write(report_text(result));
  output_.flush();
}

}  // namespace catena
