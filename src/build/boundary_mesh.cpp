#include <Eigen/LU>
#include <bit>
#include <limits>

#include "blackleaf/error.h"
#include "blackleaf/mesh.h"
#include "octree/brick.h"
#include "octree/corner_walk.h"

namespace blackleaf {
namespace {

// Lattice corners and the indices they got, by open addressing.
class CornerIndex {
 public:
  // The index of a corner and whether it is new.
  std::pair<std::uint32_t, bool> operator()(std::int32_t x, std::int32_t y, std::int32_t z) {
    if (2 * (std::uint64_t{count_} + 1) > slots_.size()) grow();
    const std::uint64_t key =
        static_cast<std::uint64_t>(x) | static_cast<std::uint64_t>(y) << 21 | static_cast<std::uint64_t>(z) << 42;
    Slot& slot = slots_[find(key)];
    if (slot.key == key) return {slot.index, false};
    slot = {key, count_};
    return {count_++, true};
  }

 private:
  static constexpr std::uint64_t kFree = ~std::uint64_t{0};
  struct Slot {
    std::uint64_t key = kFree;
    std::uint32_t index = 0;
  };

  std::size_t find(std::uint64_t key) const {
    std::size_t at = key * 0x9E3779B97F4A7C15u >> shift_;
    while (slots_[at].key != key && slots_[at].key != kFree) at = (at + 1) & (slots_.size() - 1);
    return at;
  }
  void grow() {
    std::vector<Slot> old(2 * slots_.size());
    old.swap(slots_);
    --shift_;
    for (const Slot& slot : old)
      if (slot.key != kFree) slots_[find(slot.key)] = slot;
  }

  std::vector<Slot> slots_ = std::vector<Slot>(1024);
  int shift_ = 54;  // 64 minus the binary logarithm of the slots
  std::uint32_t count_ = 0;
};

// Makes two triangles of every unit square between black and white.
class SquareMaker {
 public:
  SquareMaker(TriangleMesh& mesh, const Frame& frame)
      : mesh_(mesh), frame_(frame), mirrored_(frame.axes.determinant() < 0) {}

  void uniform(const Cube& cube, const detail::Around& around) {
    for (unsigned axis = 0; axis < 3; ++axis) {
      const Node& lower = around[7 - (1u << axis)];
      if (around[7].colour() == lower.colour()) continue;
      const unsigned u = (axis + 1) % 3, v = (axis + 2) % 3;
      std::array<std::int32_t, 3> at = {cube.x, cube.y, cube.z};
      const std::int32_t u0 = at[u], v0 = at[v];
      for (at[v] = v0; at[v] < v0 + cube.side(); ++at[v])
        for (at[u] = u0; at[u] < u0 + cube.side(); ++at[u]) square(at, axis, lower.is_black());
    }
  }

  void bricks(const Cube& cube, const detail::Around& around) {
    const std::uint64_t main = around[7].brick();
    for (unsigned axis = 0; axis < 3; ++axis) {
      const std::uint64_t lower = around[7 - (1u << axis)].brick();
      for (unsigned bit = 0; bit < 64; ++bit) {
        const std::array<unsigned, 3> in = {detail::brick_x(bit), detail::brick_y(bit), detail::brick_z(bit)};
        std::array<unsigned, 3> before = in;
        before[axis] = (in[axis] + 3) & 3;  // coordinate 3 of the lower brick for 0
        const std::uint64_t source = in[axis] == 0 ? lower : main;
        const bool black_before = source >> detail::brick_bit(before[0], before[1], before[2]) & 1;
        if (black_before == ((main >> bit & 1) != 0)) continue;
        square({cube.x + static_cast<std::int32_t>(in[0]), cube.y + static_cast<std::int32_t>(in[1]),
                cube.z + static_cast<std::int32_t>(in[2])},
               axis, black_before);
      }
    }
  }

 private:
  // The square at a corner across an axis; `up`: outward is the axis's positive direction.
  void square(const std::array<std::int32_t, 3>& at, unsigned axis, bool up) {
    std::array<std::uint32_t, 4> corners{};
    constexpr std::array<std::array<int, 2>, 4> kRound = {{{0, 0}, {1, 0}, {1, 1}, {0, 1}}};  // about +axis
    for (std::size_t i = 0; i < 4; ++i) {
      std::array<std::int32_t, 3> p = at;
      p[(axis + 1) % 3] += kRound[i][0];
      p[(axis + 2) % 3] += kRound[i][1];
      corners[i] = vertex(p);
    }
    if (up == mirrored_) std::swap(corners[1], corners[3]);
    mesh_.triangles.push_back({corners[0], corners[1], corners[2]});
    mesh_.triangles.push_back({corners[0], corners[2], corners[3]});
  }

  std::uint32_t vertex(const std::array<std::int32_t, 3>& p) {
    const auto [index, added] = index_(p[0], p[1], p[2]);
    if (added) {
      if (index == std::numeric_limits<std::uint32_t>::max())
        throw Error(ErrorCode::bad_input, "the boundary has more than 2^32 - 1 corners",
                    "export a coarser octree or a part of it");
      mesh_.vertices.push_back(frame_.to_world(Eigen::Vector3d(p[0], p[1], p[2])));
    }
    return index;
  }

  TriangleMesh& mesh_;
  const Frame& frame_;
  const bool mirrored_;
  CornerIndex index_;
};

}  // namespace

TriangleMesh boundary_mesh(const Octree& octree) {
  TriangleMesh mesh;
  mesh.unit = octree.frame().unit;
  SquareMaker maker(mesh, octree.frame());
  detail::corner_walk(octree, maker);
  return mesh;
}

}  // namespace blackleaf
