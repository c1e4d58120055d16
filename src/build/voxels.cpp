#include "blackleaf/voxels.h"

#include <algorithm>
#include <string>
#include <vector>

#include "blackleaf/error.h"
#include "octree/brick.h"
#include "octree/produce.h"
#include "row_bits.h"

namespace blackleaf {
namespace {

std::string text(const std::array<std::int64_t, 3>& size) {
  return std::to_string(size[0]) + " x " + std::to_string(size[1]) + " x " + std::to_string(size[2]);
}

std::string point(const std::array<std::int64_t, 3>& p) {
  return "(" + std::to_string(p[0]) + ", " + std::to_string(p[1]) + ", " + std::to_string(p[2]) + ")";
}

// Rows of up to 64 values are tested at a time and kept as bits; a block of 64^3 voxels (32 KiB of bits) stays in the
// first-level cache while its bricks are put together, and each cache line of the volume is read once.
constexpr int kBlockLevel = 6;

constexpr std::size_t kBlockBricks = std::size_t{1} << 3 * (kBlockLevel - 2);

template <class T, class Inside>
class VoxelProducer {
 public:
  // A node of the block level owns its bricks; those below it look into them.
  struct Task {
    std::vector<std::uint64_t> own;         // the bricks of a block, x fastest
    const std::uint64_t* bricks = nullptr;  // of the block that the node is or lies in
  };

  VoxelProducer(const VolumeView<T>& volume, const std::array<std::int32_t, 3>& corner, int depth, const Inside& inside)
      : volume_(volume), inside_(inside) {
    for (std::size_t i = 0; i < 3; ++i) {
      low_[i] = corner[i];
      high_[i] = corner[i] + volume.size[i];
    }
    last_ = volume.size[0] * volume.size[1] * volume.size[2] - 1;
    // Blocks must not be larger than the pieces that produce() hands to its threads, three levels below the root.
    block_level_ = depth <= 5 ? std::max(depth, 2) : std::min(depth - 3, kBlockLevel);
  }

  Task root() const { return {}; }

  Colour classify(Task& task, const Cube& cube) const {
    if (cube.level < block_level_) return Colour::gray;
    const std::int64_t side = cube.side();
    if (cube.x + side <= low_[0] || cube.x >= high_[0] || cube.y + side <= low_[1] || cube.y >= high_[1] ||
        cube.z + side <= low_[2] || cube.z >= high_[2])
      return Colour::white;
    if (cube.level > block_level_) return Colour::gray;
    task.own.resize(kBlockBricks);
    task.bricks = task.own.data();
    return read(cube, task.own);
  }

  Task child(const Task& task, const Cube&, int) const { return {{}, task.bricks}; }

  std::uint64_t brick(const Task& task, const Cube& cube) const {
    const int mask = (1 << block_level_) - 1;
    return task.bricks[index((cube.x & mask) >> 2, (cube.y & mask) >> 2, (cube.z & mask) >> 2)];
  }

 private:
  static constexpr std::int64_t kLine = 64 / sizeof(T);  // values in a cache line

  static std::size_t index(int x, int y, int z) {
    constexpr int kBits = kBlockLevel - 2;
    return static_cast<std::size_t>(x | y << kBits | z << 2 * kBits);
  }

  std::int64_t row_offset(std::int64_t y, std::int64_t z) const {
    return volume_.size[0] * (y - low_[1] + volume_.size[1] * (z - low_[2]));
  }

  // Fills the block's bricks; the result is its colour.
  Colour read(const Cube& cube, std::vector<std::uint64_t>& block) const {
    const int bricks = 1 << (block_level_ - 2);
    const std::int64_t x0 = std::max<std::int64_t>(cube.x, low_[0]);
    const std::int64_t x1 = std::min<std::int64_t>(std::int64_t{cube.x} + cube.side(), high_[0]);
    std::uint64_t any = 0, all = ~std::uint64_t{0};
    for (int bz = 0; bz < bricks; ++bz)
      for (int by = 0; by < bricks; ++by) {
        std::array<std::uint64_t, 16> rows{};
        for (int row = 0; row < 16; ++row) {
          const std::int64_t y = cube.y + 4 * by + (row & 3), z = cube.z + 4 * bz + (row >> 2);
          if (y < low_[1] || y >= high_[1] || z < low_[2] || z >= high_[2]) continue;
          const std::int64_t offset = x0 - low_[0] + row_offset(y, z);
          // The block's rows lie far apart in memory, where no hardware sees them coming: ask for the next brick's now.
          for (std::int64_t ahead = offset + 4 * volume_.size[0]; ahead < offset + 4 * volume_.size[0] + (x1 - x0);
               ahead += kLine)
            __builtin_prefetch(volume_.data + std::min(ahead, last_));
          rows[static_cast<std::size_t>(row)] =
              detail::row_bits(volume_.data + offset, static_cast<int>(x1 - x0), inside_) << (x0 - cube.x);
        }
        std::uint64_t any_row = 0, all_rows = ~std::uint64_t{0};
        for (const std::uint64_t row : rows) {
          any_row |= row;
          all_rows &= row;
        }
        for (int bx = 0; bx < bricks; ++bx) {
          const int shift = 4 * bx;
          std::uint64_t brick = 0;
          if ((all_rows >> shift & 0xF) == 0xF)
            brick = ~std::uint64_t{0};
          else if ((any_row >> shift & 0xF) != 0)
            brick = gather(rows, shift);
          block[index(bx, by, bz)] = brick;
          any |= brick;
          all &= brick;
        }
      }
    return any == 0 ? Colour::white : ~all == 0 ? Colour::black : Colour::gray;
  }

