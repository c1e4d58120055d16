// Parallel loops and sorting, progress and interruption: the one place that starts threads.
#pragma once

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/parallel_invoke.h>
#include <oneapi/tbb/parallel_sort.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <mutex>

#include "blackleaf/error.h"
#include "blackleaf/work.h"
#include "plain_threads.h"

namespace blackleaf::detail {

/// Reports progress from one thread at a time and turns a refusal into Error(cancelled).
class Progress {
 public:
  Progress(const Work& work, std::size_t steps) : work_(work), steps_(steps) {}
  void step(std::size_t steps = 1) {
    const std::size_t done = done_ += steps;
    if (!work_.progress) return;
    const std::lock_guard lock(mutex_);
    if (!work_.progress(static_cast<double>(done) / static_cast<double>(steps_)))
      throw Error(ErrorCode::cancelled, "interrupted");
  }

  /// body(i), and a step.
  template <class Body>
  auto after(const Body& body) {
    return [this, &body](std::size_t i) {
      body(i);
      step();
    };
  }

 private:
  const Work& work_;
  std::size_t steps_;
  std::atomic<std::size_t> done_{0};
  std::mutex mutex_;
};

/// Threads to use: those asked for, at most those there are.
inline int thread_count(const Work& work) {
  const int available = oneapi::tbb::this_task_arena::max_concurrency();
  return work.threads > 0 ? std::min(work.threads, available) : available;
}

/// Calls job() where TBB's loops use so many threads.
template <class Job>
void with_threads(const Work& work, const Job& job) {
  // An arena within an arena would not share its work with threads that have nothing left to do in the outer one. So a
  // thread that waits for an inner loop may take up a body of the outer one: no loop may run under a lock that bodies
  // take.
  if (thread_count(work) == oneapi::tbb::this_task_arena::max_concurrency()) return job();
  oneapi::tbb::task_arena arena(thread_count(work));
  arena.execute(job);
}

/// Calls body(i) for 0 <= i < count, in any order (in order on one thread), and reports progress.
template <class Body>
void for_each_index(std::size_t count, const Work& work, const Body& body) {
  Progress progress(work, count);
  const auto step = progress.after(body);
  if (thread_count(work) == 1) {
    for (std::size_t i = 0; i < count; ++i) step(i);
  } else if (kPlainThreads) {
    plain_for_each_index(count, thread_count(work), step);
  } else {
    with_threads(work, [&] { oneapi::tbb::parallel_for(std::size_t{0}, count, step); });
  }
}

/// Calls both at once, or one after the other on one thread. If one throws, so does this.
template <class First, class Second>
void both(const Work& work, const First& first, const Second& second) {
  if (thread_count(work) == 1) {
    first();
    second();
  } else if (kPlainThreads) {
    plain_for_each_index(2, 2, [&](std::size_t i) { i == 0 ? first() : second(); });
  } else {
    with_threads(work, [&] { oneapi::tbb::parallel_invoke(first, second); });
  }
}

/// Sorts by operator<. Equal elements must not be distinguishable: their order depends on the threads.
template <class Container>
void sort(Container& container, const Work& work) {
  if (thread_count(work) == 1 || kPlainThreads) {
    std::sort(container.begin(), container.end());
  } else {
    with_threads(work, [&] { oneapi::tbb::parallel_sort(container.begin(), container.end()); });
  }
}

/// The same work as a part of a whole: progress runs from `begin` to `end`.
inline Work part_of(const Work& work, double begin, double end) {
  if (!work.progress) return work;
  return {work.threads, [&work, begin, end](double done) { return work.progress(begin + (end - begin) * done); }};
}

}  // namespace blackleaf::detail
