// Ctrl-C as a flag: the run in progress ends at its next row, keeps what it has and says it was cancelled.
#pragma once

#include <atomic>

namespace catena {

/// From now on the first SIGINT or SIGTERM sets the flag that is returned; the second one ends the program.
const std::atomic<bool>& catch_interrupts();

}  // namespace catena
