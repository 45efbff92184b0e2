#include "catena/results/terminal/interrupt.hpp"

#include <unistd.h>

#include <csignal>

namespace catena {
namespace {

std::atomic<bool> interrupted{false};
static_assert(std::atomic<bool>::is_always_lock_free, "only lock-free atomics may be written by a signal handler");

volatile std::sig_atomic_t caught = 0;

extern "C" void set_interrupted(int signal) {
  interrupted.store(true, std::memory_order_relaxed);
  caught = signal;
  alarm(interrupt_patience);
}

extern "C" void end_by_what_was_caught(int) {
  std::signal(caught, SIG_DFL);
  std::raise(caught);
}

}  // namespace

const std::atomic<bool>& interrupt_flag() { return interrupted; }

void catch_interrupts() {
  struct sigaction action = {};
  action.sa_handler = set_interrupted;
  sigemptyset(&action.sa_mask);
  // The default action is restored after the first signal, so that a program that hangs can still be stopped. Files
  // being written are completed.
  action.sa_flags = static_cast<int>(SA_RESETHAND) | SA_RESTART;
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  action.sa_handler = end_by_what_was_caught;
  sigaction(SIGALRM, &action, nullptr);
}

void interrupt_was_noticed() {
  if (interrupted.load(std::memory_order_relaxed)) alarm(0);
}

}  // namespace catena
