// Runs a scene given as text, and keeps what comes out.
#pragma once

#include <cmath>
#include <deque>
#include <fstream>
#include <string>
#include <vector>

#include "catena/results/result_storage.hpp"
#include "catena/scene/running/scene_runner.hpp"
#include "results/temporary_folder.hpp"

namespace catena::testing {

/// Keeps the rows of every analysis.
class StoringSink final : public ResultSink {
 public:
  void begin_run(const RunHeader& run_header) override {
    header = run_header;
    ++runs;
  }
  RowSink& begin_analysis(std::string_view) override { return rows.emplace_back(); }
  void end_analysis(const AnalysisResult&) override {}
  void end_run() override { ended = true; }

  RunHeader header;
  int runs = 0;
  bool ended = false;
  std::deque<ResultStorage> rows;
};

struct TextRun {
  SceneOutcome outcome;
  StoringSink sink;

  const AnalysisResult& analysis(std::size_t k = 0) const { return outcome.analyses.at(k); }
  /// A column of the analysis number `analysis`; empty if there is none of this name.
  std::vector<double> column(const std::string& name, std::size_t k = 0) const { return sink.rows.at(k).column(name); }
  double last(const std::string& name, std::size_t k = 0) const {
    const std::vector<double> values = column(name, k);
    return values.empty() ? std::nan("") : values.back();
  }
  double first(const std::string& name, std::size_t k = 0) const {
    const std::vector<double> values = column(name, k);
    return values.empty() ? std::nan("") : values.front();
  }
};

inline TextRun run_text(const std::string& text, const RunOptions& options = {}) {
  TemporaryFolder folder;
  const std::string path = folder / "scene.json";
  std::ofstream(path, std::ios::binary) << text;
  TextRun run;
  run.outcome = run_scene(path, options, run.sink);
  return run;
}

/// A field of the first analysis, beside its columns; a missing one is a failure.
template <class T>
T field(const TextRun& run, const std::string& name) {
  for (const NamedField& f : run.analysis().fields) {
    if (f.name == name) return std::get<T>(f.value);
  }
  ADD_FAILURE() << "no field " << name << "; " << run.analysis().report.message << run.outcome.error_text;
  return {};
}

/// A text with its mark taken out, and where the mark was.
struct MarkedText {
  std::string text;
  int line = 1, column = 1;
};

/// The mark is §, put before the character at which an error is expected.
inline MarkedText take_mark(std::string text) {
  const std::string mark = "§";
  const std::size_t at = text.find(mark);
  MarkedText result;
  if (at == std::string::npos) {
    ADD_FAILURE() << "no mark in " << text;
    return result;
  }
  for (std::size_t k = 0; k < at; ++k) {
    const auto byte = static_cast<unsigned char>(text[k]);
    if (byte == '\n') {
      ++result.line;
      result.column = 1;
    } else if ((byte & 0xc0) != 0x80) {
      ++result.column;
    }
  }
  result.text = text.erase(at, mark.size());
  return result;
}

}  // namespace catena::testing
