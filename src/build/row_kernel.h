// Values in a range as bits: the inner loop of building from voxels, by SIMD where there is any.
#pragma once

#include <cstddef>
#include <cstdint>

namespace blackleaf::detail {

/// Bit i of words[k] is whether low <= values[64 k + i] <= high; NaN never is. Bits of the last word beyond `count` are
/// 0. For the types of volumes (voxels.h).
template <class T>
void range_bits(const T* values, std::size_t count, T low, T high, std::uint64_t* words);

}  // namespace blackleaf::detail
