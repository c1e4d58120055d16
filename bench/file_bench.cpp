// file/N: bytes of the .octree file; memory/N: bytes of the octree in memory; save/N/tT and load/N/tT:
// to bytes and back on T threads.
#include "blackleaf/octree_file.h"
#include "blackleaf/runs.h"
#include "compressed_size.h"
#include "contenders.h"
#include "inputs.h"

namespace blackleaf::bench {
namespace {

// MHF92's monochrome stream, each count as a variable-length integer of 7 bits a byte.
std::vector<std::uint8_t> monochrome_bytes(int depth) {
  std::vector<std::uint8_t> result;
  for (std::uint64_t count : monochrome(bunny(depth))) {
    for (; count >= 128; count >>= 7) result.push_back(static_cast<std::uint8_t>(128 | (count & 127)));
    result.push_back(static_cast<std::uint8_t>(count));
  }
  return result;
}

std::vector<std::uint8_t> bit_volume(int depth) {
  const auto& volume = bunny_volume(depth);
  std::vector<std::uint8_t> bits(volume.size() / 8, 0);
  for (std::size_t i = 0; i < volume.size(); ++i) bits[i / 8] |= static_cast<std::uint8_t>(volume[i] << i % 8);
  return bits;
}

}  // namespace

void add_file() {
  for (const int depth : {8, 9, 10}) {
    const std::string side = side_name(depth);
    sized("file/" + side, "ours", [=] { return to_bytes(bunny(depth)).size(); });
    sized("file/" + side, "paper", [=] { return monochrome_bytes(depth).size(); });
    sized("file/" + side, "paper-zstd", [=] { return compressed_size(monochrome_bytes(depth)); });
    sized("file/" + side, "bits-zstd", [=] { return compressed_size(bit_volume(depth)); });
    sized("memory/" + side, "ours", [=] { return bunny(depth).memory_bytes(); });
    sized("memory/" + side, "dense", [=] { return std::size_t{1} << (3 * depth); });
    for (const int threads : {1, 2}) {
      const Work work{threads, {}};
      const std::string end = side + "/t" + std::to_string(threads);
      contender("save/" + end, "ours", [=](benchmark::State& state) {
        const Octree& octree = bunny(depth);
        for (auto _ : state) benchmark::DoNotOptimize(to_bytes(octree, "{}", work));
      });
      contender("load/" + end, "ours", [=](benchmark::State& state) {
        const std::vector<std::uint8_t> file = to_bytes(bunny(depth));
        for (auto _ : state) benchmark::DoNotOptimize(from_bytes(file, "bunny", work));
      });
    }
  }
}

}  // namespace blackleaf::bench
