// file/N: bytes of the .octree file; memory/N: bytes of the octree in memory; save/N and load/N: to bytes and back.
#include <zstd.h>

#include "blackleaf/octree_file.h"
#include "blackleaf/runs.h"
#include "contenders.h"
#include "inputs.h"

namespace blackleaf::bench {
namespace {

template <class Size>
void bytes(benchmark::State& state, const Size& size) {
  std::size_t result = 0;
  for (auto _ : state) result = size();
  state.counters["bytes"] = static_cast<double>(result);
}

// A contender whose result is a size: once is enough.
template <class Size>
void sized(const std::string& key, const std::string& who, const Size& size) {
  contender(key, who, [=](benchmark::State& state) { bytes(state, size); })->Iterations(1)->Repetitions(1);
}

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

std::size_t zstd_size(const std::vector<std::uint8_t>& plain) {
  std::vector<std::uint8_t> packed(ZSTD_compressBound(plain.size()));
  return ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), 19);
}

}  // namespace

void add_file() {
  for (const int depth : {8, 9, 10}) {
    const std::string side = side_name(depth);
    sized("file/" + side, "ours", [=] { return to_bytes(bunny(depth)).size(); });
    sized("file/" + side, "paper", [=] { return monochrome_bytes(depth).size(); });
    sized("file/" + side, "paper-zstd", [=] { return zstd_size(monochrome_bytes(depth)); });
    if (depth <= 9) sized("file/" + side, "bits-zstd", [=] { return zstd_size(bit_volume(depth)); });
    sized("memory/" + side, "ours", [=] { return bunny(depth).memory_bytes(); });
    sized("memory/" + side, "dense", [=] { return std::size_t{1} << (3 * depth); });
    contender("save/" + side, "ours", [=](benchmark::State& state) {
      const Octree& octree = bunny(depth);
      for (auto _ : state) benchmark::DoNotOptimize(to_bytes(octree));
    });
    contender("load/" + side, "ours", [=](benchmark::State& state) {
      const std::vector<std::uint8_t> file = to_bytes(bunny(depth));
      for (auto _ : state) benchmark::DoNotOptimize(from_bytes(file));
    });
  }
}

}  // namespace blackleaf::bench
