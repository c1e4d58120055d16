// offset-R/N/tT: the bunny grown by a ball of R voxels.
#include "blackleaf/offset.h"

#include <algorithm>

#include "contenders.h"
#include "inputs.h"

namespace blackleaf::bench {
namespace {

// A dense array of squared distances, exact, by Meijster's two scans along x and y, and a search over z among planes
// within the radius, which is less work than a lower envelope for the radii here. Then one bit a voxel. One thread.
void dense(benchmark::State& state, int depth, int radius) {
  const auto& volume = bunny_volume(depth);
  const std::size_t side = std::size_t{1} << depth, plane = side * side;
  const int far = radius + 1, squared = radius * radius;
  std::vector<std::uint8_t> result(volume.size());
  for (auto _ : state) {
    std::vector<std::uint16_t> distances(volume.size());
    for (std::size_t row = 0; row < volume.size(); row += side) {
      int since = far;
      for (std::size_t x = 0; x < side; ++x) {
        since = volume[row + x] != 0 ? 0 : std::min(since + 1, far);
        distances[row + x] = static_cast<std::uint16_t>(since);
      }
      since = far;
      for (std::size_t x = side; x-- > 0;) {
        since = volume[row + x] != 0 ? 0 : std::min(since + 1, far);
        distances[row + x] = std::min(distances[row + x], static_cast<std::uint16_t>(since));
      }
      for (std::size_t x = 0; x < side; ++x)
        distances[row + x] = static_cast<std::uint16_t>(distances[row + x] * distances[row + x]);
    }
    // The least of from[i + k stride] + k^2 over |k| <= radius, for all rows of a slice at once.
    const auto along = [&](std::size_t slice, std::size_t step, std::vector<std::uint16_t>& before) {
      for (std::size_t at = 0; at < side; ++at) std::copy_n(&distances[slice + at * step], side, &before[at * side]);
      for (std::size_t at = 0; at < side; ++at)
        for (int k = -radius; k <= radius; ++k) {
          const std::ptrdiff_t from = static_cast<std::ptrdiff_t>(at) + k;
          if (from < 0 || from >= static_cast<std::ptrdiff_t>(side) || k == 0) continue;
          const std::uint16_t* const other = &before[static_cast<std::size_t>(from) * side];
          std::uint16_t* const to = &distances[slice + at * step];
          for (std::size_t x = 0; x < side; ++x) to[x] = std::min(to[x], static_cast<std::uint16_t>(other[x] + k * k));
        }
    };
    std::vector<std::uint16_t> before(plane);
    for (std::size_t z = 0; z < side; ++z) along(z * plane, side, before);
    for (std::size_t y = 0; y < side; ++y) along(y * side, plane, before);
    for (std::size_t i = 0; i < volume.size(); ++i) result[i] = distances[i] <= squared;
    benchmark::ClobberMemory();
  }
}

}  // namespace

void add_offset() {
  for (const int radius : {1, 4, 16, 64})
    for (const int depth : {9, 10})
      for (const int threads : {1, 2}) {
        const std::string key =
            "offset-" + std::to_string(radius) + "/" + side_name(depth) + "/t" + std::to_string(threads);
        contender(key, "ours", [=](benchmark::State& state) {
          const Octree& octree = bunny(depth);
          for (auto _ : state) benchmark::DoNotOptimize(offset(octree, radius, Leaving::error, {threads, {}}));
        });
        if (threads == 1 && depth == 9 && radius <= 16)
          contender(key, "dense", [=](benchmark::State& state) { dense(state, depth, radius); })
              ->Iterations(1)
              ->Repetitions(3);
      }
}

}  // namespace blackleaf::bench
