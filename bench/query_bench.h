// Questions that every contender is asked: random voxels and random rays of the bunny's universe.
#pragma once

#include <benchmark/benchmark.h>

#include <algorithm>
#include <cstdint>
#include <vector>

#include "blackleaf/curve.h"
#include "blackleaf/ray.h"

namespace blackleaf::bench {

/// A million voxels of the universe, too many for what they touch to stay in the caches; made once in a process.
const std::vector<curve::Voxel>& random_voxels(int depth);

/// Counts the black ones among them. Counting makes sure that every voxel is really looked up; a value that nobody uses
/// need not even be loaded.
template <class IsBlack>
void count_black_of(benchmark::State& state, const std::vector<curve::Voxel>& voxels, const IsBlack& is_black) {
  for (auto _ : state) benchmark::DoNotOptimize(std::count_if(voxels.begin(), voxels.end(), is_black));
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(voxels.size()));
}

template <class IsBlack>
void count_black(benchmark::State& state, int depth, const IsBlack& is_black) {
  count_black_of(state, random_voxels(depth), is_black);
}

/// A million voxels or more of the universe along random_rays(), a step of one voxel each; made once in a process.
const std::vector<curve::Voxel>& near_voxels(int depth);
template <class IsBlack>
void count_near(benchmark::State& state, int depth, const IsBlack& is_black) {
  count_black_of(state, near_voxels(depth), is_black);
}

/// 4096 rays from a sphere around the universe to points of its middle; nine of ten hit the bunny. Made once in a
/// process.
const std::vector<Ray>& random_rays(int depth);

}  // namespace blackleaf::bench
