#include "interrupt.h"

#include <array>
#include <atomic>
#include <csignal>

#include "blackleaf/error.h"
#include "file/stop_check.h"

namespace blackleaf::cli {
namespace {

constexpr std::array<int, 3> kSignals = {SIGINT, SIGTERM, SIGHUP};

// A signal handler has no arguments of ours, so this one number is global.
std::atomic<int> signal_that_came{0};
static_assert(std::atomic<int>::is_always_lock_free, "the handler may only touch lock-free atomics");

extern "C" void on_interrupt(int signal) {
  signal_that_came.store(signal);
  struct sigaction action {};
  action.sa_handler = SIG_DFL;
  for (const int each : kSignals) sigaction(each, &action, nullptr);
}

}  // namespace

void watch_for_interrupt() {
  for (const int signal : kSignals) {
    struct sigaction action {
    }, before{};
    // Whoever started us with a signal ignored (nohup, a shell's background job) wants it ignored.
    if (sigaction(signal, nullptr, &before) == 0 && before.sa_handler == SIG_IGN) continue;
    // No SA_RESTART: a read that waits for a pipe must come back to ask.
    action.sa_handler = on_interrupt;
    sigaction(signal, &action, nullptr);
  }
  detail::set_stop_check(check_interrupt);
}

int interrupt_signal() { return signal_that_came.load(); }

void check_interrupt() {
  if (interrupt_signal() != 0) throw Error(ErrorCode::cancelled, "interrupted");
}

}  // namespace blackleaf::cli
