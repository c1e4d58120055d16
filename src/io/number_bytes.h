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
  const auto as = [&]<class T>(T value) {
    std::array<std::uint8_t, sizeof(T)> own{};
    std::copy_n(bytes, sizeof(T), own.begin());
    if (swapped) std::reverse(own.begin(), own.end());
    std::memcpy(&value, own.data(), sizeof(T));
    return static_cast<double>(value);
  };
  switch (type) {
    case Component::u8:
      return as(std::uint8_t{});
    case Component::i8:
      return as(std::int8_t{});
    case Component::u16:
      return as(std::uint16_t{});
    case Component::i16:
      return as(std::int16_t{});
    case Component::u32:
      return as(std::uint32_t{});
    case Component::i32:
      return as(std::int32_t{});
    case Component::u64:
      return as(std::uint64_t{});
    case Component::i64:
      return as(std::int64_t{});
    case Component::f32:
      return as(float{});
    case Component::f64:
      return as(double{});
  }
  return 0;
}

}  // namespace blackleaf::detail
