// catena_bench: Google Benchmark's options, or --table for run time against error.
//
// Figures are processor time, minimum of repeats; build with the preset `native` for the machine at hand.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <cstring>

#include "dynamics_table.hpp"
#include "kinematics_table.hpp"

int main(int argc, char** argv) {
  // Threads of the BLAS would count as processor time and gain nothing on matrices of this kind.
  setenv("OPENBLAS_NUM_THREADS", "1", 0);
  if (argc == 2 && std::strcmp(argv[1], "--table") == 0) {
    bench::print_step_costs();
    bench::print_kinematic_errors();
    bench::print_acceleration_costs();
    bench::print_dynamic_errors();
    return 0;
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
