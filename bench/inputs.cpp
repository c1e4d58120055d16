#include "inputs.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <new>
#include <numbers>

#ifdef __linux__
#include <sys/mman.h>
#endif

#include "blackleaf/error.h"
#include "blackleaf/leaves.h"
#include "blackleaf/move.h"

namespace blackleaf::bench {
namespace {

// Only what the bunny needs, so that the benchmarks do without the input and output modules and their libraries.
TriangleMesh read_binary_stl(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  std::array<char, 84> header{};
  if (!file.read(header.data(), header.size())) throw Error(ErrorCode::io, path + ": cannot be read");
  std::uint32_t count = 0;
  std::memcpy(&count, &header[80], sizeof count);
  TriangleMesh mesh;
  std::array<char, 50> record{};
  for (std::uint32_t i = 0; i < count; ++i) {
    if (!file.read(record.data(), record.size())) throw Error(ErrorCode::bad_input, path + ": ends too early");
    std::array<float, 9> corners{};
    std::memcpy(corners.data(), &record[12], sizeof corners);
    for (std::size_t k = 0; k < 9; k += 3) mesh.vertices.emplace_back(corners[k], corners[k + 1], corners[k + 2]);
    mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return mesh;
}

}  // namespace

std::string side_name(int depth) { return std::to_string(1 << depth); }

void* allocate_large_pages(std::size_t bytes) {
  constexpr std::size_t kPage = std::size_t{1} << 21;
  const std::size_t whole = (bytes + kPage - 1) / kPage * kPage;
  void* const memory = std::aligned_alloc(kPage, whole);
  if (memory == nullptr) throw std::bad_alloc();
#ifdef __linux__
  madvise(memory, whole, MADV_HUGEPAGE);
#endif
  return memory;
}

void free_large_pages(void* memory) { std::free(memory); }

const TriangleMesh& bunny_mesh() {
  static const TriangleMesh mesh = read_binary_stl(BLACKLEAF_DATA "/bunny.stl");
  return mesh;
}

MeshPlacement bunny_placement(int depth) { return place_by_fraction(bunny_mesh(), depth, kFraction); }

std::vector<Eigen::Vector3d> bunny_points(int depth) {
  const Frame frame = bunny_placement(depth).frame;  // upright: its axes are a diagonal matrix
  std::vector<Eigen::Vector3d> points;
  for (const Eigen::Vector3d& vertex : bunny_mesh().vertices)
    points.emplace_back((vertex - frame.origin).cwiseQuotient(frame.axes.diagonal()));
  return points;
}

const Octree& bunny(int depth) {
  static std::map<int, Octree> made;
  const auto found = made.find(depth);
  if (found != made.end()) return found->second;
  return made.emplace(depth, octree_from_mesh(bunny_mesh(), bunny_placement(depth))).first->second;
}

const Volume& bunny_volume(int depth) {
  static std::map<int, Volume> made;
  Volume& volume = made[depth];
  if (volume.empty()) {
    volume.assign(std::size_t{1} << (3 * depth), 0);
    for_each_black_leaf(bunny(depth), [&](const Leaf& leaf) {
      const auto& c = leaf.cube;
      for (std::int64_t z = c.z; z < c.z + c.side(); ++z)
        for (std::int64_t y = c.y; y < c.y + c.side(); ++y)
          std::fill_n(&volume[static_cast<std::size_t>((z << depth | y) << depth | c.x)], c.side(), std::uint8_t{1});
    });
  }
  return volume;
}

VolumeView<std::uint8_t> view(const Volume& volume, int depth) {
  const std::int64_t side = std::int64_t{1} << depth;
  return {volume.data(), {side, side, side}};
}

Motion bunny_motion(int depth) {
  const Motion turn = Motion::rotation(Eigen::Vector3d(1, 1, 1), std::numbers::pi / 6);
  return Motion(turn.rotation(), {5.3, -7.1, 2.9}).about(Eigen::Vector3d::Constant(1 << (depth - 1)));
}

const Octree& moved_bunny(int depth) {
  static std::map<int, Octree> made;
  const auto found = made.find(depth);
  if (found != made.end()) return found->second;
  return made.emplace(depth, move(bunny(depth), bunny_motion(depth))).first->second;
}

}  // namespace blackleaf::bench
