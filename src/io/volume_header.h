// Is a volume file believable? Asked before ITK sees the file, and before memory is taken for its voxels.
#pragma once

#include <cstdint>
#include <filesystem>

#include "io/image_io.h"
#include "io/value_location.h"

namespace blackleaf::detail {

/// Where the values are. Throws Error(bad_input) when the header is not of the format or has sizes, axes, types or
/// places of values that make no sense, or when a data file that it names cannot be read. To be asked before ITK sees
/// the file: its libraries answer some of these with an endless loop, with abort(), or with values from nowhere.
ValueLocation check_header(const std::filesystem::path& path, ImageFormat format);

/// Throws Error(bad_input) when `voxels` values, `bytes` as they are stored, cannot be there: raw values need their
/// full length, compressed ones at least a thousandth of it.
void check_believable(const std::filesystem::path& path, const ValueLocation& location, std::uint64_t voxels,
                      std::uint64_t bytes);

}  // namespace blackleaf::detail
