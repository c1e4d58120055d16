// Values written as text, looked at before a library turns them into numbers.
#pragma once

#include <cstdint>
#include <filesystem>

#include "io/image_io.h"
#include "io/value_location.h"

namespace blackleaf::detail {

/// Throws Error(bad_input) that begins with the file's name unless there are `voxels` numbers, neither fewer nor more,
/// each one that the type can hold: libraries take 300 for a byte of 44. One pass over the text, in constant memory.
/// Requires: the location's packing is text and its place is known.
void check_text_values(const std::filesystem::path& path, const ValueLocation& location, Component component,
                       std::uint64_t voxels);
/// The same for hexadecimal digits: as many as told, and nothing else but blanks. Requires: packing hex.
void check_hex_values(const std::filesystem::path& path, const ValueLocation& location, std::uint64_t digits);

}  // namespace blackleaf::detail
