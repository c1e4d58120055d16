#include "interrupt.h"

#include <atomic>
#include <csignal>

namespace blackleaf::cli {
namespace {

// A signal handler has no arguments of ours, so this one flag is global.
std::atomic<bool> interrupt_came{false};
static_assert(std::atomic<bool>::is_always_lock_free, "the handler may only touch lock-free atomics");

extern "C" void on_interrupt(int signal) {
  interrupt_came.store(true);
  std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_for_interrupt() {
  // Whoever started us with SIGINT ignored (nohup, a shell's background job) wants it ignored.
  if (std::signal(SIGINT, on_interrupt) == SIG_IGN) std::signal(SIGINT, SIG_IGN);
}

bool interrupted() { return interrupt_came.load(); }

}  // namespace blackleaf::cli
