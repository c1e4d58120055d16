// labels/atlas: the labelled run stream of a real atlas, from its values in memory.
#include <zlib.h>

#include <array>
#include <cstring>
#include <numeric>

#include "blackleaf/error.h"
#include "blackleaf/label_voxels.h"
#include "contenders.h"
#include "papers/mhf92.h"

namespace blackleaf::bench {
namespace {

struct Atlas {
  std::array<std::int64_t, 3> size{};
  std::vector<std::uint8_t> values;
  VolumeView<std::uint8_t> view() const { return {values.data(), size}; }
};

// Automated anatomical labelling: 181 x 217 x 181 bytes, 116 labels, in Debian's package mricron-data.
const Atlas& atlas() {
  static const Atlas made = [] {
    const char* const path = "/usr/share/mricron/templates/aal.nii.gz";
    const gzFile file = gzopen(path, "rb");
    std::array<char, 352> header{};
    std::array<std::int16_t, 4> dimensions{};
    Atlas read;
    if (file != nullptr && gzread(file, header.data(), header.size()) == static_cast<int>(header.size())) {
      std::memcpy(dimensions.data(), &header[40], sizeof dimensions);
      for (std::size_t i = 0; i < 3; ++i) read.size[i] = dimensions[i + 1];
      read.values.resize(static_cast<std::size_t>(read.size[0] * read.size[1] * read.size[2]));
      if (gzread(file, read.values.data(), static_cast<unsigned>(read.values.size())) != std::ssize(read.values))
        read.values.clear();
    }
    gzclose(file);
    if (read.values.empty())
      throw Error(ErrorCode::io, std::string(path) + ": cannot be read", "install Debian's package mricron-data");
    return read;
  }();
  return made;
}

void ours(benchmark::State& state) {
  for (auto _ : state)
    benchmark::DoNotOptimize(
        label_map_from_voxels<std::uint8_t>(atlas().view(), WholeNumbers{}, {}, {}, {.threads = 1, .progress = {}}));
}

// The least that anybody must do who looks at every voxel: add the bytes up.
void read(benchmark::State& state) {
  const auto& values = atlas().values;
  for (auto _ : state) benchmark::DoNotOptimize(std::accumulate(values.begin(), values.end(), std::uint64_t{0}));
}

// MHF92: the walk with table look-ups for every voxel of the universe.
void paper(benchmark::State& state) {
  const Atlas& a = atlas();
  const int depth = depth_for(a.size);
  const auto from_database = [&](std::uint64_t x, std::uint64_t y, std::uint64_t z) -> std::uint32_t {
    const auto [nx, ny, nz] = std::array{static_cast<std::uint64_t>(a.size[0]), static_cast<std::uint64_t>(a.size[1]),
                                         static_cast<std::uint64_t>(a.size[2])};
    return x < nx && y < ny && z < nz ? a.values[x + nx * (y + ny * z)] : 0;
  };
  for (auto _ : state)
    benchmark::DoNotOptimize(papers::mhf92::walkround(depth, 0, (std::uint64_t{1} << (3 * depth)) - 1, from_database));
}

}  // namespace

void add_labels() {
  contender("labels/atlas", "ours", ours);
  contender("labels/atlas", "read", read);
  contender("labels/atlas", "paper", paper);
}

}  // namespace blackleaf::bench
