// Contenders: a figure of the benchmarks has a key, such as voxels/512/t1; everybody who does that work on the same
// input is a contender for it. The benchmark's name is KEY@WHO: "ours", "paper" (the papers' own algorithm), or a
// peer's name. bench/compare runs the contenders of one key interleaved in one process and takes medians.
//
// To add a peer: write one .cpp in peers/ that registers its contenders, and call it from main.cpp. What takes seconds
// says how often it runs: ->Iterations(1)->Repetitions(3).
#pragma once

#include <benchmark/benchmark.h>

#include <string>

namespace blackleaf::bench {

/// Registers a contender; `run` is a benchmark function of state. Elapsed time and the process's
/// CPU time are both measured; bench/compare says which one counts.
/// What is counted is, in this order: the counter "bytes", "voxels" or "ratio" if set, the time per item if items are
/// set, else the time per iteration.
template <class Run>
benchmark::internal::Benchmark* contender(const std::string& key, const std::string& who, Run run) {
  return benchmark::RegisterBenchmark((key + "@" + who).c_str(), run)
      ->MeasureProcessCPUTime()
      ->UseRealTime()
      ->Unit(benchmark::kMillisecond);
}

/// A contender whose result is a number; once is enough.
template <class Number>
void once(const std::string& key, const std::string& who, const std::string& unit, const Number& number) {
  contender(key, who,
            [=](benchmark::State& state) {
              for (auto _ : state) state.counters[unit] = static_cast<double>(number());
            })
      ->Iterations(1)
      ->Repetitions(1);
}
/// A contender whose result is a size in bytes.
template <class Size>
void sized(const std::string& key, const std::string& who, const Size& size) {
  once(key, who, "bytes", size);
}
/// A contender whose result is a number of voxels.
template <class Count>
void counted(const std::string& key, const std::string& who, const Count& count) {
  once(key, who, "voxels", count);
}

// One function a subject, each in a file of its own.
void add_voxels();
void add_mesh();
void add_translate();
void add_move();
void add_combine();
void add_offset();
void add_sweep();
void add_interference();
void add_distance();
void add_query();
void add_drawing();
void add_curve();
void add_file();
void add_labels();
void add_plan();
// One function a peer, each in a file of its own in peers/.
void add_scanline();
void add_openvdb();
void add_openvdb_translate();
void add_openvdb_sets();
void add_octomap();
void add_fcl();
void add_opencascade();
void add_fcl_plan();

}  // namespace blackleaf::bench
