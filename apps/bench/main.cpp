// catena_bench: Google Benchmark's options, --table [kinematics | dynamics | statics] for run time against error, or
// --records <scene> for lines that can be laid beside those of other engines (peer_records.hpp), or
// --run FILE TYPE REPEATS for the time of whole runs of a scene (scene_runs.hpp).
//
// Figures are processor time, minimum of repeats; build with the preset `native` for the machine at hand.
#include <benchmark/benchmark.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string_view>

#include "dynamics_table.hpp"
#include "kinematics_table.hpp"
#include "peer_records.hpp"
#include "scene_runs.hpp"
#include "static_table.hpp"

int main(int argc, char** argv) {
  // Threads of the BLAS would count as processor time and gain nothing on matrices of this kind.
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  if (argc >= 2 && argc <= 3 && std::strcmp(argv[1], "--table") == 0) {
    const std::string_view wanted = argc == 3 ? argv[2] : "";
    const auto is_wanted = [&](std::string_view name) { return wanted.empty() || wanted == name; };
    // Statics first: it shows the peak of the memory.
    if (is_wanted("statics")) bench::print_static_tables();
    if (is_wanted("kinematics")) {
      bench::print_step_costs();
      bench::print_kinematic_errors();
    }
    if (is_wanted("dynamics")) {
      bench::print_acceleration_costs();
      bench::print_dynamic_errors();
    }
    return 0;
  }
  if (argc == 3 && std::strcmp(argv[1], "--records") == 0) {
    if (bench::print_peer_records(argv[2])) return 0;
    std::fprintf(stderr, "catena_bench: no records of '%s' (acceleration, chain, fourbar, squeezer, equilibrium)\n",
                 argv[2]);
    return 2;
  }
  if (argc == 5 && std::strcmp(argv[1], "--run") == 0) {
    if (bench::print_scene_runs(argv[2], argv[3], std::atoi(argv[4]))) return 0;
    std::fprintf(stderr, "catena_bench: '%s' has no %s that is solved\n", argv[2], argv[3]);
    return 2;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
