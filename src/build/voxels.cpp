#include "blackleaf/voxels.h"

#include <algorithm>
#include <cassert>
#include <vector>

#include "octree/parallel.h"
#include "octree/produce.h"
#include "row_bits.h"
#include "volume_bricks.h"
#include "volume_placement.h"

namespace blackleaf {
namespace {

constexpr double kScanPart = 0.9;  // of the time goes into reading the volume, as progress has it

// Reads a volume front to back, as it lies in memory, into the colours and bits of its bricks.
template <class T, class Inside>
class VolumeScan {
 public:
  VolumeScan(const VolumeView<T>& volume, const std::array<std::int64_t, 3>& low, const Inside& inside)
      : volume_(volume), inside_(inside), low_(low), high_(sum(low, volume.size)), bricks_(low_, high_) {}

  // `bricks` refers to this object.
  const detail::VolumeBricks& bricks(const Work& work) {
    const std::int64_t strips = bricks_.strips();
    const std::int64_t step = std::max<std::int64_t>(1, kValuesAtOnce / (16 * volume_.size[0]));
    gray_.resize(static_cast<std::size_t>((strips + step - 1) / step));
    detail::for_each_index(gray_.size(), work, [&](std::size_t i) {
      const std::int64_t first = static_cast<std::int64_t>(i) * step;
      scan(first, std::min(first + step, strips), gray_[i]);
    });
    return bricks_;
  }

 private:
  static constexpr std::int64_t kValuesAtOnce = std::int64_t{1} << 20;  // of a thread, between two reports of progress
  // A strip is read in pieces of at most 2 KiB a row. While one piece is tested the next is fetched, and both together
  // must fit the first-level cache or nearly so.
  static constexpr std::int64_t kPieceGroups = 32 / sizeof(T);
  static constexpr std::int64_t kLine = 64 / sizeof(T);  // values in a cache line
  static_assert(kPieceGroups <= detail::VolumeBricks::kMostGroups);

  // Sixteen rows of at most kPieceGroups groups.
  struct Piece {
    std::int64_t strip, group, groups;
    std::int64_t x0, x1;  // of the volume, [x0, x1)
    std::int64_t y, z;    // of row 0
    std::int64_t offset;  // of the value at (x0, y, z), which may lie outside the volume
  };

  static std::array<std::int64_t, 3> sum(const std::array<std::int64_t, 3>& a, const std::array<std::int64_t, 3>& b) {
    return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
  }

  Piece piece(std::int64_t strip, std::int64_t group) const {
    const std::int64_t end = bricks_.first_group() + bricks_.groups();
    const std::int64_t x0 = std::max(64 * group, low_[0]), x1 = std::min(64 * (group + kPieceGroups), high_[0]);
    const std::int64_t y = bricks_.strip_y(strip), z = bricks_.strip_z(strip);
    return {strip,
            group,
            std::min(kPieceGroups, end - group),
            x0,
            x1,
            y,
            z,
            x0 - low_[0] + volume_.size[0] * (y - low_[1] + volume_.size[1] * (z - low_[2]))};
  }
  Piece next(const Piece& piece) const {
    const std::int64_t group = piece.group + piece.groups;
    return group < bricks_.first_group() + bricks_.groups() ? this->piece(piece.strip, group)
                                                            : this->piece(piece.strip + 1, bricks_.first_group());
  }

  // The first value of a row of a piece; none outside the volume.
  const T* row(const Piece& piece, unsigned number) const {
    const std::int64_t j = number & 3, k = number >> 2;
    const std::int64_t y = piece.y + j, z = piece.z + k;
    if (y < low_[1] || y >= high_[1] || z < low_[2] || z >= high_[2]) return nullptr;
    return volume_.data + (piece.offset + volume_.size[0] * (j + volume_.size[1] * k));
  }

  // The voxels [x0, x1) of a row as bits, beginning with the multiple of 64 at or before x0.
  void test(const T* values, std::int64_t x0, std::int64_t x1,
            std::array<std::uint64_t, detail::VolumeBricks::kMostGroups>& words) const {
    std::size_t word = 0;
    const auto part = [&](std::int64_t end) {
      words[word++] = detail::row_bits(values, static_cast<int>(end - x0), inside_) << (x0 & 63);
      values += end - x0;
      x0 = end;
    };
    if ((x0 & 63) != 0) part(std::min((x0 | 63) + 1, x1));
    for (; x0 + 64 <= x1; x0 += 64, values += 64) words[word++] = detail::word_bits(values, inside_);
    if (x0 < x1) part(x1);
  }

  void scan(std::int64_t first, std::int64_t last, std::vector<std::uint64_t>& gray) {
    detail::VolumeBricks::Rows rows{};
    std::vector<std::size_t> begin;
    Piece now = piece(first, bricks_.first_group());
    while (now.strip < last) {
      if (now.group == bricks_.first_group()) begin.push_back(gray.size());
      // Sixteen rows in step are more than hardware foresees, and it stops at every page: ask for what comes next.
      const Piece later = next(now);
      for (unsigned number = 0; number < 16; ++number) {
        if (const T* const ahead = row(later, number))
          for (std::int64_t i = 0; i < later.x1 - later.x0; i += kLine) __builtin_prefetch(ahead + i);
        if (const T* const here = row(now, number))
          test(here, now.x0, now.x1, rows[number]);
        else
          rows[number].fill(0);
      }
      bricks_.set(now.strip, now.group, now.groups, rows, gray, begin.back());
      now = later;
    }
    for (std::int64_t strip = first; strip < last; ++strip)
      bricks_.set_gray(strip, gray.data() + begin[static_cast<std::size_t>(strip - first)]);
  }

  const VolumeView<T>& volume_;
  const Inside& inside_;
  std::array<std::int64_t, 3> low_, high_;  // the volume in universe coordinates, [low, high)
  detail::VolumeBricks bricks_;
  std::vector<std::vector<std::uint64_t>> gray_;  // the gray bricks' bits, from each thread's portion of strips
};

// The walk along the curve, once all is known about the bricks.
class BrickProducer {
 public:
  struct Task {};

  explicit BrickProducer(const detail::VolumeBricks& bricks) : bricks_(bricks) {}

  Task root() const { return {}; }
  Colour classify(Task&, const Cube& cube) const {
    assert(cube.level <= kMaxDepth);
    if (cube.level > 6) return bricks_.misses(cube) ? Colour::white : Colour::gray;
    return bricks_.colour(cube);
  }
  Task child(const Task&, const Cube&, int) const { return {}; }
  std::array<detail::Subtree, 8> bricks(const Task&, const Cube& cube) const { return bricks_.children(cube); }
  std::uint64_t brick(const Task&, const Cube& cube) const { return bricks_.brick(cube); }

 private:
  const detail::VolumeBricks& bricks_;
};

template <class T, class Inside>
Octree build(const VolumeView<T>& volume, const Inside& inside, const VolumePlacement& placement, Frame frame,
             const Work& work) {
  const int depth = detail::checked_depth(volume.size, placement);
  VolumeScan<T, Inside> scan(volume, {placement.corner[0], placement.corner[1], placement.corner[2]}, inside);
  const BrickProducer bricks(scan.bricks(detail::part_of(work, 0, kScanPart)));
  return detail::produce(bricks, depth, std::move(frame), detail::part_of(work, kScanPart, 1));
}

}  // namespace

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
