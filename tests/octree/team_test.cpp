// Threads that stay together through many loops (octree/team.h).
#include "octree/team.h"

#include <gtest/gtest.h>
#include <oneapi/tbb/global_control.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "blackleaf/error.h"

namespace blackleaf {
namespace {

using detail::Team;

constexpr int kThreads = 4;

// As many threads as are asked for, however many processors there are.
template <class Job>
void with_team(int threads, const Job& job) {
  const oneapi::tbb::global_control control(oneapi::tbb::global_control::max_allowed_parallelism, kThreads);
  oneapi::tbb::task_arena arena(kThreads);
  arena.execute([&] { Team::with({threads, {}}, job); });
}

TEST(Team, EachIndexOnce) {
  for (int threads = 1; threads <= kThreads; ++threads)
    with_team(threads, [](Team& team) {
      for (std::size_t count = 0; count < 3000; count = count * 5 / 4 + 1) {
        std::vector<std::atomic<int>> calls(count);
        team.for_each_index(count, [&](std::size_t i) { ++calls[i]; });
        for (std::size_t i = 0; i < count; ++i) ASSERT_EQ(calls[i], 1) << i << " of " << count;
      }
    });
}

TEST(Team, InOrderOnOneThread) {
  std::vector<std::size_t> visited, expected(100);
  std::iota(expected.begin(), expected.end(), std::size_t{0});
  with_team(1, [&](Team& team) { team.for_each_index(100, [&](std::size_t i) { visited.push_back(i); }); });
  EXPECT_EQ(visited, expected);
}

// What one loop wrote, the next reads without further care.
TEST(Team, LoopsFollowEachOther) {
  with_team(kThreads, [](Team& team) {
    std::vector<std::size_t> numbers(1000, 0), next(numbers.size());
    for (std::size_t round = 1; round <= 2000; ++round) {
      team.for_each_index(numbers.size(), [&](std::size_t i) { next[i] = numbers[numbers.size() - 1 - i] + 1; });
      numbers.swap(next);
    }
    for (const std::size_t number : numbers) ASSERT_EQ(number, 2000U);
  });
}

// A loop ends when all who are in it are done, not when everything has been begun.
TEST(Team, WaitsForTheLast) {
  with_team(kThreads, [](Team& team) {
    for (int round = 0; round < 20; ++round) {
      std::atomic<int> done = 0;
      team.for_each_index(kThreads, [&](std::size_t) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        ++done;
      });
      ASSERT_EQ(done, kThreads);
    }
  });
}

TEST(Team, TakesHelp) {
  with_team(kThreads, [](Team& team) {
    // Each of the two waits for the other.
    std::atomic<int> there = 0;
    team.for_each_index(2, [&](std::size_t) {
      ++there;
      while (there < 2) std::this_thread::yield();
    });
    EXPECT_EQ(there, 2);
  });
}

TEST(Team, WhatABodyThrows) {
  for (int threads = 1; threads <= kThreads; ++threads)
    for (int round = 0; round < 50; ++round)
      with_team(threads, [](Team& team) {
        EXPECT_THROW(team.for_each_index(1000,
                                         [](std::size_t i) {
                                           if (i % 100 == 7) throw std::runtime_error("seven");
                                         }),
                     std::runtime_error);
        std::atomic<int> calls = 0;  // the next loop has all its threads
        team.for_each_index(100, [&](std::size_t) { ++calls; });
        EXPECT_EQ(calls, 100);
      });
}

TEST(Team, WhatTheJobThrows) {
  EXPECT_THROW(with_team(kThreads, [](Team&) { throw std::runtime_error("job"); }), std::runtime_error);
}

TEST(Team, ProgressAndInterruption) {
  for (int threads = 1; threads <= kThreads; ++threads) {
    double last = 0;
    int reports = 0;
    const Work counting{0, [&](double done) {
                          last = std::max(last, done);
                          return ++reports < 50;
                        }};
    with_team(threads, [&](Team& team) {
      team.for_each_index(49, counting, [](std::size_t) {});
      EXPECT_EQ(last, 1.0);
      EXPECT_EQ(reports, 49);
      try {
        team.for_each_index(10, counting, [](std::size_t) {});
        ADD_FAILURE() << "not interrupted";
      } catch (const Error& error) {
        EXPECT_EQ(error.code(), ErrorCode::cancelled);
      }
    });
  }
}

// Teams in the bodies of a loop, more than there are threads: nobody waits for one who does not come.
TEST(Team, WithinALoop) {
  std::atomic<int> calls = 0;
  oneapi::tbb::task_arena arena(kThreads);
  arena.execute([&] {
    detail::for_each_index(50, {}, [&](std::size_t) {
      Team::with({}, [&](Team& team) {
        for (int i = 0; i < 3; ++i) team.for_each_index(20, [&](std::size_t) { ++calls; });
      });
    });
  });
  EXPECT_EQ(calls, 50 * 3 * 20);
}

}  // namespace
}  // namespace blackleaf
