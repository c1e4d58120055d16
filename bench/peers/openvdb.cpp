// OpenVDB: a solid as the active voxels of a MaskGrid, or as the interior of a level set.
#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/Dense.h>
#include <openvdb/tools/GridTransformer.h>
#include <openvdb/tools/Interpolation.h>
#include <openvdb/tools/LevelSetUtil.h>
#include <openvdb/tools/MeshToVolume.h>
#include <openvdb/tools/Prune.h>

#include <cmath>
#include <sstream>

#include "blackleaf/leaves.h"
#include "blackleaf/measures.h"
#include "contenders.h"
#include "inputs.h"
#include "peers/openvdb_grids.h"
#include "peers/scanline.h"
#include "query_bench.h"

namespace blackleaf::bench {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using openvdb::MaskGrid;

constexpr int kRepetitions = 3;  // of what takes seconds

// Times `make`, which returns a grid; a grid of another number of voxels than the bunny has is an error.
template <class Make>
void timed(benchmark::State& state, int threads, std::uint64_t voxels, const Make& make) {
  const auto limit = at_most(threads);
  std::uint64_t active = 0;
  for (auto _ : state) {
    const auto grid = make();
    state.PauseTiming();
    active = grid->activeVoxelCount();
    state.ResumeTiming();
  }
  if (active != voxels) state.SkipWithError("OpenVDB's grid is not the bunny");
}

// The array as it is has x fastest, which is OpenVDB's slower layout. The same bytes taken as z fastest are the bunny
// with x and z exchanged: the same work in its better layout, without a second array.
template <openvdb::tools::MemoryLayout kLayout>
MaskGrid::Ptr from_volume(int depth) {
  const auto& volume = bunny_volume(depth);
  const openvdb::tools::Dense<const std::uint8_t, kLayout> dense(CoordBBox(Coord(0), Coord((1 << depth) - 1)),
                                                                 volume.data());
  MaskGrid::Ptr grid = MaskGrid::create();
  openvdb::tools::copyFromDense(dense, *grid, false);
  openvdb::tools::prune(grid->tree());
  return grid;
}

struct PlacedMesh {
  std::vector<openvdb::Vec3d> points;
  std::vector<openvdb::Vec3I> triangles;

  explicit PlacedMesh(int depth) {
    // OpenVDB's voxel (i,j,k) has its centre at (i,j,k), ours half a voxel beyond.
    for (const Eigen::Vector3d& p : bunny_points(depth)) points.emplace_back(p.x() - 0.5, p.y() - 0.5, p.z() - 0.5);
    for (const auto& t : bunny_mesh().triangles) triangles.emplace_back(t[0], t[1], t[2]);
  }
};

openvdb::BoolGrid::Ptr from_mesh(const PlacedMesh& mesh, float half_width) {
  const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3d, openvdb::Vec3I> adapter(mesh.points, mesh.triangles);
  const auto distances = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
      adapter, *openvdb::math::Transform::createLinearTransform(1.0), half_width, half_width);
  auto interior = openvdb::tools::sdfInteriorMask(*distances);
  openvdb::tools::prune(interior->tree());
  return interior;
}

// The bunny as copyFromDense and prune leave it, without the volume.
MaskGrid::Ptr bunny_grid(int depth) { return mask_grid(bunny(depth)); }

// A motion as OpenVDB has it: row vectors, and the voxel (i,j,k) has its centre at (i,j,k), ours half a voxel beyond.
openvdb::Mat4R matrix_of(const Motion& motion) {
  const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5), shift = motion(half) - half;
  openvdb::Mat4R matrix = openvdb::Mat4R::identity();
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) matrix(j, i) = motion.rotation()(i, j);
    matrix(3, i) = shift[i];
  }
  return matrix;
}

// Nearest-neighbour resampling. Its voxels must be ours but for those whose centres come from near a face, where it
// rounds.
void resampled(benchmark::State& state, int depth, int threads) {
  const MaskGrid::Ptr source = bunny_grid(depth);
  const openvdb::tools::GridTransformer transformer(matrix_of(bunny_motion(depth)));
  const auto limit = at_most(threads);
  MaskGrid::Ptr target;
  for (auto _ : state) {
    target = MaskGrid::create();
    transformer.transformGrid<openvdb::tools::PointSampler>(*source, *target);
  }
  const auto theirs = static_cast<double>(target->activeVoxelCount());
  const auto ours = static_cast<double>(volume(moved_bunny(depth)));
  if (std::abs(theirs - ours) > 1e-4 * ours) state.SkipWithError("OpenVDB's grid is not the moved bunny");
}