  static std::uint64_t gather(const std::array<std::uint64_t, 16>& rows, int shift) {
    std::uint64_t brick = 0;
    for (unsigned row = 0; row < 16; ++row) {
      const std::uint64_t four = rows[row] >> shift & 0xF;
      brick |= ((four & 3) | (four & 12) << 6) << (detail::kSpread[row & 3] << 1 | detail::kSpread[row >> 2] << 2);
    }
    return brick;
  }

  const VolumeView<T>& volume_;
  const Inside& inside_;
  std::array<std::int64_t, 3> low_{}, high_{};  // the volume in universe coordinates, [low, high)
  std::int64_t last_;                           // index of the last value
  int block_level_;
};

template <class T, class Inside>
Octree build(const VolumeView<T>& volume, const Inside& inside, const VolumePlacement& placement, Frame frame,
             const Work& work) {
  std::array<std::int64_t, 3> reach{};
  for (std::size_t i = 0; i < 3; ++i) {
    if (volume.size[i] < 1)
      throw Error(ErrorCode::bad_input, "the volume of " + text(volume.size) + " voxels is empty",
                  "give a volume with at least one voxel along every axis");
    if (placement.corner[i] < 0 || volume.size[i] > (std::int64_t{1} << kMaxDepth))
      throw Error(ErrorCode::bad_input,
                  "a volume of " + text(volume.size) + " voxels at " +
                      point({placement.corner[0], placement.corner[1], placement.corner[2]}) +
                      " does not fit any universe",
                  "place it at coordinates of 0 or more, with no side over 2^20 voxels");
    reach[i] = placement.corner[i] + volume.size[i];
  }
  if (placement.depth < 0 || placement.depth > kMaxDepth)
    throw Error(ErrorCode::bad_argument, "depth " + std::to_string(placement.depth) + " is out of range",
                "use 1 to 20, or 0 for the smallest that holds the volume");
  const int depth = placement.depth > 0 ? placement.depth : depth_for(reach);
  if (*std::max_element(reach.begin(), reach.end()) > std::int64_t{1} << depth)
    throw Error(ErrorCode::bad_input,
                "the volume reaches to " + point(reach) + " but a universe of depth " + std::to_string(depth) + " to " +
                    std::to_string(std::int64_t{1} << depth),
                "use depth " + std::to_string(depth_for(reach)) + " or leave it open");
  return detail::produce(VoxelProducer<T, Inside>(volume, placement.corner, depth, inside), depth, std::move(frame),
                         work);
}

}  // namespace

int depth_for(const std::array<std::int64_t, 3>& size) {
  const std::int64_t longest = *std::max_element(size.begin(), size.end());
  for (int depth = 1; depth <= kMaxDepth; ++depth)
    if (longest <= std::int64_t{1} << depth) return depth;
  throw Error(ErrorCode::bad_input, "a volume that reaches to " + point(size) + " voxels does not fit any universe",
              "no side may be over 2^20 voxels");
}

template <class T>
Octree octree_from_voxels(const VolumeView<T>& volume, ValueRange<T> inside, VolumePlacement placement, Frame frame,
                          const Work& work) {
  return build(volume, detail::InRange<T>(inside.low, inside.high), placement, std::move(frame), work);
}

template <class T>
Octree octree_from_voxels(const VolumeView<T>& volume, const std::function<bool(T)>& inside, VolumePlacement placement,
                          Frame frame, const Work& work) {
  return build(volume, inside, placement, std::move(frame), work);
}

#define BLACKLEAF_INSTANTIATE(T)                                                                                     \
  template Octree octree_from_voxels<T>(const VolumeView<T>&, ValueRange<T>, VolumePlacement, Frame, const Work&);   \
  template Octree octree_from_voxels<T>(const VolumeView<T>&, const std::function<bool(T)>&, VolumePlacement, Frame, \
                                        const Work&);
BLACKLEAF_INSTANTIATE(std::uint8_t)
BLACKLEAF_INSTANTIATE(std::int8_t)
BLACKLEAF_INSTANTIATE(std::uint16_t)
BLACKLEAF_INSTANTIATE(std::int16_t)
BLACKLEAF_INSTANTIATE(std::uint32_t)
BLACKLEAF_INSTANTIATE(std::int32_t)
BLACKLEAF_INSTANTIATE(float)
BLACKLEAF_INSTANTIATE(double)
#undef BLACKLEAF_INSTANTIATE

}  // namespace blackleaf
