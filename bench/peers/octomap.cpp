// OctoMap: a solid as the occupied cells of an OcTree of resolution 1.
#include <octomap/OcTree.h>

#include <map>
#include <sstream>

#include "blackleaf/leaves.h"
#include "compressed_size.h"
#include "contenders.h"
#include "inputs.h"
#include "octomap_trees.h"
#include "query_bench.h"

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

std::vector<std::uint8_t> file(int depth) {
  std::ostringstream written;
  bunny_octomap(depth)->writeBinary(written);
  const std::string bytes = written.str();
  return {bytes.begin(), bytes.end()};
}

void cast_rays(benchmark::State& state, int depth) {
  const auto tree = bunny_octomap(depth);
  std::vector<std::pair<octomap::point3d, octomap::point3d>> rays;
  const auto point = [](const Eigen::Vector3d& p) {
    return octomap::point3d(static_cast<float>(p.x()), static_cast<float>(p.y()), static_cast<float>(p.z()));
  };
  for (const Ray& ray : random_rays(depth)) rays.emplace_back(point(ray.origin), point(ray.direction));
  for (auto _ : state)
    for (const auto& [origin, direction] : rays) {
      octomap::point3d end;
      benchmark::DoNotOptimize(tree->castRay(origin, direction, end, /*ignoreUnknownCells=*/true, 2 << depth));
    }
  state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) *
                          static_cast<std::int64_t>(random_rays(depth).size()));
}

}  // namespace

std::shared_ptr<octomap::OcTree> bunny_octomap(int depth) {
  static std::map<int, std::shared_ptr<octomap::OcTree>> made;
  auto& tree = made[depth];
  if (!tree) {
    tree = std::make_shared<octomap::OcTree>(1.0);
    for_each_black_leaf(bunny(depth), [&](const Leaf& leaf) {
      const Cube& c = leaf.cube;
      for (int z = c.z; z < c.z + c.side(); ++z)
        for (int y = c.y; y < c.y + c.side(); ++y)
          for (int x = c.x; x < c.x + c.side(); ++x) insert(*tree, x, y, z);
    });
    finish(*tree);
  }
  return tree;
}

void add_octomap() {
  for (const int depth : {8, 9, 10}) {
    const std::string side = side_name(depth);
    contender("voxels/" + side + "/t1", "octomap", [=](benchmark::State& state) { from_volume(state, depth); })
        ->Iterations(1)
        ->Repetitions(depth == 10 ? 2 : 3);
    contender("ray/" + side, "octomap", [=](benchmark::State& state) { cast_rays(state, depth); });
    if (depth < 10)
      contender("query/" + side, "octomap", [=](benchmark::State& state) {
        const auto tree = bunny_octomap(depth);
        count_black(state, depth, [&](const curve::Voxel& v) {
          return tree->search(key_of(static_cast<int>(v.x), static_cast<int>(v.y), static_cast<int>(v.z))) != nullptr;
        });
      });
    sized("memory/" + side, "octomap", [=] { return bunny_octomap(depth)->memoryUsage(); });
    sized("file/" + side, "octomap", [=] { return file(depth).size(); });
    sized("file/" + side, "octomap-zstd", [=] { return compressed_size(file(depth)); });
  }
}

}  // namespace blackleaf::bench