std::size_t file_bytes(int depth) {
  openvdb::initialize();
  std::ostringstream file;
  openvdb::io::Stream(file).write(openvdb::GridCPtrVec{bunny_grid(depth)});
  return file.str().size();
}

std::int64_t wrong_in(const openvdb::BoolGrid& grid, int depth) {
  WrongVoxels wrong(depth);
  for (auto active = grid.cbeginValueOn(); active; ++active) {
    const CoordBBox box = active.getBoundingBox();
    wrong.add(box.min().x(), box.min().y(), box.min().z(), box.dim().x(), box.dim().y(), box.dim().z());
  }
  return wrong.count();
}

}  // namespace

MaskGrid::Ptr mask_grid(const Octree& octree) {
  MaskGrid::Ptr grid = MaskGrid::create();
  for_each_black_leaf(octree, [&](const Leaf& leaf) {
    const Coord corner(leaf.cube.x, leaf.cube.y, leaf.cube.z);
    grid->tree().fill(CoordBBox::createCube(corner, leaf.cube.side()), true);
  });
  openvdb::tools::prune(grid->tree());
  return grid;
}

void add_openvdb() {
  for (const int depth : {8, 9, 10})
    for (const int threads : {1, 2}) {
      const std::string suffix = "/" + side_name(depth) + "/t" + std::to_string(threads);
      const auto few = [](benchmark::internal::Benchmark* added) { added->Iterations(1)->Repetitions(kRepetitions); };
      few(contender("voxels" + suffix, "openvdb", [=](benchmark::State& state) {
        timed(state, threads, volume(bunny(depth)), [=] { return from_volume<openvdb::tools::LayoutXYZ>(depth); });
      }));
      few(contender("voxels" + suffix, "openvdb-z", [=](benchmark::State& state) {
        timed(state, threads, volume(bunny(depth)), [=] { return from_volume<openvdb::tools::LayoutZYX>(depth); });
      }));
      for (const int half_width : {1, 3})
        few(contender("mesh" + suffix, "openvdb-" + std::to_string(half_width), [=](benchmark::State& state) {
          const PlacedMesh mesh(depth);
          const auto limit = at_most(threads);
          for (auto _ : state) benchmark::DoNotOptimize(from_mesh(mesh, static_cast<float>(half_width)));
        }));
    }
  for (const int depth : {8, 9, 10})
    for (const int threads : {1, 2})
      contender("move/" + side_name(depth) + "/t" + std::to_string(threads), "openvdb",
                [=](benchmark::State& state) { resampled(state, depth, threads); })
          ->Iterations(1)
          ->Repetitions(kRepetitions);
  for (const int depth : {8, 9}) {
    const auto coord = [](const curve::Voxel& v) { return Coord(v.x, v.y, v.z); };
    contender("query/" + side_name(depth), "openvdb", [=](benchmark::State& state) {
      const MaskGrid::Ptr grid = bunny_grid(depth);
      const auto& tree = grid->tree();
      count_black(state, depth, [&](const curve::Voxel& v) { return tree.getValue(coord(v)); });
    });
    contender("query-near/" + side_name(depth), "openvdb", [=](benchmark::State& state) {
      const MaskGrid::Ptr grid = bunny_grid(depth);
      const auto accessor = grid->getConstAccessor();
      count_near(state, depth, [&](const curve::Voxel& v) { return accessor.getValue(coord(v)); });
    });
  }
  for (const int depth : {8, 9, 10}) {
    sized("memory/" + side_name(depth), "openvdb", [=] { return bunny_grid(depth)->memUsage(); });
    sized("file/" + side_name(depth), "openvdb", [=] { return file_bytes(depth); });
    for (const int half_width : {1, 3})
      counted("wrong/" + side_name(depth), "openvdb-" + std::to_string(half_width),
              [=] { return wrong_in(*from_mesh(PlacedMesh(depth), static_cast<float>(half_width)), depth); });
  }
}

}  // namespace blackleaf::bench
