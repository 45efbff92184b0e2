// Ctrl-C as a flag: the run in progress ends at its next row or iteration, keeps what it has and says it was cancelled.
//
// A program that does not check the flag for a few seconds, as in a long factorization, is ended by the signal itself:
// results for the terminal are then lost, as with any other program.
#pragma once

#include <atomic>

namespace catena {

/// Seconds.
inline constexpr unsigned interrupt_patience = 3;

/// False until a signal was caught.
const std::atomic<bool>& interrupt_flag();

/// From now on the first SIGINT or SIGTERM sets the flag; the second one ends the program.
void catch_interrupts();

/// Acknowledges the flag, if it is set: results are then completed, however long that takes.
void interrupt_was_noticed();

}  // namespace catena
