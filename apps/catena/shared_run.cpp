#include "shared_run.hpp"

#include <dlfcn.h>
#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "catena/analysis/design/process_link.hpp"
#include "catena/results/terminal/interrupt.hpp"
#include "commands.hpp"

namespace catena::cli {
namespace {

/// Whether mpirun, or what does its work, started this process among several.
bool is_one_of_several() {
  for (const char* size : {"OMPI_COMM_WORLD_SIZE", "PMI_SIZE"}) {
    if (const char* text = std::getenv(size)) return std::string_view(text) != "1";
  }
  return std::getenv("PMIX_RANK") != nullptr;
}

/// The other processes; nullptr, having said why, where this program cannot speak with them.
ProcessLink* join_others() {
  void* module = ::dlopen("catena_mpi.so", RTLD_NOW | RTLD_GLOBAL);
  void* begin = module ? ::dlsym(module, "catena_mpi_link") : nullptr;
  if (begin) return reinterpret_cast<ProcessLink* (*)()>(begin)();
  complain(
      fmt::format("catena: several processes were started, but this catena cannot share work among them: {}\n"
                  "Build it with MPI (Debian's libopenmpi-dev, -DCATENA_WITH_MPI=ON), or start one process with -j N\n",
                  ::dlerror()));
  return nullptr;
}

/// What a process that does not lead leaves to the first one.
void be_silent(RunCommand& command) {
  command.json = command.csv = command.stats = false;
  command.quiet = true;
  command.directory.clear();
  command.page.clear();
}

}  // namespace

int execute_together(RunCommand command) {
  if (!is_one_of_several()) return execute(command);
  ProcessLink* link = join_others();
  if (!link) return usage;
  command.options.link = link;
  if (link->rank() > 0) be_silent(command);
  const int code = execute(command);
  // Others may have ended, and a job that was interrupted ends at once.
  if (interrupt_flag()) link->told_of_loss();
  if (link->is_whole()) {
    delete link;
    return code;
  }
  std::fflush(nullptr);
  std::_Exit(code);
}

}  // namespace catena::cli
