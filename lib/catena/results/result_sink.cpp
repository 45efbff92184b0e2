#include "catena/results/result_sink.hpp"

namespace catena {

void TeeSink::begin_run(const RunHeader& header) {
  for (ResultSink* sink : sinks_) sink->begin_run(header);
}

RowSink& TeeSink::begin_analysis(std::string_view type) {
  rows_.clear();
  for (ResultSink* sink : sinks_) rows_.push_back(&sink->begin_analysis(type));
  return *this;
}

void TeeSink::end_analysis(const AnalysisResult& result) {
  for (ResultSink* sink : sinks_) sink->end_analysis(result);
}

void TeeSink::end_run() {
  for (ResultSink* sink : sinks_) sink->end_run();
}

void TeeSink::begin(std::span<const ColumnInfo> columns) {
  for (RowSink* sink : rows_) sink->begin(columns);
}

bool TeeSink::row(std::span<const double> values) {
  bool go_on = true;
  for (RowSink* sink : rows_) go_on = sink->row(values) && go_on;
  return go_on;
}

}  // namespace catena
