// A command whose work the processes of an MPI job share: the first one prints and writes, as if it were alone.
#pragma once

#include "run_command.hpp"

namespace catena::cli {

/// execute(), with the other processes of the job where mpirun started several; the exit code.
int execute_together(RunCommand command);

}  // namespace catena::cli
