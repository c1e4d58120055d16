// OpenVDB's set operations and offsets. Those that change a grid in place get a copy whose making is not timed, though
// ours leave their operands whole.
#include <openvdb/openvdb.h>
#include <openvdb/tools/Composite.h>
#include <openvdb/tools/LevelSetFilter.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/Morphology.h>

#include <map>

#include "blackleaf/measures.h"
#include "blackleaf/offset.h"
#include "blackleaf/set_operations.h"
#include "contenders.h"
#include "inputs.h"
#include "peers/openvdb_grids.h"

namespace blackleaf::bench {
namespace {

using openvdb::FloatGrid;
using openvdb::MaskGrid;

constexpr int kRepetitions = 3;  // of what takes seconds
constexpr float kHalfWidth = 3;  // of level sets, OpenVDB's own default

// Made once in a process, of the bunny and of the moved bunny.
template <class Grid, class Make>
const Grid& kept(int depth, bool moved, const Make& make) {
  static std::map<std::pair<int, bool>, typename Grid::Ptr> made;
  auto& grid = made[{depth, moved}];
  if (!grid) grid = make();
  return *grid;
}

const MaskGrid& mask(int depth, bool moved) {
  return kept<MaskGrid>(depth, moved, [=] { return mask_grid(moved ? moved_bunny(depth) : bunny(depth)); });
}

const FloatGrid& level_set(int depth, bool moved) {
  return kept<FloatGrid>(depth, moved, [=] {
    const Motion motion = moved ? bunny_motion(depth) : Motion();
    std::vector<openvdb::Vec3s> points;
    // OpenVDB's voxel (i,j,k) has its centre at (i,j,k), ours half a voxel beyond.
    for (const Eigen::Vector3d& p : bunny_points(depth)) {
      const Eigen::Vector3d q = motion(p) - Eigen::Vector3d::Constant(0.5);
      points.emplace_back(static_cast<float>(q.x()), static_cast<float>(q.y()), static_cast<float>(q.z()));
    }
    std::vector<openvdb::Vec3I> triangles;
    for (const auto& t : bunny_mesh().triangles) triangles.emplace_back(t[0], t[1], t[2]);
    return openvdb::tools::meshToLevelSet<FloatGrid>(*openvdb::math::Transform::createLinearTransform(1.0), points,
                                                     triangles, kHalfWidth);
  });
}

// Times `run` on a fresh copy of `grid`, and looks at what it makes of it with `check`.
template <class Grid, class Run, class Check>
void in_place(benchmark::State& state, int threads, const Grid& grid, const Run& run, const Check& check) {
  const auto limit = at_most(threads);
  for (auto _ : state) {
    state.PauseTiming();
    typename Grid::Ptr copy = grid.deepCopy();
    state.ResumeTiming();
    run(*copy);
    state.PauseTiming();
    if (!check(*copy)) state.SkipWithError("OpenVDB's result is another solid");
    copy.reset();
    state.ResumeTiming();
  }
}

void few(benchmark::internal::Benchmark* added) { added->Iterations(1)->Repetitions(kRepetitions); }

template <class Topology, class Csg, class CsgCopy>
void add_operation(const std::string& name, Octree (*ours)(const Octree&, const Octree&, const Work&),
                   Topology topology, Csg csg, CsgCopy csg_copy) {
  for (const int depth : {8, 9, 10})
    for (const int threads : {1, 2}) {
      const std::string key = name + "/" + side_name(depth) + "/t" + std::to_string(threads);
      few(contender(key, "openvdb-topology", [=](benchmark::State& state) {
        const std::uint64_t voxels = volume(ours(bunny(depth), moved_bunny(depth), {}));
        const MaskGrid& other = mask(depth, true);
        in_place(
            state, threads, mask(depth, false), [&](MaskGrid& grid) { topology(grid, other); },
            [&](const MaskGrid& grid) { return grid.activeVoxelCount() == voxels; });
      }));
      few(contender(key, "openvdb-topology-copy", [=](benchmark::State& state) {
        const MaskGrid &a = mask(depth, false), &b = mask(depth, true);
        const auto limit = at_most(threads);
        for (auto _ : state) {
          const MaskGrid::Ptr copy = a.deepCopy();
          topology(*copy, b);
        }
      }));
      few(contender(key, "openvdb-csg", [=](benchmark::State& state) {
        FloatGrid::Ptr other;  // eaten up by the operation
        const auto limit = at_most(threads);
        for (auto _ : state) {
          state.PauseTiming();
          const FloatGrid::Ptr grid = level_set(depth, false).deepCopy();
          other = level_set(depth, true).deepCopy();
          state.ResumeTiming();
          csg(*grid, *other);
        }
      }));
      few(contender(key, "openvdb-csg-copy", [=](benchmark::State& state) {
        const FloatGrid &a = level_set(depth, false), &b = level_set(depth, true);
        const auto limit = at_most(threads);
        for (auto _ : state) benchmark::DoNotOptimize(csg_copy(a, b));
      }));
    }
}

// The level set offset is a solid with a smooth surface, nearly ours; dilating active voxels by their faces once is the
// ball of radius 1.
void add_offsets() {
  for (const int depth : {9, 10})
    for (const int threads : {1, 2})
      for (const int radius : {1, 4, 16}) {
        const std::string key =
            "offset-" + std::to_string(radius) + "/" + side_name(depth) + "/t" + std::to_string(threads);
        // By 16 voxels takes minutes.
        const bool slow = radius > 4 && depth > 9;
        if (slow && threads > 1) continue;
        auto* filter = contender(key, "openvdb-filter", [=](benchmark::State& state) {
          in_place(
              state, threads, level_set(depth, false),
              [&](FloatGrid& grid) {
                openvdb::tools::LevelSetFilter<FloatGrid>(grid).offset(-static_cast<float>(radius));
              },
              [&](const FloatGrid& grid) { return grid.activeVoxelCount() > 0; });
        });
        if (slow)
          filter->Iterations(1)->Repetitions(1);
        else
          few(filter);
        if (radius != 1) continue;
        few(contender(key, "openvdb-dilate", [=](benchmark::State& state) {
          const std::uint64_t voxels = volume(offset(bunny(depth), 1));
          in_place(
              state, threads, mask(depth, false),
              [&](MaskGrid& grid) { openvdb::tools::dilateActiveValues(grid.tree(), 1); },
              [&](const MaskGrid& grid) { return grid.activeVoxelCount() == voxels; });
        }));
      }
}

}  // namespace

void add_openvdb_sets() {
  add_offsets();
  namespace vdb = openvdb::tools;
  add_operation(
      "combine", unite, [](MaskGrid& a, const MaskGrid& b) { a.topologyUnion(b); },
      [](FloatGrid& a, FloatGrid& b) { vdb::csgUnion(a, b); },
      [](const FloatGrid& a, const FloatGrid& b) { return vdb::csgUnionCopy(a, b); });
  add_operation(
      "combine-and", intersect, [](MaskGrid& a, const MaskGrid& b) { a.topologyIntersection(b); },
      [](FloatGrid& a, FloatGrid& b) { vdb::csgIntersection(a, b); },
      [](const FloatGrid& a, const FloatGrid& b) { return vdb::csgIntersectionCopy(a, b); });
  add_operation(
      "combine-minus", subtract, [](MaskGrid& a, const MaskGrid& b) { a.topologyDifference(b); },
      [](FloatGrid& a, FloatGrid& b) { vdb::csgDifference(a, b); },
      [](const FloatGrid& a, const FloatGrid& b) { return vdb::csgDifferenceCopy(a, b); });
}

}  // namespace blackleaf::bench
