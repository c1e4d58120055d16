// Numbers of any stored type as doubles.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

#include "io/image_io.h"

namespace blackleaf::detail {

/// The number of the given type that begins at `bytes`, with its bytes in the other order than this machine's if
/// `swapped`. Whole numbers of 64 bits are rounded.
inline double number_at(Component type, const std::uint8_t* bytes, bool swapped) {
  return with_type_of(type, [&]<class T>(T value) {
    std::array<std::uint8_t, sizeof(T)> own{};
    std::copy_n(bytes, sizeof(T), own.begin());
    if (swapped) std::reverse(own.begin(), own.end());
    std::memcpy(&value, own.data(), sizeof(T));
    return static_cast<double>(value);
  });
}

}  // namespace blackleaf::detail
