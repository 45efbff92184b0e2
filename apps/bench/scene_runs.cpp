#include "scene_runs.hpp"

#include <cstdio>
#include <fstream>
#include <sstream>
#include <vector>

#include "catena/results/result_storage.hpp"
#include "catena/scene/running/scene_runner.hpp"
#include "timing.hpp"

namespace bench {
namespace {

/// Keeps the rows of every analysis.
class StoringSink final : public catena::ResultSink {
 public:
  void begin_run(const catena::RunHeader&) override {}
  catena::RowSink& begin_analysis(std::string_view) override { return rows.emplace_back(); }
  void end_analysis(const catena::AnalysisResult&) override {}
  void end_run() override {}

  std::vector<catena::ResultStorage> rows;
};

}  // namespace

bool print_scene_runs(const std::string& path, const std::string& type, int repeats) {
  std::ifstream file(path);
  std::stringstream text;
  text << file.rdbuf();
  catena::RunOptions options;
  options.text = text.str();
  options.only = type;
  int exit_code = 0;
  std::size_t values = 0;
  const double seconds = least_time(repeats, 1, [&] {
    StoringSink sink;
    sink.rows.reserve(16);
    exit_code = catena::run_scene(path, options, sink).exit_code;
    values = sink.rows.empty() ? 0 : sink.rows.front().values().size();
  });
  if (exit_code != 0) return false;
  std::printf("%.9g %zu\n", seconds, values);
  return true;
}

}  // namespace bench
