// query/N: the colour of one random voxel of the bunny's universe.
// ray/N: the first hit of one random ray.
#include "query_bench.h"

#include <map>
#include <random>

#include "contenders.h"
#include "inputs.h"

namespace blackleaf::bench {

const std::vector<curve::Voxel>& random_voxels(int depth) {
  static std::map<int, std::vector<curve::Voxel>> made;
  auto& voxels = made[depth];
  if (voxels.empty()) {
    std::mt19937_64 random(1992);
    for (int i = 0; i < 1 << 20; ++i) voxels.push_back(curve::voxel(depth, random() >> (64 - 3 * depth)));
  }
  return voxels;
}

const std::vector<Ray>& random_rays(int depth) {
  static std::map<int, std::vector<Ray>> made;
  auto& rays = made[depth];
  if (rays.empty()) {
    std::mt19937 random(1997);
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<double> real(0.35, 0.65);
    const double side = 1 << depth;
    for (int i = 0; i < 4096; ++i) {
      Ray ray;
      ray.origin = Eigen::Vector3d::Constant(side / 2) +
                   side * Eigen::Vector3d(normal(random), normal(random), normal(random)).normalized();
      ray.direction = (side * Eigen::Vector3d(real(random), real(random), real(random)) - ray.origin).normalized();
      rays.push_back(ray);
    }
  }
  return rays;
}

void add_query() {
  for (const int depth : {8, 9}) {
    const std::string key = "query/" + side_name(depth);
    contender(key, "ours", [=](benchmark::State& state) {
      const Octree& octree = bunny(depth);
      count_black(state, depth, [&](const curve::Voxel& v) { return octree.contains(v.x, v.y, v.z); });
    });
    contender(key, "dense", [=](benchmark::State& state) {
      const auto& volume = bunny_volume(depth);
      count_black(state, depth, [&](const curve::Voxel& v) {
        return volume[static_cast<std::size_t>((std::int64_t{v.z} << depth | v.y) << depth | v.x)] != 0;
      });
    });
  }
  for (const int depth : {8, 9, 10})
    contender("ray/" + side_name(depth), "ours", [=](benchmark::State& state) {
      const Octree& octree = bunny(depth);
      const auto& rays = random_rays(depth);
      for (auto _ : state)
        for (const Ray& ray : rays) benchmark::DoNotOptimize(first_hit(octree, ray));
      state.SetItemsProcessed(static_cast<std::int64_t>(state.iterations()) * static_cast<std::int64_t>(rays.size()));
    });
}

}  // namespace blackleaf::bench
