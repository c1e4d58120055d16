// Loops over independent items, on as many threads as the caller grants.
#pragma once

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <cstddef>

#include "blackleaf/work.h"
#include "octree/produce.h"

namespace blackleaf::detail {

/// Calls body(i) for 0 <= i < count, in any order, and reports progress.
template <class Body>
void for_each_index(std::size_t count, const Work& work, const Body& body) {
  Progress progress(work, count);
  const auto step = [&](std::size_t i) {
    body(i);
    progress.step();
  };
  if (work.threads == 1) {
    for (std::size_t i = 0; i < count; ++i) step(i);
    return;
  }
  oneapi::tbb::task_arena arena(work.threads > 0 ? work.threads : oneapi::tbb::task_arena::automatic);
  arena.execute([&] { oneapi::tbb::parallel_for(std::size_t{0}, count, step); });
}

/// The same work as a part of a whole: progress runs from `begin` to `end`.
inline Work part_of(const Work& work, double begin, double end) {
  if (!work.progress) return work;
  return {work.threads, [&work, begin, end](double done) { return work.progress(begin + (end - begin) * done); }};
}

}  // namespace blackleaf::detail
