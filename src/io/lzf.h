// LZF, the compression of binary_compressed PCD files: Marc Lehmann's format of literal runs and references backward.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

namespace blackleaf::detail {

/// A byte unpacks to fewer than this many: three bytes are a reference to 264 at most.
inline constexpr std::uint64_t kLzfBest = 89;

/// Unpacks into a span that must become exactly full. False, with `to` in any state, for data that are not LZF, end
/// within a run, refer to what is not there or hold another number of bytes. O(bytes).
inline bool lzf_unpack(std::span<const std::uint8_t> from, std::span<std::uint8_t> to) {
  std::size_t in = 0, out = 0;
  while (in < from.size()) {
    const std::size_t control = from[in++];
    if (control < 32) {  // control + 1 literal bytes
      const std::size_t length = control + 1;
      if (length > from.size() - in || length > to.size() - out) return false;
      std::copy_n(from.begin() + static_cast<std::ptrdiff_t>(in), length,
                  to.begin() + static_cast<std::ptrdiff_t>(out));
      in += length;
      out += length;
      continue;
    }
    // Three bits of length, 7 for "more in the next byte"; thirteen bits of distance.
    std::size_t length = control >> 5;
    if (length == 7) {
      if (in == from.size()) return false;
      length += from[in++];
    }
    length += 2;
    if (in == from.size()) return false;
    const std::size_t distance = ((control & 31) << 8 | from[in++]) + 1;
    if (distance > out || length > to.size() - out) return false;
    for (; length > 0; --length, ++out) to[out] = to[out - distance];  // byte by byte: the two may overlap
  }
  return out == to.size();
}

}  // namespace blackleaf::detail
