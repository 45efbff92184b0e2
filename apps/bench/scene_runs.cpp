#include "scene_runs.hpp"

#include <cstdio>
#include <fstream>
#include <sstream>

#include "catena/results/stored_results.hpp"
#include "catena/scene/running/scene_runner.hpp"
#include "timing.hpp"

namespace bench {
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
    catena::StoredResults sink;
    exit_code = catena::run_scene(path, options, sink).exit_code;
    values = sink.rows.empty() ? 0 : sink.rows.front()->values().size();
  });
  if (exit_code != 0) return false;
  std::printf("%.9g %zu\n", seconds, values);
  return true;
}

}  // namespace bench
