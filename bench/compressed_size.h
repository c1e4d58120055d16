// Bytes under zstd -19, the strongest level that it calls usual.
#pragma once

#include <zstd.h>

#include <cstdint>
#include <vector>

namespace blackleaf::bench {

inline std::size_t compressed_size(const std::vector<std::uint8_t>& plain) {
  std::vector<std::uint8_t> packed(ZSTD_compressBound(plain.size()));
  return ZSTD_compress(packed.data(), packed.size(), plain.data(), plain.size(), 19);
}

}  // namespace blackleaf::bench
