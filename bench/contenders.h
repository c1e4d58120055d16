// Contenders: a figure of the benchmarks has a key, such as voxels/512/t1; everybody who does that work on the same
// input is a contender for it. The benchmark's name is KEY@WHO: "ours", "paper" (the papers' own algorithm), or a
// peer's name. bench/compare runs the contenders of one key interleaved in one process and takes medians.
//
// To add a peer: write one .cpp that registers its contenders, compile it only when the peer is found (CMakeLists.txt),
// and call it from main.cpp.
#pragma once

#include <benchmark/benchmark.h>

#include <string>

namespace blackleaf::bench {

/// Registers a contender; `run` is a benchmark function of state. Elapsed time and the process's
/// CPU time are both measured; bench/compare says which one counts.
/// What is counted is, in this order: the counter "bytes" if set, the time per item if items are set, else the time per
/// iteration.
template <class Run>
benchmark::internal::Benchmark* contender(const std::string& key, const std::string& who, Run run) {
  return benchmark::RegisterBenchmark((key + "@" + who).c_str(), run)
      ->MeasureProcessCPUTime()
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

// One function a subject, each in a file of its own.
void add_voxels();
void add_mesh();
void add_translate();
void add_move();
void add_interference();
void add_drawing();
void add_curve();
void add_file();

}  // namespace blackleaf::bench
