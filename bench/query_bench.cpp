// query/N: the colour of one random voxel of the bunny's universe. query-near/N: of one voxel after another along rays.
// ray/N: the first hit of one random ray.
#include "query_bench.h"

#include <cmath>
#include <map>
#include <random>

#include "blackleaf/voxel_cursor.h"
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

const std::vector<curve::Voxel>& near_voxels(int depth) {
  static std::map<int, std::vector<curve::Voxel>> made;
  auto& voxels = made[depth];
  if (voxels.empty())
    for (std::size_t i = 0; voxels.size() < 1 << 20; ++i) {
      const Ray& ray = random_rays(depth)[i % random_rays(depth).size()];
      for (double t = 0; t < 2 << depth; ++t) {
        const Eigen::Vector3d at = (ray.origin + t * ray.direction).array().floor();
        if (at.minCoeff() >= 0 && at.maxCoeff() < 1 << depth)
          voxels.push_back({static_cast<std::int32_t>(at.x()), static_cast<std::int32_t>(at.y()),
                            static_cast<std::int32_t>(at.z())});
      }
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
  for (const int depth : {8, 9})
    contender("query-near/" + side_name(depth), "ours", [=](benchmark::State& state) {
      VoxelCursor cursor(bunny(depth));
      count_near(state, depth, [&](const curve::Voxel& v) { return cursor.contains(v.x, v.y, v.z); });
    });
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
