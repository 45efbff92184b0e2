// Keeps the rows of every analysis of a run, each as long as a pointer to them is left.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "catena/results/result_sink.hpp"
#include "catena/results/result_storage.hpp"

namespace catena {

class StoredResults final : public ResultSink {
 public:
  void begin_run(const RunHeader& header) override { parameters = header.parameters; }
  RowSink& begin_analysis(std::string_view) override { return *rows.emplace_back(std::make_shared<ResultStorage>()); }
  void end_analysis(const AnalysisResult&) override {}
  void end_run() override {}

  std::vector<std::pair<std::string, double>> parameters;
  std::vector<std::shared_ptr<ResultStorage>> rows;  ///< analysis by analysis
};

}  // namespace catena
