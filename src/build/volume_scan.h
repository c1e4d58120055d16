// VolumeScan: the values of a volume, front to back as they lie in memory, to the colours and bits of its bricks.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "blackleaf/voxels.h"
#include "row_bits.h"
#include "volume_bricks.h"

namespace blackleaf::detail {

template <class T, class Inside>
class VolumeScan {
 public:
  /// The values in `volume`, whose first voxel lies at `low` in the universe, are to be read into `bricks`; strips that
  /// lie partly outside the volume are taken as white there.
  VolumeScan(const VolumeView<T>& volume, const std::array<std::int64_t, 3>& low, const Inside& inside,
             VolumeBricks& bricks)
      : volume_(volume), inside_(inside), low_(low), high_(sum(low, volume.size)), bricks_(bricks) {}

  /// Reads the strips [first, last). The bits of their gray bricks are left in `gray`, which must be empty and must not
  /// be changed as long as the bricks are asked. Safe for different strips at once.
  void strips(std::int64_t first, std::int64_t last, std::vector<std::uint64_t>& gray) {
    VolumeBricks::Rows rows{};
    std::vector<std::size_t> begin;
    Piece now = piece(first, bricks_.first_group());
    while (now.strip < last) {
      if (now.group == bricks_.first_group()) begin.push_back(gray.size());
      // Sixteen rows in step are more than hardware foresees, and it stops at every page: ask for what comes after the
      // next piece. Into the second-level cache: of the first one's, some processors await few lines at a time.
      const Piece soon = next(now), later = next(soon);
      for (unsigned number = 0; number < 16; ++number) {
        if (const T* const ahead = row(later, number))
          for (std::int64_t i = 0; i < later.x1 - later.x0; i += kLine) __builtin_prefetch(ahead + i, 0, 2);
        if (const T* const here = row(now, number))
          row_words(here, now.x0, now.x1, inside_, rows[number].data());
        else
          rows[number].fill(0);
      }
      bricks_.set(now.strip, now.group, now.groups, rows, gray, begin.back());
      now = soon;
    }
    for (std::int64_t strip = first; strip < last; ++strip)
      bricks_.set_gray(strip, gray.data() + begin[static_cast<std::size_t>(strip - first)]);
  }

 private:
  // A strip is read in pieces of at most 2 KiB a row: 32 KiB. While one is tested the next two are on their way, and
  // all must fit the second-level cache beside what is written.
  static constexpr std::int64_t kPieceGroups = 32 / sizeof(T);
  static constexpr std::int64_t kLine = 64 / sizeof(T);  // values in a cache line
  static_assert(kPieceGroups <= VolumeBricks::kMostGroups);

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
    const std::int64_t groups = std::min(kPieceGroups, bricks_.first_group() + bricks_.groups() - group);
    const std::int64_t x0 = std::max(64 * group, low_[0]), x1 = std::min(64 * (group + groups), high_[0]);
    const std::int64_t y = bricks_.strip_y(strip), z = bricks_.strip_z(strip);
    return {strip, group, groups, x0,
            x1,    y,     z,      x0 - low_[0] + volume_.size[0] * (y - low_[1] + volume_.size[1] * (z - low_[2]))};
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

  const VolumeView<T>& volume_;
  const Inside& inside_;
  std::array<std::int64_t, 3> low_, high_;  // the volume in universe coordinates, [low, high)
  VolumeBricks& bricks_;
};

}  // namespace blackleaf::detail
