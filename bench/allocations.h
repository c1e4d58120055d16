// Allocations: how much memory a piece of work holds at once, counted by the allocator and not guessed from pages.
#pragma once

#include <cstddef>
#include <functional>

namespace blackleaf::bench {

/// The most bytes that were allocated at once while `work` ran, beyond those that were when it began. Every malloc,
/// realloc and free of the process is counted, on all threads; when a block moves as it grows both are, unless the
/// kernel moves its pages.
std::size_t peak_allocated(const std::function<void()>& work);

}  // namespace blackleaf::bench
