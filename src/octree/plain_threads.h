// Plain threads in TBB's place, for the thread sanitizer: it does not see how TBB's library, which is not compiled with
// it, hands work over, and would take every such place for a race.
#pragma once

#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace blackleaf::detail {

#ifdef __SANITIZE_THREAD__
inline constexpr bool kPlainThreads = true;
#else
inline constexpr bool kPlainThreads = false;
#endif

/// Calls body(i) for 0 <= i < count, in any order, on so many threads. If a body throws, no further one is begun, and
/// so does this.
template <class Body>
void plain_for_each_index(std::size_t count, int threads, const Body& body) {
  std::atomic<std::size_t> next{0};
  std::exception_ptr thrown;
  std::mutex mutex;
  const auto work = [&] {
    for (std::size_t i; (i = next++) < count;) {
      try {
        body(i);
      } catch (...) {
        next = count;
        const std::lock_guard lock(mutex);
        if (!thrown) thrown = std::current_exception();
      }
    }
  };
  std::vector<std::jthread> others;
  for (int i = 1; i < threads; ++i) others.emplace_back(work);
  work();
  others.clear();  // waits for them
  if (thrown) std::rethrow_exception(thrown);
}

}  // namespace blackleaf::detail
