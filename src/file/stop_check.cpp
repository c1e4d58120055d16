#include "file/stop_check.h"

#include <atomic>

namespace blackleaf::detail {
namespace {

// Signals are the process's, and so is what is asked about them.
std::atomic<StopCheck> stop_check{nullptr};

}  // namespace

void set_stop_check(StopCheck check) { stop_check.store(check); }

void check_for_stop() {
  if (const StopCheck check = stop_check.load()) check();
}

}  // namespace blackleaf::detail
