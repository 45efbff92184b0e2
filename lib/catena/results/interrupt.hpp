// Ctrl-C as a flag: the run in progress ends at its next row, keeps what it has and says it was cancelled.
#pragma once

#include <atomic>

namespace catena {

/// False until a signal was caught.
const std::atomic<bool>& interrupt_flag();

/// From now on the first SIGINT or SIGTERM sets the flag; the second one ends the program.
void catch_interrupts();

}  // namespace catena
