// Team: threads that stay together through loops that follow each other closely.
//
// TBB's loops meet at their ends, and what comes between them is done while the other threads look for other work, then
// sleep; to come back takes them as long as a short loop does. Here they wait for the next loop and begin it at once,
// and take what is left of a loop in ever smaller shares, so that they end it together.
#pragma once

#include <oneapi/tbb/task_group.h>

#include <algorithm>
#include <atomic>
#include <cstddef>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

#include "parallel.h"
#include "plain_threads.h"

namespace blackleaf::detail {

class Team {
 public:
  Team(const Team&) = delete;
  Team& operator=(const Team&) = delete;

  /// Calls job(team), of as many threads as thread_count(work) says. The others may come late or not at all: no loop
  /// waits for one that has not begun. While the job runs they have no time for other loops (parallel.h): the job
  /// should call none.
  template <class Job>
  static void with(const Work& work, const Job& job) {
    Team team(thread_count(work));
    if (team.threads_ == 1) return job(team);
    const auto help = [&] { team.help(); };
    if (kPlainThreads) {
      std::vector<std::jthread> helpers;
      const Closing closing{team};
      for (std::size_t i = 1; i < team.threads_; ++i) helpers.emplace_back(help);
      return job(team);
    }
    with_threads(work, [&] {
      Helpers helpers;
      const Closing closing{team};
      for (std::size_t i = 1; i < team.threads_; ++i) helpers.group.run(help);
      job(team);
    });
  }

  /// Calls body(i) for 0 <= i < count, in any order (in order if the team has one thread), and reports progress. One
  /// loop at a time, none within another of the same team.
  template <class Body>
  void for_each_index(std::size_t count, const Work& work, const Body& body) {
    Progress progress(work, count);
    const auto step = progress.after(body);
    if (threads_ == 1) {
      for (std::size_t i = 0; i < count; ++i) step(i);
      return;
    }
    Loop loop(count, threads_, step);
    loop_ = &loop;
    loop.run();
    loop_ = nullptr;
    while (inside_ > 0) std::this_thread::yield();
    if (loop.thrown) std::rethrow_exception(loop.thrown);
  }
  template <class Body>
  void for_each_index(std::size_t count, const Body& body) {
    for_each_index(count, {}, body);
  }

 private:
  struct Loop {
    template <class Step>
    Loop(std::size_t c, std::size_t threads, const Step& s)
        : count(c), share(4 * threads), step(&s), call([](const void* of, std::size_t begin, std::size_t end) {
            for (std::size_t i = begin; i < end; ++i) (*static_cast<const Step*>(of))(i);
          }) {}

    void run() {
      for (std::size_t begin = next; begin < count; begin = next) {
        const std::size_t end = begin + std::max<std::size_t>(1, (count - begin) / share);
        if (!next.compare_exchange_weak(begin, end)) continue;
        try {
          call(step, begin, end);
        } catch (...) {
          next = count;
          const std::lock_guard lock(mutex);
          if (!thrown) thrown = std::current_exception();
        }
      }
    }

    const std::size_t count, share;
    const void* const step;
    void (*const call)(const void*, std::size_t, std::size_t);
    std::atomic<std::size_t> next{0};
    std::mutex mutex;
    std::exception_ptr thrown;
  };
  // Sends the helpers home.
  struct Closing {
    Team& team;
    ~Closing() { team.closed_ = true; }
  };
  struct Helpers {
    oneapi::tbb::task_group group;
    ~Helpers() { group.wait(); }
  };

  explicit Team(int threads) : threads_(static_cast<std::size_t>(threads)) {}

  void help() {
    while (!closed_) {
      // A loop ends when nobody is inside that has seen it.
      if (loop_ != nullptr) {
        ++inside_;
        if (Loop* const loop = loop_) loop->run();
        --inside_;
      }
      std::this_thread::yield();
    }
  }

  const std::size_t threads_;
  std::atomic<Loop*> loop_{nullptr};
  std::atomic<int> inside_{0};
  std::atomic<bool> closed_{false};
};

}  // namespace blackleaf::detail
