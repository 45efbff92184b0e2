// What a run was measured on: from /proc and the C library.
#include <sched.h>
#include <sys/utsname.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "documents/document.hpp"

namespace bench {

namespace {

/// What follows the first "model name" in /proc/cpuinfo; the machine's architecture where there is none.
std::string cpu_name(const std::string& architecture) {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (!line.starts_with("model name")) continue;
    const std::size_t colon = line.find(": ");
    if (colon != std::string::npos) return line.substr(colon + 2);
  }
  return architecture;
}

}  // namespace

Machine this_machine() {
  utsname names{};
  uname(&names);
  Machine machine;
  machine.cpu = cpu_name(names.machine);
  machine.system = std::string(names.sysname) + " " + names.machine;
  machine.compiler = CATENA_COMPILER;
  cpu_set_t allowed;
  machine.cores = sched_getaffinity(0, sizeof allowed, &allowed) == 0 ? CPU_COUNT(&allowed) : 0;
  machine.memory = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  double load = 0;
  if (getloadavg(&load, 1) == 1) machine.load = load;
  return machine;
}

}  // namespace bench
