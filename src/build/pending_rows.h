// PendingRows: slices that came too few at a time to make whole bricks, as bits.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <vector>

#include "blackleaf/voxels.h"
#include "row_bits.h"
#include "volume_bricks.h"

namespace blackleaf::detail {

/// One row of bricks along z: four slices, of which some have come.
class PendingRows {
 public:
  bool empty() const { return words_.empty(); }

  /// Keeps a slice: the voxels [low, high) of the universe's slice z.
  template <class T, class Inside>
  void add(const T* slice, const std::array<std::int64_t, 3>& low, const std::array<std::int64_t, 3>& high,
           std::int64_t z, const Inside& inside, const VolumeBricks& bricks) {
    const std::int64_t rows = high[1] - low[1], width = high[0] - low[0];
    if (empty()) words_.resize(static_cast<std::size_t>(4 * rows * bricks.groups()));
    for (std::int64_t y = 0; y < rows; ++y)
      row_words(slice + y * width, low[0], high[0], inside, row(y, z, rows, bricks));
  }

  /// Hands the slices over to the strips [first, last), those of the bricks that hold them, and forgets them. Slices
  /// that have not come are white. `gray` as in VolumeBricks.
  void flush(const std::array<std::int64_t, 3>& low, const std::array<std::int64_t, 3>& high, std::int64_t first,
             std::int64_t last, VolumeBricks& bricks, std::vector<std::uint64_t>& gray) {
    const std::int64_t rows = high[1] - low[1];
    std::vector<std::size_t> begin;
    for (std::int64_t strip = first; strip < last; ++strip) {
      begin.push_back(gray.size());
      const std::int64_t y = bricks.strip_y(strip);
      for (std::int64_t group = 0; group < bricks.groups(); group += VolumeBricks::kMostGroups) {
        const std::int64_t count = std::min(bricks.groups() - group, VolumeBricks::kMostGroups);
        VolumeBricks::Rows words{};
        for (std::int64_t k = 0; k < 4; ++k)
          for (std::int64_t j = std::max<std::int64_t>(0, low[1] - y); j < std::min<std::int64_t>(4, high[1] - y); ++j)
            std::copy_n(row(y + j - low[1], k, rows, bricks) + group, count,
                        words[static_cast<std::size_t>(4 * k + j)].begin());
        bricks.set(strip, bricks.first_group() + group, count, words, gray, begin.back());
      }
    }
    for (std::int64_t strip = first; strip < last; ++strip)
      bricks.set_gray(strip, gray.data() + begin[static_cast<std::size_t>(strip - first)]);
    words_.clear();
  }

 private:
  std::uint64_t* row(std::int64_t y, std::int64_t z, std::int64_t rows, const VolumeBricks& bricks) {
    return words_.data() + ((z & 3) * rows + y) * bricks.groups();
  }

  std::vector<std::uint64_t> words_;  // by slice, row and group
};

}  // namespace blackleaf::detail
