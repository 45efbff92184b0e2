// Ctrl-C as a flag: the run in progress ends at its next row or iteration, keeps what it has and says it was cancelled.
//
// A program that does not come to look at the flag, in a long factorization say, is ended by the signal itself after
// a few seconds: results for the terminal are then lost, as they are with any other program.
#pragma once

#include <atomic>

namespace catena {

/// Seconds.
inline constexpr unsigned interrupt_patience = 3;

/// False until a signal was caught.
const std::atomic<bool>& interrupt_flag();

/// From now on the first SIGINT or SIGTERM sets the flag; the second one ends the program.
void catch_interrupts();

/// The flag was seen, if it is set: results are being completed, however long that takes.
void interrupt_was_noticed();

}  // namespace catena
