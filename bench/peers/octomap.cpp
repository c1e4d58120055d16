// OctoMap: a solid as the occupied cells of an OcTree of resolution 1.
#include <octomap/OcTree.h>

#include <map>
#include <sstream>

#include "blackleaf/leaves.h"
#include "compressed_size.h"
#include "contenders.h"
#include "inputs.h"

namespace blackleaf::bench {
namespace {

// Its 16 levels have their origin in the middle.
octomap::OcTreeKey key_of(int x, int y, int z) {
  const auto key = [](int coordinate) { return static_cast<octomap::key_type>(coordinate + 32768); };
  return {key(x), key(y), key(z)};
}

void insert(octomap::OcTree& tree, int x, int y, int z) {
  tree.setNodeValue(key_of(x, y, z), tree.getClampingThresMaxLog(), /*lazy_eval=*/true);
}

void finish(octomap::OcTree& tree) {
  tree.updateInnerOccupancy();
  tree.prune();
}

void from_volume(benchmark::State& state, int depth) {
  const auto& volume = bunny_volume(depth);
  const int side = 1 << depth;
  for (auto _ : state) {
    octomap::OcTree tree(1.0);
    std::size_t i = 0;
    for (int z = 0; z < side; ++z)
      for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x, ++i)
          if (volume[i] != 0) insert(tree, x, y, z);
    finish(tree);
    benchmark::DoNotOptimize(tree.size());
  }
}

// The bunny's tree; made once in a process.
octomap::OcTree& bunny_tree(int depth) {
  static std::map<int, std::unique_ptr<octomap::OcTree>> made;
  auto& tree = made[depth];
  if (!tree) {
    tree = std::make_unique<octomap::OcTree>(1.0);
    for_each_black_leaf(bunny(depth), [&](const Leaf& leaf) {
      const Cube& c = leaf.cube;
      for (int z = c.z; z < c.z + c.side(); ++z)
        for (int y = c.y; y < c.y + c.side(); ++y)
          for (int x = c.x; x < c.x + c.side(); ++x) insert(*tree, x, y, z);
    });
    finish(*tree);
  }
  return *tree;
}

std::vector<std::uint8_t> file(int depth) {
  std::ostringstream written;
  bunny_tree(depth).writeBinary(written);
  const std::string bytes = written.str();
  return {bytes.begin(), bytes.end()};
}

}  // namespace

void add_octomap() {
  for (const int depth : {8, 9, 10}) {
    const std::string side = side_name(depth);
    contender("voxels/" + side + "/t1", "octomap", [=](benchmark::State& state) { from_volume(state, depth); })
        ->Iterations(1)
        ->Repetitions(depth == 10 ? 2 : 3);
    sized("memory/" + side, "octomap", [=] { return bunny_tree(depth).memoryUsage(); });
    sized("file/" + side, "octomap", [=] { return file(depth).size(); });
    sized("file/" + side, "octomap-zstd", [=] { return compressed_size(file(depth)); });
  }
}

}  // namespace blackleaf::bench
