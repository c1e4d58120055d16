// Paired figures: how two jobs' times compare when they are done in turns, so that whatever else the machine does meets
// both alike. Times taken one job after the other, minutes apart, on a shared machine make ratios that are off by a
// third.
#pragma once

#include <algorithm>
#include <chrono>
#include <ctime>
#include <vector>

namespace blackleaf::bench {

/// CPU seconds of the whole process so far.
inline double cpu_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

template <class Job>
double cpu_seconds_of(const Job& job) {
  const double begin = cpu_seconds();
  job();
  return cpu_seconds() - begin;
}

template <class Job>
double elapsed_seconds_of(const Job& job) {
  const auto begin = std::chrono::steady_clock::now();
  job();
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

/// How many times the CPU seconds of `small` those of `large` are: the median over rounds, in each of which both are
/// done, `small` some times over so that both take about as long. Requires: rounds is odd.
template <class Small, class Large>
double growth(int rounds, int times, const Small& small, const Large& large) {
  std::vector<double> ratios;
  small();  // once each before, for memory that is touched for the first time
  large();
  for (int round = 0; round < rounds; ++round) {
    const double of_small = cpu_seconds_of([&] {
      for (int i = 0; i < times; ++i) small();
    });
    ratios.push_back(cpu_seconds_of(large) / (of_small / times));
  }
  std::nth_element(ratios.begin(), ratios.begin() + rounds / 2, ratios.end());
  return ratios[static_cast<std::size_t>(rounds / 2)];
}

/// How many times the elapsed seconds of `two` those of `one` are, each the least of so many rounds in which both are
/// done: other programs only ever add to a time, so the least is the nearest to that of an idle machine.
template <class One, class Two>
double speedup(int rounds, const One& one, const Two& two) {
  double of_one = elapsed_seconds_of(one), of_two = elapsed_seconds_of(two);
  for (int round = 1; round < rounds; ++round) {
    of_one = std::min(of_one, elapsed_seconds_of(one));
    of_two = std::min(of_two, elapsed_seconds_of(two));
  }
  return of_one / of_two;
}

}  // namespace blackleaf::bench
